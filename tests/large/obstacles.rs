//! Equilibria between rigid obstacles: Hertz, sticking and sliding, and what is refused. A ring between plates and a strip over a cylinder are in the
//! verification book.

use super::support::{laws, nodes_where, plate};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::NeoHookean;
use foil2d::fe::mesh::{CellKind, generate::rectangle};
use foil2d::large::{
    ContactCase, ContactStepper, LargeError, LargeSettings, LoadCase, LoadStepper, Obstacle,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

fn exactly() -> LargeSettings {
    LargeSettings::conserving().with_tolerance(1e-9)
}

/// A grid of a neo-Hookean law in plane strain, with its places at rest.
fn grid(size: [f64; 2], cells: [usize; 2], young: f64) -> (FiniteStrainModel, Vec<f64>) {
    let mesh = rectangle(size, cells, CellKind::Quad4).expect("a grid");
    let law = NeoHookean::plane_strain(young, 0.3);
    let description = FiniteStrainDescription::new(mesh, law, 1000.0);
    let model = FiniteStrainModel::assemble(description).expect("a body");
    let rest = model.rest_positions().to_vec();
    (model, rest)
}

/// Nothing but obstacles loads what is held as `is_held` says.
fn unloaded<'a>(
    none: &'a [f64],
    is_held: &'a [bool],
    places: &'a [f64],
    n_increments: usize,
) -> LoadCase<'a> {
    LoadCase {
        from: none,
        to: none,
        is_held,
        places,
        n_increments,
    }
}

/// Both dofs of each node, held where the place of the node says so.
fn held_where(rest: &[f64], is_there: impl Fn(&[f64]) -> bool) -> Vec<bool> {
    rest.chunks_exact(2)
        .flat_map(|place| [is_there(place); 2])
        .collect()
}

/// A way that starts at zero with cells of the same size and goes on with growing ones: `sinh` of a parameter in `[-1, 1]`.
fn graded(reach: f64, steepness: f64, s: f64) -> f64 {
    reach * (steepness * s).sinh() / steepness.sinh()
}

/// Half of a cylinder of radius 1, held on a core of a tenth, on a rigid plane that comes up: with `1/E* = (1 - ν²)/E` a half-width
/// `a = √(4 F R/πE*)` and `p0 = 2 F/πa` (Hertz 1882), both from one fit of the ellipse to the pressures of the nodes, as in the book's B10. The contact is a twentieth of the
/// radius wide, which half-spaces cost some 1e-3; cells are a tenth of that.
#[test]
fn a_cylinder_on_a_plane_has_the_pressure_of_hertz() {
    let (young, nu) = (1.0, 0.3);
    let mesh = rectangle([2.0, 1.0], [96, 32], CellKind::Quad4).expect("a grid");
    let law = NeoHookean::plane_strain(young, nu);
    let mut description = FiniteStrainDescription::new(mesh, law, 1.0);
    for p in description.rest_positions.chunks_exact_mut(2) {
        let (sin, cos) = graded(FRAC_PI_2, 6.0, p[0] - 1.0).sin_cos();
        let radius = 1.0 - graded(0.9, 5.0, 1.0 - p[1]);
        // The columns of the mesh go round from the left, its upper row is the surface below.
        (p[0], p[1]) = (-radius * sin, -radius * cos);
    }
    let rest = description.rest_positions.clone();
    let model = FiniteStrainModel::assemble(description).expect("half a cylinder");
    let is_held = held_where(&rest, |p| p[0].hypot(p[1]) < 0.1 + 1e-9);
    let none = vec![0.0; rest.len()];
    let load = unloaded(&none, &is_held, &rest, 3);
    let plane = Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).moving_by([0.0, 0.0041]);
    let mut stepper = ContactStepper::new(model, exactly()).expect("good settings");
    let mut positions = rest.clone();
    let case = ContactCase {
        load,
        obstacles: &[plane],
    };
    let report = stepper.solve(case, &mut positions).expect("an equilibrium");
    let mut at: Vec<[f64; 2]> = stepper
        .contacts()
        .iter()
        // Where it was: the surface is shorter by a hundredth there, which half-spaces of small strains do not know.
        .map(|c| [rest[2 * c.node], c.normal_force])
        .collect();
    at.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let force: f64 = at.iter().map(|c| c[1]).sum();
    let a = (4.0 * force * (1.0 - nu * nu) / (PI * young)).sqrt();
    let p0 = 2.0 * force / (PI * a);
    assert!(a > 0.04 && a < 0.06, "{a}");
    let pressures = at.windows(3).map(|w| {
        let p = w[1][1] / (0.5 * (w[2][0] - w[0][0]));
        [w[1][0] * w[1][0], p * p]
    });
    let inner: Vec<[f64; 2]> = pressures.filter(|p| p[0] < 0.7 * a * a).collect();
    assert!(inner.len() > 10, "{}", inner.len());
    let n = inner.len() as f64;
    let mean = [0, 1].map(|k| inner.iter().map(|p| p[k]).sum::<f64>() / n);
    let along: f64 = inner.iter().map(|p| (p[0] - mean[0]) * p[1]).sum();
    let square: f64 = inner.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let slope = along / square;
    let squared = mean[1] - slope * mean[0];
    let (found, width) = (squared.sqrt(), (-squared / slope).sqrt());
    assert!((found / p0 - 1.0).abs() < 1e-2, "{found} {p0}");
    assert!((width / a - 1.0).abs() < 1e-2, "{width} {a}");
    // Newton's method with what touches as part of it: a handful an increment.
    assert!(
        report.n_cutbacks == 0 && report.n_iterations < 45,
        "{report:?}"
    );
}

