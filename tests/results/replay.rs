//! The page of a replay holds what the bodies had, to the rounding that its documentation tells. That it plays is seen in a browser only.

use super::grid::from_base64;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::io::{Replay, Scene};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde_json::Value;
use std::error::Error;

type Outcome = Result<(), Box<dyn Error>>;

/// The data of a page.
fn data_of(html: &str) -> Result<Value, Box<dyn Error>> {
    let mark = "<script type=\"application/json\" id=\"data\">";
    let (_, rest) = html.split_once(mark).ok_or("there are data")?;
    let (json, _) = rest.split_once("</script>").ok_or("they end")?;
    Ok(serde_json::from_str(json)?)
}

fn bytes(value: &Value) -> Vec<u8> {
    from_base64(value.as_str().expect("a text"))
}

fn singles(value: &Value) -> Vec<f64> {
    let bytes = bytes(value);
    let four = |chunk: &[u8]| f32::from_le_bytes(chunk.try_into().expect("four bytes"));
    bytes
        .chunks(4)
        .map(|chunk| f64::from(four(chunk)))
        .collect()
}

fn number(value: &Value, key: &str) -> usize {
    value[key].as_u64().expect("a number") as usize
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list").iter();
    list.map(|one| one.as_f64().expect("a number")).collect()
}

/// A range decoder, with the code and the range as the textbook has them.
struct Decoder<'a> {
    bytes: &'a [u8],
    at: usize,
    code: u64,
    range: u64,
}

impl Decoder<'_> {
    fn next(&mut self) {
        self.code = self.code << 8 | u64::from(self.bytes[self.at]);
        self.at += 1;
    }

    fn split(&mut self, bound: u64) -> bool {
        let is_above = self.code >= bound;
        if is_above {
            self.code -= bound;
            self.range -= bound;
        } else {
            self.range = bound;
        }
        is_above
    }

    fn bit(&mut self, odds: &mut u64) -> bool {
        let bit = self.split((self.range >> 11) * *odds);
        *odds = if bit {
            *odds - *odds / 32
        } else {
            *odds + (2048 - *odds) / 32
        };
        self.fill();
        bit
    }

    fn even(&mut self) -> bool {
        self.range /= 2;
        let bit = self.code >= self.range;
        self.code -= if bit { self.range } else { 0 };
        self.fill();
        bit
    }

    fn fill(&mut self) {
        while self.range < 1 << 24 {
            self.range <<= 8;
            self.next();
        }
    }
}

/// Frames of channels of values, as the codec's documentation describes them.
fn decode(bytes: &[u8], n_channels: usize, n: usize, n_frames: usize) -> Vec<Vec<i32>> {
    assert_eq!(bytes[0], 0);
    let mut decoder = Decoder {
        bytes,
        at: 1,
        code: 0,
        range: u64::from(u32::MAX),
    };
    (0..4).for_each(|_| decoder.next());
    let mut channels = vec![Vec::<i32>::new(); n_channels];
    let mut lengths = vec![vec![[1024; 32]; 16]; n_channels];
    let mut seconds = vec![[1024; 33]; n_channels];
    let mut before = vec![vec![0; n]; n_channels];
    for frame in 0..n_frames {
        for (index, channel) in channels.iter_mut().enumerate() {
            let [runs, turns, moves] = std::array::from_fn(|_| decoder.even());
            let (mut changes, mut left) = (vec![0, 0], 0);
            for place in 0..n {
                let context = &mut lengths[index][15.min(left + before[index][place])];
                let mut length = 0;
                while length < 32 && decoder.bit(&mut context[length]) {
                    length += 1;
                }
                let is_negative = length > 0 && decoder.even();
                let mut size = i64::from(length > 0);
                for bit in (0..length.max(1) - 1).rev() {
                    let is_second = bit + 2 == length;
                    let bit = if is_second {
                        decoder.bit(&mut seconds[index][length])
                    } else {
                        decoder.even()
                    };
                    size = 2 * size + i64::from(bit);
                }
                (left, before[index][place]) = (length, length);
                let value = |back: usize| match frame {
                    0 => 0,
                    _ => channel[frame.saturating_sub(back) * n + place],
                };
                let expected = if runs {
                    2 * value(1) - value(2)
                } else {
                    value(1)
                };
                let [.., second, first] = changes[..] else {
                    panic!("two zeros to begin with");
                };
                let shared = match [turns, moves] {
                    [true, _] => 2 * first - second,
                    [false, true] => first,
                    [false, false] => 0,
                };
                let change = shared
                    + if is_negative {
                        -size as i32
                    } else {
                        size as i32
                    };
                changes.push(change);
                channel.push(expected + change);
            }
        }
    }
    assert!(
        bytes.len() - decoder.at <= 1,
        "{} of {} bytes",
        decoder.at,
        bytes.len()
    );
    channels
}

