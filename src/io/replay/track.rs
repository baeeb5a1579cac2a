//! What is recorded of one body, and how it is rounded.

use super::codec::encode;
use crate::body::FlexBody;
use crate::fe::model::ModelError;
use crate::io::base64::push_base64;
use crate::io::rigid_lines::RigidLine;
use crate::io::scene::RigidShape;
use crate::io::stress::world_stress;
use std::fmt::Write as _;

/// Steps of a displacement across the range that its body's have, and of a rigid position.
const DISPLACEMENT_STEPS: f64 = 8191.0;
const POSITION_STEPS: f64 = 65535.0;
/// Steps of the von Mises stress, of the components of stress and of force, each to its largest value.
const VON_MISES_STEPS: f64 = 255.0;
const STRESS_STEPS: f64 = 40.0;
const FORCE_STEPS: f64 = 127.0;
/// Steps of an angle (1/rad).
const ANGLE_STEPS: f64 = 10_000.0;

/// Largest number that is kept: an `f32`, and twice it as well.
const LARGEST: f64 = 1e38;

/// Numbers of all frames: as many in each.
#[derive(Clone, Debug, Default)]
pub(super) struct Channel(Vec<f32>);

impl Channel {
    fn push(&mut self, value: f64) {
        // JSON has no infinity; what is not a number is told elsewhere.
        let finite = if value.is_nan() { 0.0 } else { value };
        self.0.push(finite.clamp(-LARGEST, LARGEST) as f32);
    }

    fn largest(&self) -> f64 {
        let largest = self
            .0
            .iter()
            .fold(0.0f32, |largest, x| largest.max(x.abs()));
        f64::from(largest)
    }

    /// Lowest value and extent.
    fn range(&self) -> [f64; 2] {
        let low = self.0.iter().fold(f32::INFINITY, |low, &x| low.min(x));
        let high = self
            .0
            .iter()
            .fold(f32::NEG_INFINITY, |high, &x| high.max(x));
        let (low, high) = (f64::from(low), f64::from(high));
        // What has no extent is one value.
        [low, if high > low { high - low } else { 1.0 }]
    }

    fn rounded(&self, round: impl Fn(f64) -> f64) -> Vec<i32> {
        self.0
            .iter()
            .map(|&x| round(f64::from(x)).round() as i32)
            .collect()
    }

    fn places(&self, [low, extent]: [f64; 2], steps: f64) -> Vec<i32> {
        self.rounded(|x| (x - low) / extent * steps)
    }

    /// Roots of the parts of the largest, so that small values keep digits beside a blow.
    fn roots(&self, largest: f64, steps: f64) -> Vec<i32> {
        let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        self.rounded(|x| x.signum() * (x.abs() * scale).sqrt() * steps)
    }
}

/// A flexible body over the frames from `first` on.
#[derive(Clone, Debug)]
pub(super) struct FlexTrack {
    pub(super) index: u32,
    first: usize,
    pub(super) n_frames: usize,
    /// Nodes of the mesh that are recorded, ascending or along the boundary.
    nodes: Vec<usize>,
    /// Cells and boundary loops, by their place in `nodes`.
    cells: Vec<Vec<usize>>,
    loops: Vec<Vec<usize>>,
    rest: Vec<[f64; 2]>,
    /// Displacement x and y (m), von Mises, xx, yy, xy (Pa), force x and y (N).
    channels: [Channel; 8],
}

impl FlexTrack {
    pub(super) fn new(index: u32, first: usize, body: &FlexBody, has_interior: bool) -> Self {
        let mesh = body.mesh();
        let nodes: Vec<usize> = if has_interior {
            (0..mesh.n_nodes()).collect()
        } else {
            mesh.boundary().nodes().to_vec()
        };
        let mut place = vec![usize::MAX; mesh.n_nodes()];
        for (at, &node) in nodes.iter().enumerate() {
            place[node] = at;
        }
        let places = |nodes: &[usize]| nodes.iter().map(|&node| place[node]).collect();
        let drawn = has_interior.then(|| mesh.cells());
        // Round the cell, midside nodes between its corners.
        let around = |nodes: &[usize], n_corners: usize| -> Vec<usize> {
            let sides = (0..n_corners).map(|corner| (nodes[corner], nodes.get(n_corners + corner)));
            sides
                .flat_map(|(corner, midside)| std::iter::once(corner).chain(midside.copied()))
                .collect()
        };
        let cells = drawn.into_iter().flatten();
        let cells = cells.map(|cell| around(cell.nodes, cell.corners().len()));
        let rest = nodes.iter().map(|&node| {
            let ([x, y], [u, v]) = (body.position(node), body.displacement(node));
            [x - u, y - v]
        });
        Self {
            index,
            first,
            n_frames: 0,
            cells: cells.map(|nodes| places(&nodes)).collect(),
            loops: mesh
                .boundary()
                .loops()
                .iter()
                .map(|ring| places(ring.nodes()))
                .collect(),
            rest: rest.collect(),
            nodes,
            channels: Default::default(),
        }
    }