struct Block {
    stepper: ContactStepper,
    positions: Vec<f64>,
    is_held: Vec<bool>,
    places: Vec<f64>,
    floor: Obstacle,
}

/// A block of 1 m, ν = 0, held above, that a rough floor comes up to by a hundredth.
fn block(friction: f64) -> Block {
    let model = plate(
        [1.0, 1.0],
        [6, 6],
        CellKind::Quad4,
        Arc::clone(&laws(1e3, 0.0)[2]),
    );
    let rest = model.rest_positions().to_vec();
    let mut block = Block {
        stepper: ContactStepper::new(model, exactly()).expect("good settings"),
        positions: rest.clone(),
        is_held: rest
            .chunks_exact(2)
            .flat_map(|x| [x[1] == 1.0; 2])
            .collect(),
        places: rest,
        floor: Obstacle::half_plane([0.0, 0.0], [0.0, 2.0]).with_friction(friction),
    };
    block.go([0.0, 0.01], 1);
    block
}

impl Block {
    /// Moves the floor; the forces along and across it.
    fn go(&mut self, way: [f64; 2], n_increments: usize) -> [f64; 2] {
        let none = vec![0.0; self.positions.len()];
        let load = LoadCase {
            from: &none,
            to: &none,
            is_held: &self.is_held,
            places: &self.places,
            n_increments,
        };
        let floor = self.floor.moving_by(way);
        let case = ContactCase {
            load,
            obstacles: &[floor],
        };
        self.stepper
            .solve(case, &mut self.positions)
            .expect("an equilibrium");
        self.floor = floor.moved();
        let contacts = self.stepper.contacts();
        // The normal points up, so what is to the left of it points back.
        let along: f64 = contacts.iter().map(|c| -c.friction_force).sum();
        [along, contacts.iter().map(|c| c.normal_force).sum()]
    }
}