/// What is kept of a node in a frame: displacement, von Mises stress, force.
#[derive(Clone, Copy)]
struct Kept {
    at: [f64; 2],
    von_mises: f64,
    force: [f64; 2],
}

fn kept(body: &FlexBody) -> Result<Vec<Kept>, Box<dyn Error>> {
    let von_mises = body.von_mises()?;
    let one = |node: usize| Kept {
        at: body.displacement(node),
        von_mises: von_mises[node],
        force: body.contact_force(node),
    };
    Ok((0..body.n_nodes()).map(one).collect())
}

/// Half a step of a root, back in values: `v = full (q / steps)²`.
fn assert_root(what: &str, q: i32, steps: f64, full: f64, expected: f64) {
    let root = (expected.abs() / full.max(1e-300)).sqrt() * steps * expected.signum();
    assert!((f64::from(q) - root).abs() < 0.51, "{what}: {q} {root}");
}

fn check_flexible(track: &Value, frames: &[Vec<Kept>], first: usize) {
    assert_eq!(
        (number(track, "first"), number(track, "n")),
        (first, frames.len())
    );
    let nodes: Vec<usize> = numbers(&track["nodes"])
        .iter()
        .map(|&node| node as usize)
        .collect();
    let n = nodes.len();
    let channels = decode(&bytes(&track["stream"]), 8, n, frames.len());
    let (range, full) = (numbers(&track["box"]), numbers(&track["full"]));
    for (frame, kept) in frames.iter().enumerate() {
        for (place, &node) in nodes.iter().enumerate() {
            let (q, kept) = (
                |channel: usize| channels[channel][frame * n + place],
                kept[node],
            );
            for axis in 0..2 {
                let (low, extent) = (range[2 * axis], range[2 * axis + 1]);
                let at = low + extent * f64::from(q(axis)) / 8191.0;
                assert!((at - kept.at[axis]).abs() <= 0.51 * extent / 8191.0, "{at}");
            }
            assert_root("von Mises", q(2), 255.0, full[0], kept.von_mises);
            assert_root("force x", q(6), 127.0, full[2], kept.force[0]);
            assert_root("force y", q(7), 127.0, full[2], kept.force[1]);
        }
    }
}

fn block(at: [f64; 2], kind: CellKind) -> Result<FlexBodyBuilder, Box<dyn Error>> {
    let mesh = generate::rectangle([0.4, 0.2], [4, 2], kind)?;
    let material = LinearElastic::plane_strain(5e5, 0.3).density(900.0);
    Ok(FlexBodyBuilder::mesh(mesh)
        .material(material)
        .translation(at)
        .friction(0.5))
}

