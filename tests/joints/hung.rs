//! Bodies that hang by few nodes and swing: their energy stays what it was, whatever of their vibration the step resolves.

use crate::common::*;
use foil2d::fe::mesh::CellKind;
use foil2d::fe::model::MassKind;

/// Largest energy above the one at rest at the start, over `m g` times the size, of a square that swings by its topmost `n_pins` nodes.
fn gain(square: &FlexBodyBuilder, integrator: Beta2, dt: f64, n_pins: usize) -> f64 {
    let mut scene = Scene::new(dt).with_integrator(integrator);
    let square = scene.flexible(square.clone());
    let body = scene.body(square);
    let mut nodes = body.mesh().boundary().nodes().to_vec();
    nodes.sort_by(|&a, &b| body.position(b)[1].total_cmp(&body.position(a)[1]));
    let (weight, start) = (body.mass() * G, body.centre_of_mass()[1]);
    let pin = AttachmentBuilder::pin(square).nodes(nodes[..n_pins].to_vec());
    scene
        .bodies
        .attach(pin.to_world(), &scene.world.bodies)
        .expect("the description is right");
    let mut most = 0.0f64;
    for _ in 0..600 {
        scene.step();
        let body = scene.body(square);
        let energy = body.energy();
        let height = body.centre_of_mass()[1] - start;
        most = most.max((energy.kinetic + energy.elastic) / weight + height);
    }
    most / 0.5
}

fn square(cells: usize, kind: CellKind, young: f64, mass: MassKind) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle_of([0.5, 0.5], [cells, cells], kind)
        .material(elastic(young, 1900.0, 0.0))
        .mass_kind(mass)
        .rotation(-0.13)
}

/// Judges all stiffnesses from a step that resolves every vibration to one that resolves none.
fn judge(name: &str, square: impl Fn(f64) -> FlexBodyBuilder) {
    let mut findings = Findings::default();
    for integrator in [Beta2::default(), Beta2::trapezoidal()] {
        for dt in [1.0 / 60.0, 1.0 / 1000.0] {
            for power in 0..10 {
                let young = 10f64.powf(0.5 * f64::from(power)) / (dt * dt);
                // Softer ones strain by more than the few percent that one frame is good for.
                if young < 1e6 {
                    continue;
                }
                for n_pins in [1, 3] {
                    let gain = gain(&square(young), integrator, dt, n_pins);
                    // The trapezoidal rule moves energy to and fro by the square of the turn in a step.
                    findings.check(gain <= 1e-3, || {
                        format!(
                            "{name}, {integrator:?}, dt {dt}, E {young:e}, {n_pins} nodes: {gain:e}"
                        )
                    });
                }
            }
        }
    }
    findings.report();
}

#[test]
fn a_body_that_swings_by_nodes_with_mass_gains_no_energy_at_any_stiffness() {
    // Too coarse to move the mass inside.
    for kind in [CellKind::Quad4, CellKind::Tri3] {
        judge("4 x 4", |young| square(4, kind, young, MassKind::Lumped));
    }
}

#[test]
fn a_body_that_swings_by_nodes_without_mass_gains_no_energy_at_any_stiffness() {
    judge("8 x 8", |young| {
        square(8, CellKind::Quad4, young, MassKind::Lumped)
    });
}

#[test]
fn a_body_of_consistent_mass_that_swings_by_few_nodes_gains_no_energy_at_any_stiffness() {
    judge("consistent", |young| {
        square(4, CellKind::Quad4, young, MassKind::Consistent)
    });
}