/// What sticks is as if it were held: the same places as of a body whose lower side is held and moved by [`LoadStepper`].
#[test]
fn what_sticks_is_as_if_it_were_held() {
    let mut block = block(100.0);
    let before = block.positions.clone();
    let [along, across] = block.go([2e-3, 0.0], 2);
    assert!(along > 0.0 && across > 0.0);
    assert!(block.stepper.contacts().iter().all(|c| c.sticks));
    let model = plate(
        [1.0, 1.0],
        [6, 6],
        CellKind::Quad4,
        Arc::clone(&laws(1e3, 0.0)[2]),
    );
    let lower = nodes_where(&model, |[_, y]| y == 0.0);
    let (mut is_held, mut places) = (block.is_held.clone(), block.places.clone());
    for node in lower {
        places[2 * node] = before[2 * node] + 2e-3;
        places[2 * node + 1] = before[2 * node + 1];
        is_held[2 * node] = true;
        is_held[2 * node + 1] = true;
    }
    let none = vec![0.0; places.len()];
    let mut positions = before;
    let mut stepper = LoadStepper::new(model, exactly()).expect("good settings");
    let case = LoadCase {
        from: &none,
        to: &none,
        is_held: &is_held,
        places: &places,
        n_increments: 2,
    };
    stepper.solve(case, &mut positions).expect("an equilibrium");
    for (held, stuck) in positions.iter().zip(&block.positions) {
        assert!((held - stuck).abs() < 1e-9, "{held} {stuck}");
    }
}

/// What slides all over pulls with `μ` times what presses, to rounding, in the direction in which the floor goes; back it sticks first, and then pulls the
/// other way. Each node answers for itself.
#[test]
fn what_slides_pulls_with_its_coefficient_and_sticks_when_it_turns_round() {
    let mut block = block(0.3);
    let [along, across] = block.go([0.02, 0.0], 8);
    assert!(
        (along / (0.3 * across) - 1.0).abs() < 1e-8,
        "{along} {across}"
    );
    for contact in block.stepper.contacts() {
        let error = -contact.friction_force - 0.3 * contact.normal_force;
        assert!(!contact.sticks && error.abs() < 1e-8 * across);
    }
    let [along, across] = block.go([-1e-4, 0.0], 1);
    assert!(
        along > 0.1 * across && along < 0.298 * across,
        "{along} {across}"
    );
    assert!(block.stepper.contacts().iter().any(|c| c.sticks));
    let [along, across] = block.go([-0.03, 0.0], 8);
    assert!(
        (along / (0.3 * across) + 1.0).abs() < 1e-8,
        "{along} {across}"
    );
    // It lets go of a floor that goes down.
    let [_, across] = block.go([0.0, -0.1], 1);
    assert_eq!(across, 0.0);
    for (x, place) in block.positions.iter().zip(&block.places) {
        assert!((x - place).abs() < 1e-12);
    }
}