/// A block falls, another comes when it lies and the first is taken away again; a ball rolls by more than a turn.
#[test]
fn a_page_holds_what_the_bodies_had() -> Outcome {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 60.0;
    world.insert_collider(
        ColliderBuilder::cuboid(40.0, 0.1).translation(Vector::new(0.0, -0.1)),
        None,
    );
    let ball = RigidBodyBuilder::dynamic()
        .translation(Vector::new(1.0, 0.1))
        .linvel(Vector::new(2.0, 0.0))
        .angvel(-20.0);
    let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.1));
    let mut bodies = FlexBodySet::new();
    let first = bodies.insert(block([0.0, 0.1], CellKind::Tri6)?, &mut world)?;
    let mut pipeline = FlexPipeline::new();
    let mut replay = Replay::new("A <block> & \"another\"");
    let (mut tracks, mut second) = ([Vec::new(), Vec::new()], None);
    let (mut angles, mut energies) = (Vec::new(), Vec::new());
    for step in 0..48 {
        if step == 16 {
            second = Some(bodies.insert(block([0.1, 0.4], CellKind::Quad4)?, &mut world)?);
        }
        if step == 32 {
            bodies.remove(first, &mut world)?;
        }
        pipeline.step(&mut world, &mut bodies)?;
        replay.record(
            f64::from(step) / 60.0,
            &Scene::of(&world, &bodies, pipeline.report()),
        )?;
        energies.push(pipeline.report().energy().total());
        if step % 2 == 0 {
            for (track, handle) in tracks.iter_mut().zip([Some(first), second]) {
                if let Some(body) = handle.and_then(|handle| bodies.get(handle)) {
                    track.push(kept(body)?);
                }
            }
            angles.push(f64::from(world.bodies[ball].rotation().angle()));
        }
    }
    let html = replay.to_html();
    assert!(html.contains("<title>A &lt;block&gt; &amp; \"another\"</title>"));
    for outside in ["http:", "https:", "src=", "href=", "@import", "url("] {
        assert!(!html.contains(outside), "the page asks for {outside}");
    }
    let data = data_of(&html)?;
    assert_eq!(data["title"], "A <block> & \"another\"");
    let times = singles(&data["times"]);
    assert_eq!(times.len(), 24);
    assert!(
        times
            .iter()
            .enumerate()
            .all(|(frame, time)| (time - frame as f64 / 30.0).abs() < 1e-6)
    );
    let total = singles(&data["total"]);
    assert_eq!(total.len(), 48);
    for (found, expected) in total.iter().zip(&energies) {
        assert!(
            (found - expected).abs() <= 1e-6 * expected.abs(),
            "{found} {expected}"
        );
    }
    let flexible = data["flexible"].as_array().ok_or("a list")?;
    assert_eq!(flexible.len(), 2);
    check_flexible(&flexible[0], &tracks[0], 0);
    check_flexible(&flexible[1], &tracks[1], 8);
    assert!(tracks[0].len() == 16 && tracks[1].len() == 16);
    let pressed = tracks[0].iter().flatten().any(|kept| kept.force[1] > 1.0);
    assert!(pressed, "the block has not come down");

    let rigid = data["rigid"].as_array().ok_or("a list")?;
    let track = rigid.last().ok_or("there is the ball")?;
    let channels = decode(&bytes(&track["stream"]), 3, 1, 24);
    for (q, expected) in channels[2].iter().zip(&angles) {
        let off = f64::from(*q) * 1e-4 - expected;
        let turns = off / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-4, "{q} {expected}");
    }
    let jump = channels[2]
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .max();
    assert!(jump < Some(10_000), "the angle jumps by {jump:?}");
    let turned = (channels[2][23] - channels[2][0]).abs();
    assert!(turned > 62_832, "the ball has turned by {turned}e-4 rad");
    Ok(())
}

/// Ten strips of 50 nodes, all on their surfaces, fall between walls and are stirred: a minute of what happens in the first two seconds is to stay
/// below 3 MB. `FOIL2D_STEPS` takes the number of steps.
/// A sensor touches nothing: it is drawn in dashes and left empty, a box beside it is filled.
#[test]
fn sensors_are_drawn_as_what_touches_nothing() -> Outcome {
    let mut world = PhysicsWorld::new();
    for (x, is_sensor) in [(-1.0, false), (1.0, true)] {
        let square = ColliderBuilder::cuboid(0.3, 0.3).sensor(is_sensor);
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, 2.0));
        world.insert(body, square);
    }
    let mut bodies = FlexBodySet::new();
    bodies.insert(block([0.0, 2.0], CellKind::Quad4)?, &mut world)?;
    let (mut pipeline, mut replay) = (FlexPipeline::new(), Replay::new("Sensor"));
    for step in 1..=5 {
        pipeline.step(&mut world, &mut bodies)?;
        let scene = Scene::of(&world, &bodies, pipeline.report());
        replay.record(f64::from(step) / 60.0, &scene)?;
    }
    let scene = Scene::of(&world, &bodies, pipeline.report());
    let picture = foil2d::io::still(&scene)?;
    let outlines: Vec<&str> = picture
        .lines()
        .filter(|line| line.contains("#6b7686"))
        .collect();
    assert_eq!(outlines.len(), 2, "{outlines:?}");
    let dashed = outlines
        .iter()
        .filter(|line| line.contains("stroke-dasharray") && line.contains("fill=\"none\""));
    assert_eq!(dashed.count(), 1);
    let data = data_of(&replay.to_html())?;
    let rigid = data["rigid"].as_array().ok_or("there are two")?;
    let sensors: Vec<Option<bool>> = rigid.iter().map(|one| one["sensor"].as_bool()).collect();
    assert_eq!(sensors, [Some(false), Some(true)]);
    if let Some(folder) = std::env::var_os("FOIL2D_KEEP") {
        let folder = std::path::PathBuf::from(folder);
        replay.write(folder.join("sensor.html"))?;
        foil2d::io::write_still(folder.join("sensor.svg"), &scene)?;
    }
    Ok(())
}