    pub(super) fn record(&mut self, body: &FlexBody) -> Result<(), ModelError> {
        let stresses = world_stress(body)?;
        for &node in &self.nodes {
            let ([x, y], stress) = (body.displacement(node), &stresses[node]);
            let [force_x, force_y] = body.contact_force(node);
            let values = [
                x,
                y,
                stress.von_mises(),
                stress.xx,
                stress.yy,
                stress.xy,
                force_x,
                force_y,
            ];
            for (channel, value) in self.channels.iter_mut().zip(values) {
                channel.push(value);
            }
        }
        self.n_frames += 1;
        Ok(())
    }

    /// The track as an object of JSON.
    pub(super) fn write(&self, json: &mut String) {
        let [x, y, von_mises, xx, yy, xy, force_x, force_y] = &self.channels;
        let (range_x, range_y) = (x.range(), y.range());
        let full_von_mises = von_mises.largest();
        let full_stress = xx.largest().max(yy.largest()).max(xy.largest());
        let full_force = force_x.largest().max(force_y.largest());
        let channels = [
            x.places(range_x, DISPLACEMENT_STEPS),
            y.places(range_y, DISPLACEMENT_STEPS),
            von_mises.roots(full_von_mises, VON_MISES_STEPS),
            xx.roots(full_stress, STRESS_STEPS),
            yy.roots(full_stress, STRESS_STEPS),
            xy.roots(full_stress, STRESS_STEPS),
            force_x.roots(full_force, FORCE_STEPS),
            force_y.roots(full_force, FORCE_STEPS),
        ];
        let rest: Vec<f64> = self.rest.iter().flatten().copied().collect();
        let _ = write!(
            json,
            "{{\"index\":{},\"first\":{},\"n\":{},\"box\":{:?},\"full\":{:?},\"nodes\":{:?},\"rest\":",
            self.index,
            self.first,
            self.n_frames,
            [range_x, range_y].concat(),
            [full_von_mises, full_stress, full_force],
            self.nodes,
        );
        push_singles(json, &rest);
        let _ = write!(
            json,
            ",\"cells\":{:?},\"loops\":{:?}",
            self.cells, self.loops
        );
        push_stream(json, &channels, self.nodes.len());
    }
}

/// A rigid collider over the frames from `first` on.
#[derive(Clone, Debug)]
pub(super) struct RigidTrack {
    pub(super) index: u32,
    first: usize,
    pub(super) n_frames: usize,
    lines: Vec<RigidLine>,
    is_sensor: bool,
    /// x, y (m), angle (rad) without jumps.
    channels: [Channel; 3],
    angle: f64,
}

impl RigidTrack {
    pub(super) fn new(index: u32, first: usize, shape: &RigidShape) -> Self {
        Self {
            index,
            first,
            n_frames: 0,
            lines: shape.lines.clone(),
            is_sensor: shape.is_sensor,
            channels: Default::default(),
            angle: shape.angle(),
        }
    }

    pub(super) fn record(&mut self, shape: &RigidShape) {
        use std::f64::consts::{PI, TAU};
        let change = (shape.angle() - self.angle + PI).rem_euclid(TAU) - PI;
        self.angle += change;
        let [x, y] = shape.translation;
        for (channel, value) in self.channels.iter_mut().zip([x, y, self.angle]) {
            channel.push(value);
        }
        self.n_frames += 1;
    }

    /// The track as an object of JSON.
    pub(super) fn write(&self, json: &mut String) {
        let [x, y, angle] = &self.channels;
        let (range_x, range_y) = (x.range(), y.range());
        let channels = [
            x.places(range_x, POSITION_STEPS),
            y.places(range_y, POSITION_STEPS),
            angle.rounded(|angle| angle * ANGLE_STEPS),
        ];
        let _ = write!(
            json,
            "{{\"index\":{},\"first\":{},\"n\":{},\"sensor\":{},\"box\":{:?},\"lines\":[",
            self.index,
            self.first,
            self.n_frames,
            self.is_sensor,
            [range_x, range_y].concat(),
        );
        for (index, line) in self.lines.iter().enumerate() {
            let points: Vec<f64> = line.points.iter().flatten().copied().collect();
            let comma = if index == 0 { "" } else { "," };
            let (closed, endless) = (line.is_closed, line.is_endless);
            let _ = write!(
                json,
                "{comma}{{\"closed\":{closed},\"endless\":{endless},\"points\":"
            );
            push_singles(json, &points);
            json.push('}');
        }
        json.push(']');
        push_stream(json, &channels, 1);
    }
}

fn push_stream(json: &mut String, channels: &[Vec<i32>], n_values: usize) {
    json.push_str(",\"stream\":\"");
    push_base64(json, &encode(channels, n_values));
    json.push_str("\"}");
}

/// Numbers as `f32`, in base64 with quotes.
pub(super) fn push_singles(json: &mut String, values: &[f64]) {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|&value| (value as f32).to_le_bytes())
        .collect();
    json.push('"');
    push_base64(json, &bytes);
    json.push('"');
}