/// A strip that lies over half of a rough drum, both of its ends drawn down by the same, and one of them on until all of it slides: `T2/T1 = exp(μ π R/Rm)` with
/// the mean radius of the strip. Nodes that let go and close again in the iterations go on sliding; held back to where the increment began, they would go round
/// in circles for ever.
#[test]
fn a_strip_over_a_drum_is_drawn_with_the_ratio_of_the_capstan() {
    let (thickness, friction) = (0.05, 0.3);
    for (kind, n_cells) in [
        (CellKind::Quad4, 40),
        (CellKind::Quad4, 20),
        (CellKind::Tri6, 40),
        (CellKind::Quad8, 40),
    ] {
        let mesh = rectangle([PI, thickness], [n_cells, 1], kind).expect("a grid");
        let law = NeoHookean::plane_strain(1e6, 0.3);
        let mut description = FiniteStrainDescription::new(mesh, law, 1000.0);
        let along: Vec<f64> = (description.rest_positions.chunks_exact(2))
            .map(|x| x[0])
            .collect();
        for place in description.rest_positions.chunks_exact_mut(2) {
            let (angle, radius) = (PI - place[0], 1.0 + place[1]);
            place.copy_from_slice(&[radius * angle.cos(), radius * angle.sin()]);
        }
        let model = FiniteStrainModel::assemble(description).expect("a strip");
        let rest = model.rest_positions().to_vec();
        let ends: [Vec<bool>; 2] = [
            along.iter().map(|x| *x < 1e-9).collect(),
            along.iter().map(|x| *x > PI - 1e-9).collect(),
        ];
        let is_held: Vec<bool> = (ends[0].iter().zip(&ends[1]))
            .flat_map(|(one, other)| [*one || *other; 2])
            .collect();
        let none = vec![0.0; rest.len()];
        let drum = [Obstacle::disc([0.0, 0.0], 1.0 - 1e-9).with_friction(friction)];
        let settings = LargeSettings::conserving().with_tolerance(1e-7);
        let mut stepper = ContactStepper::new(model, settings).expect("good settings");
        let mut positions = rest.clone();
        let mut pulls = [0.0; 2];
        for drawn in [[0.01, 0.01], [0.01, 0.05], [0.01, 0.1], [0.01, 0.15]] {
            let mut places = rest.clone();
            for (end, way) in ends.iter().zip(drawn) {
                for node in (0..along.len()).filter(|node| end[*node]) {
                    places[2 * node + 1] -= way;
                }
            }
            let case = ContactCase {
                load: unloaded(&none, &is_held, &places, 5),
                obstacles: &drum,
            };
            let report = stepper.solve(case, &mut positions).expect("an equilibrium");
            assert_eq!(report.n_cutbacks, 0, "{kind:?} {n_cells}: {drawn:?}");
            let reaction = stepper.reaction();
            pulls = [0, 1].map(|end| {
                let nodes = (0..along.len()).filter(|node| ends[end][*node]);
                nodes.map(|node| -reaction[2 * node + 1]).sum()
            });
        }
        assert!(stepper.contacts().iter().all(|contact| !contact.sticks));
        let expected = (friction * PI / (1.0 + 0.5 * thickness)).exp();
        let ratio = pulls[1] / pulls[0] / expected;
        println!("{kind:?} {n_cells}: {ratio}");
        assert!((ratio - 1.0).abs() < 0.02, "{kind:?} {n_cells}: {ratio}");
    }
}

/// A rough disc that is pressed into a block and drawn along it.
#[test]
fn a_rough_disc_irons_a_block() {
    for (kind, cells) in [
        (CellKind::Quad4, [24, 6]),
        (CellKind::Tri6, [17, 8]),
        (CellKind::Quad8, [20, 5]),
        (CellKind::Quad8, [33, 6]),
    ] {
        for friction in [0.08, 0.3, 0.6] {
            let mesh = rectangle([2.0, 1.0], cells, kind).expect("a grid");
            let law = NeoHookean::plane_strain(1e6, 0.3);
            let description = FiniteStrainDescription::new(mesh, law, 1.0);
            let model = FiniteStrainModel::assemble(description).expect("a block");
            let rest = model.rest_positions().to_vec();
            let is_held = held_where(&rest, |place| place[1] < 1e-9);
            let none = vec![0.0; rest.len()];
            let settings = LargeSettings::conserving().with_tolerance(1e-7);
            let mut stepper = ContactStepper::new(model, settings).expect("good settings");
            let mut positions = rest.clone();
            let mut disc = Obstacle::disc([0.8, 2.0], 1.0).with_friction(friction);
            for way in [[0.0, -0.05], [0.15, 0.0]] {
                let going = disc.moving_by(way);
                let case = ContactCase {
                    load: unloaded(&none, &is_held, &rest, 10),
                    obstacles: &[going],
                };
                let found = stepper.solve(case, &mut positions);
                assert!(found.is_ok(), "{kind:?} {cells:?}, {friction}: {found:?}");
                disc = going.moved();
            }
            let contacts = stepper.contacts();
            assert!(!contacts.is_empty() && contacts.iter().all(|contact| !contact.sticks));
            for contact in contacts {
                let share = contact.friction_force.abs() / contact.normal_force;
                assert!(contact.normal_force > 0.0 && (share / friction - 1.0).abs() < 1e-6);
            }
        }
    }
}