#[test]
fn a_minute_of_five_hundred_surface_nodes_stays_below_three_megabytes() -> Outcome {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 60.0;
    for (at, half) in [
        ([0.0, -0.1], [1.5, 0.1]),
        ([-1.2, 2.0], [0.1, 2.0]),
        ([1.2, 2.0], [0.1, 2.0]),
    ] {
        let wall = ColliderBuilder::cuboid(half[0] as Real, half[1] as Real);
        world.insert_collider(
            wall.translation(Vector::new(at[0] as Real, at[1] as Real)),
            None,
        );
    }
    // A stirrer, so that nothing comes to rest.
    let stirrer = RigidBodyBuilder::kinematic_velocity_based()
        .translation(Vector::new(0.0, 0.7))
        .angvel(1.5);
    world.insert(stirrer, ColliderBuilder::cuboid(0.45, 0.05));
    let mut bodies = FlexBodySet::new();
    let mut n_surface = 0;
    for index in 0..10 {
        let mesh = generate::rectangle([0.6, 0.05], [24, 1], CellKind::Quad4)?;
        n_surface += mesh.boundary().nodes().len();
        let angle = 0.4 * f64::from(index);
        let centre = [
            -0.7 + 0.7 * f64::from(index % 3),
            1.5 + 0.65 * f64::from(index / 3),
        ];
        let (sin, cos) = angle.sin_cos();
        let body = FlexBodyBuilder::mesh(mesh)
            .material(LinearElastic::plane_strain(1e7, 0.3).density(900.0))
            .small_strain()
            .rotation(angle)
            .translation([
                centre[0] - 0.3 * cos + 0.025 * sin,
                centre[1] - 0.3 * sin - 0.025 * cos,
            ])
            .linvel([0.0, -3.0])
            .angvel(3.0);
        bodies.insert(body, &mut world)?;
    }
    assert_eq!(n_surface, 500);
    let mut pipeline = FlexPipeline::new();
    let mut replay = Replay::new("Tumbling");
    let n_steps = std::env::var("FOIL2D_STEPS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(120);
    let (mut half, mut n_lively) = (0, 0);
    for step in 1..=n_steps {
        pipeline.step(&mut world, &mut bodies)?;
        replay.record(
            f64::from(step) / 60.0,
            &Scene::of(&world, &bodies, pipeline.report()),
        )?;
        n_lively += i32::from(pipeline.report().energy().kinetic > 1.0);
        if step == n_steps / 2 {
            half = replay.to_html().len();
        }
    }
    let whole = replay.to_html().len();
    // Page and meshes are there once.
    let per_step = (whole - half) as f64 / f64::from(n_steps - n_steps / 2);
    let minute = whole as f64 + per_step * f64::from(3600 - n_steps);
    println!("a minute: {minute:.0} bytes, {per_step:.0} a step");
    if let Some(folder) = std::env::var_os("FOIL2D_KEEP") {
        replay.write(std::path::PathBuf::from(folder).join("tumbling.html"))?;
    }
    assert!(minute < 3e6, "{minute}");
    assert!(
        2 * n_lively > n_steps,
        "it moves in {n_lively} of {n_steps} steps"
    );
    Ok(())
}
