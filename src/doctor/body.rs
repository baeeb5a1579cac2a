//! One body: mesh, material, damping, size.

use super::finding::Finding;
use crate::body::{FlexBody, FlexBodyHandle};
use crate::fe::material::Material;
use crate::fe::mesh::{CellKind, Mesh};
use crate::fe::modes::{ModesError, lowest_modes};
use crate::integrator::Beta2;
use crate::math::{Vec2, node_vec};
use crate::pipeline::InsertionNote;

/// The angle of a cell below which it is a sliver (deg): its condition number is beyond a thousand there.
const SLIVER: f64 = 2.0;

/// Stiffness against a change of area over that against shear from which three-node triangles lock: Poisson's ratio .475 in plane strain.
const LOCKS: f64 = 20.0;

/// Cells across from which three-node triangles are less than a tenth too stiff in bending.
const ENOUGH_CELLS: usize = 5;

/// Length over thickness of a body that bends.
const SLENDER: f64 = 5.0;

/// Sag over size beyond which small strains are another body: a hundredth of strain is then left out.
const SAG: f64 = 0.1;

/// Densities of solids, aerogel to osmium with room to spare (kg/m³).
const DENSITIES: [f64; 2] = [0.1, 3e4];

/// Steps over which a body that is damped beyond the critical ratio creeps to where a load takes it: seen as creeping. Rubber of games is damped
/// critically, and follows in one or two.
const CREEPS: f64 = 20.0;

/// Modes looked for: three rigid motions, and one more.
const N_MODES: usize = 4;

/// What is known of a body when it is examined.
pub(super) struct Patient<'a> {
    pub(super) handle: FlexBodyHandle,
    pub(super) body: &'a FlexBody,
    /// Of the world (m/s²).
    pub(super) gravity: f64,
    /// The step (s).
    pub(super) dt: f64,
    pub(super) integrator: Beta2,
}