/// A plate that touches its support, or begins a little inside it, is held by that alone, whatever holds it along: a load of its own balances what the
/// support gives, on a slope too where friction holds it.
#[test]
fn what_lies_on_its_support_is_loaded_there() {
    for (depth, slope, friction, is_guided) in [
        (0.0, 0.0, 0.0, true),
        (0.0, 0.0, 0.5, true),
        (0.0, 0.0, 0.5, false),
        (0.0, 0.3, 0.5, false),
        (1e-3, 0.3, 0.5, false),
    ] {
        let (model, rest) = grid([1.0, 0.5], [8, 4], 1e5);
        let n = rest.len() / 2;
        let is_held: Vec<bool> = rest
            .chunks_exact(2)
            .flat_map(|p| [is_guided && p[0] == 0.0, false])
            .collect();
        let (sin, cos) = f64::sin_cos(slope);
        let (weight, none) = (1000.0, vec![0.0; rest.len()]);
        let load = [weight * sin / n as f64, -weight * cos / n as f64].repeat(n);
        let case = ContactCase {
            load: LoadCase {
                from: &none,
                to: &load,
                is_held: &is_held,
                places: &rest,
                n_increments: 10,
            },
            obstacles: &[Obstacle::half_plane([0.0, depth], [0.0, 1.0]).with_friction(friction)],
        };
        let mut stepper = ContactStepper::new(model, exactly()).expect("good settings");
        let mut positions = rest.clone();
        let context =
            format!("{depth} m deep, {slope} rad, friction {friction}, guided {is_guided}");
        let report = stepper.solve(case, &mut positions);
        report.unwrap_or_else(|error| panic!("{context}: {error}"));
        let contacts = stepper.contacts();
        let normal: f64 = contacts.iter().map(|c| c.normal_force).sum();
        let along: f64 = contacts.iter().map(|c| c.friction_force.abs()).sum();
        assert!(
            (normal - weight * cos).abs() < 1e-5 * weight,
            "{context}: {normal} N"
        );
        assert!(friction > 0.0 || along < 1e-6, "{context}: {along} N along");
        let total: f64 = contacts.iter().map(|c| c.friction_force).sum();
        let expected = if is_guided { total } else { weight * sin };
        assert!(
            (total - expected).abs() < 1e-5 * weight,
            "{context}: {total} N along"
        );
    }
}

#[test]
fn obstacles_that_are_none_and_nodes_between_two_are_refused_and_nothing_moves() {
    let model = plate(
        [1.0, 1.0],
        [4, 4],
        CellKind::Quad4,
        Arc::clone(&laws(1e3, 0.3)[2]),
    );
    let rest = model.rest_positions().to_vec();
    let is_held = held_where(&rest, |x| x[1] == 1.0);
    let none = vec![0.0; rest.len()];
    let load = unloaded(&none, &is_held, &rest, 1);
    let mut stepper = ContactStepper::new(model, exactly()).expect("good settings");
    let mut positions = rest.clone();
    for obstacle in [
        Obstacle::disc([0.0, -1.0], 0.0),
        Obstacle::disc([0.0, f64::NAN], 0.5),
        Obstacle::half_plane([0.0, -1.0], [0.0, 0.0]),
        Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).with_friction(-0.1),
        Obstacle::segment([[0.0, -1.0], [1.0, -1.0]], 0.1).moving_by([0.0, f64::INFINITY]),
    ] {
        let floor = Obstacle::half_plane([0.0, -0.5], [0.0, 1.0]);
        let obstacles = &[floor, obstacle];
        let error = stepper
            .solve(ContactCase { load, obstacles }, &mut positions)
            .expect_err("no obstacle");
        assert!(
            matches!(error, LargeError::Obstacle { index: 1, .. }),
            "{error}"
        );
    }
    // The lower left corner would have to stay out of both.
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).moving_by([0.0, 0.01]);
    let wall = Obstacle::half_plane([0.0, 0.0], [1.0, 0.0]).moving_by([0.005, 0.0]);
    let obstacles = &[floor, wall];
    let error = stepper
        .solve(ContactCase { load, obstacles }, &mut positions)
        .expect_err("a corner");
    assert!(matches!(error, LargeError::Wedged { .. }), "{error}");
    assert_eq!(positions, rest);
}