impl Patient<'_> {
    pub(super) fn examine(&self, findings: &mut Vec<Finding>) {
        self.look_at_mesh(findings);
        self.look_at_material(findings);
        self.look_at_modes(findings);
        self.look_at_motion(findings);
    }

    fn look_at_mesh(&self, findings: &mut Vec<Finding>) {
        let (body, mesh) = (self.handle, self.body.mesh());
        let angle = mesh.quality().min_angle;
        if angle < SLIVER {
            findings.push(Finding::Sliver { body, angle });
        }
        if !mesh.cells().all(|cell| cell.kind == CellKind::Tri3) {
            return;
        }
        let (across, slenderness) = (cells_across(mesh), slenderness(mesh));
        if across < ENOUGH_CELLS && slenderness > SLENDER {
            findings.push(Finding::FewCells {
                body,
                across,
                slenderness,
            });
        }
        let ratios = self.materials().map(|material| {
            let [[xx, xy, _], _, [_, _, shear]] = material.tangent([0.0; 3]);
            0.5 * (xx + xy) / shear
        });
        let ratio = ratios.fold(0.0, f64::max);
        if ratio > LOCKS {
            findings.push(Finding::Locking { body, ratio });
        }
    }

    fn look_at_material(&self, findings: &mut Vec<Finding>) {
        let body = self.handle;
        let [low, high] = extent(self.body);
        let pull = self.gravity * self.body.gravity_scale().abs() * (high - low).y;
        let mut ratio: f64 = 0.0;
        for material in self.materials() {
            let density = material.density();
            if !(DENSITIES[0]..=DENSITIES[1]).contains(&density) {
                findings.push(Finding::Density { body, density });
            }
            let [_, _, [_, _, shear]] = material.tangent([0.0; 3]);
            ratio = ratio.max(density * pull / shear);
        }
        let is_held = self.body.fixed_dofs().contains(&true);
        if !is_held && ratio > 1.0 {
            findings.push(Finding::Crushed { body, ratio });
        }
    }

    /// The materials of all regions.
    fn materials(&self) -> impl Iterator<Item = &dyn Material> {
        let regions = self.body.mesh().regions().into_iter();
        regions.map(|region| self.body.model().material_of(region))
    }

    fn look_at_modes(&self, findings: &mut Vec<Finding>) {
        let (body, model) = (self.handle, self.body.free_model());
        let fixed = self.body.fixed_dofs();
        // At rest, whatever the body is doing; rounding is no matter here.
        let found = match lowest_modes(model, fixed, N_MODES, 1e-4) {
            Ok(found) => found,
            // It is held nearly everywhere.
            Err(ModesError::TooMany { .. }) => return,
            Err(_) => return findings.push(Finding::Unexamined { body }),
        };
        let mut frequencies = found.frequencies().into_iter();
        let Some(frequency) = frequencies.find(|&frequency| frequency > 0.0) else {
            return;
        };
        let ratio = model.rayleigh().ratio(frequency);
        let time = 2.0 * ratio / frequency;
        if ratio > 1.0 && time > CREEPS * self.dt {
            findings.push(Finding::Overdamped {
                body,
                frequency,
                ratio,
                time,
            });
        }
        let [low, high] = extent(self.body);
        let size = (high - low).max();
        let sag = self.gravity * self.body.gravity_scale().abs() / (frequency * frequency);
        if self.body.large().is_none() && found.n_rigid == 0 && sag > SAG * size {
            findings.push(Finding::Sagging { body, sag, size });
        }
    }

    fn look_at_motion(&self, findings: &mut Vec<Finding>) {
        let body = self.handle;
        let [low, high] = extent(self.body);
        let speed = Vec2::from(self.body.linvel()).norm();
        let sizes = speed * self.dt / (high - low).max();
        if sizes > 1.0 {
            findings.push(Finding::Fast { body, sizes });
        }
        if let Some(edge) = self.body.edge_beside_rounding() {
            let distance = low.norm().max(high.norm());
            findings.push(Finding::FarAway {
                body,
                distance,
                edge,
            });
        }
        let n_calls = self.body.n_idle_pins();
        if n_calls > 0 {
            let note = InsertionNote::NothingPinned { body, n_calls };
            findings.push(Finding::Insertion(note));
        }
        if self.integrator.is_explicit() && self.body.large().is_none() {
            let critical = self.body.critical_step(&self.integrator);
            if self.dt > critical {
                let dt = self.dt;
                findings.push(Finding::Unstable { body, critical, dt });
            }
        }
    }
}

/// The corners of the box that a body is in (m).
fn extent(body: &FlexBody) -> [Vec2; 2] {
    let none = [Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)];
    (0..body.n_nodes()).fold(none, |[low, high], node| {
        let place = node_vec(body.positions(), node);
        [low.inf(&place), high.sup(&place)]
    })
}

/// Cells from side to side where the body is thickest: twice the number of edges from the boundary to the node that is farthest from it.
fn cells_across(mesh: &Mesh) -> usize {
    let boundary = mesh.boundary();
    let mut is_reached: Vec<bool> = (0..mesh.n_nodes())
        .map(|node| boundary.is_boundary(node))
        .collect();
    let edges = mesh.edges();
    let mut depth = 0;
    loop {
        let mut reached = is_reached.clone();
        for &[from, to] in &edges {
            if is_reached[from] || is_reached[to] {
                (reached[from], reached[to]) = (true, true);
            }
        }
        if reached == is_reached {
            return (2 * depth).max(1);
        }
        is_reached = reached;
        depth += 1;
    }
}

/// Length over thickness of the strip of the same area and circumference (-).
fn slenderness(mesh: &Mesh) -> f64 {
    let nodes = mesh.nodes();
    let (mut doubled, mut around) = (0.0, 0.0);
    for &[from, to] in mesh.boundary().segments() {
        let [from, to] = [from, to].map(|node| Vec2::from(nodes[node]));
        doubled += from.perp(&to);
        around += (to - from).norm();
    }
    0.5 * around * around / doubled
}