/// Nothing is passed through between two increments, however few there are: it is met in smaller ones, or told.
#[test]
fn no_obstacle_goes_through_a_body_within_an_increment() {
    for n_increments in [1, 2, 4, 10] {
        // A strip that is held at both ends, and a disc that goes down by a quarter of its length.
        let (model, rest) = grid([1.0, 0.02], [40, 1], 1e6);
        let is_held = held_where(&rest, |p| p[0] == 0.0 || p[0] == 1.0);
        let none = vec![0.0; rest.len()];
        let load = unloaded(&none, &is_held, &rest, n_increments);
        let disc = Obstacle::disc([0.5, 0.08], 0.05).moving_by([0.0, -0.25]);
        let mut stepper =
            ContactStepper::new(model, LargeSettings::conserving()).expect("good settings");
        let mut positions = rest.clone();
        let obstacles = &[disc];
        stepper
            .solve(ContactCase { load, obstacles }, &mut positions)
            .expect("an equilibrium");
        let middle = positions[2 * (41 + 20) + 1];
        assert!((middle + 0.22).abs() < 1e-4, "{n_increments}: {middle}");
        assert!(!stepper.contacts().is_empty());
    }
    for way in [0.5, 0.9, 1.2, 2.0] {
        // Into the side of a block, and out of the other one.
        let (model, rest) = grid([1.0, 1.0], [8, 8], 1e5);
        let is_held = held_where(&rest, |p| p[1] == 1.0);
        let none = vec![0.0; rest.len()];
        let load = unloaded(&none, &is_held, &rest, 1);
        let disc = Obstacle::disc([-0.3, 0.5], 0.1).moving_by([way, 0.0]);
        let mut stepper =
            ContactStepper::new(model, LargeSettings::default()).expect("good settings");
        let mut positions = rest.clone();
        let obstacles = &[disc];
        match stepper.solve(ContactCase { load, obstacles }, &mut positions) {
            Ok(_) => assert!(!stepper.contacts().is_empty(), "{way} m: nothing touches"),
            Err(_) => assert_eq!(positions, rest, "{way} m"),
        }
    }
}

/// Nothing but a floor that it has not come to holds a plate: there is no equilibrium on the way, and that is what is told.
#[test]
fn what_nothing_holds_yet_is_told() {
    let (model, rest) = grid([1.0, 0.5], [8, 4], 1e5);
    let n = rest.len() / 2;
    // Free, on a vertical guide, and on a pin.
    let held: [fn(&[f64], usize) -> bool; 3] = [
        |_, _| false,
        |place, axis| place[0] == 0.0 && axis == 0,
        |place, _| place == [0.0, 0.0],
    ];
    for is_held in held {
        let is_held: Vec<bool> = rest
            .chunks_exact(2)
            .flat_map(|place| [0, 1].map(|axis| is_held(place, axis)))
            .collect();
        let (none, load) = (vec![0.0; rest.len()], [0.0, -1000.0 / n as f64].repeat(n));
        let case = ContactCase {
            load: LoadCase {
                from: &none,
                to: &load,
                is_held: &is_held,
                places: &rest,
                n_increments: 10,
            },
            obstacles: &[Obstacle::half_plane([0.0, -0.01], [0.0, 1.0])],
        };
        let mut stepper = ContactStepper::new(model.clone(), exactly()).expect("good settings");
        let mut positions = rest.clone();
        let error = stepper
            .solve(case, &mut positions)
            .expect_err("no equilibrium");
        assert!(matches!(error, LargeError::Singular { .. }), "{error}");
        assert_eq!(positions, rest);
    }
}
