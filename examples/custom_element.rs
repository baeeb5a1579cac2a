//! A user's own element, in the user's own file: the plain bilinear quadrilateral, which locks in bending.
//!
//! An element is a set of shape functions and two quadrature rules; stiffness, mass, loads and strains follow. The suite
//! that judges the library's elements judges this one too. Used for a cantilever of square cells it shows what the
//! incompatible modes of the default element are for: without them a bent cell also shears. One layer of cells would make
//! the beam stiffer by `r = (1 / (1 - nu) + 1/2) / (1 + nu)` (Cook, Malkus, Plesha, Witt, *Concepts and Applications of
//! Finite Element Analysis*, 4th ed., section 6.6). In n layers a share `1 / n^2` of the energy is bending of the single
//! cells and the rest their stretching, so that two layers make it stiffer by `1 + (r - 1) / 4`.

#[path = "support/cli.rs"]
pub mod cli;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::fe::element::conformance::check_element;
use foil2d::fe::element::quadrature::{QuadraturePoint, SQUARE_4};
use foil2d::fe::element::{Element, Quad4};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use std::f64::consts::TAU;

/// The four-node quadrilateral, fully integrated.
///
/// ```text
///       eta
///   3 ---|--- 2
///   |    |    |
///   |    +----|-- xi      corners at (-1, -1), (1, -1), (1, 1), (-1, 1)
///   |         |
///   0 ------- 1
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BilinearQuad;

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

impl Element for BilinearQuad {
    fn name(&self) -> &'static str {
        "BilinearQuad"
    }

    fn n_corners(&self) -> usize {
        4
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        &CORNERS
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_4
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_4
    }

    fn shape(&self, [xi, eta]: [f64; 2], shape: &mut [f64]) {
        for (value, [a, b]) in shape.iter_mut().zip(CORNERS) {
            *value = 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
        }
    }

    fn shape_gradient(&self, [xi, eta]: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        for (value, [a, b]) in shape_gradient.iter_mut().zip(CORNERS) {
            *value = [0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)];
        }
    }
}

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.1;
const DIVISIONS: [usize; 2] = [20, 2];
const POISSON: f64 = 0.3;
/// Tip deflection (m) and first frequency (Hz) of the converged plane-stress solution.
const TIP: f64 = 15.1218e-3;
const FREQUENCY: f64 = 0.507_408;

/// The headline numbers.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outcome {
    /// Static tip deflection against the converged solution, `computed / exact - 1`, with the user's element (-).
    pub tip_error: f64,
    /// The same with the default element, QM6 (-).
    pub default_tip_error: f64,
    /// How much stiffer the user's element makes the beam (-), and by the theory of its locking.
    pub stiffening: f64,
    pub predicted_stiffening: f64,
}

/// Checks the element and bends a cantilever of 20 x 2 cells with it and with the default one.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    check_element(&BilinearQuad).map_err(|failure| format!("{failure:?}"))?;
    let own = tip(BilinearQuad, options)?;
    let default = tip(Quad4, options)?;
    Ok(Outcome {
        tip_error: own / TIP - 1.0,
        default_tip_error: default / TIP - 1.0,
        stiffening: default / own,
        predicted_stiffening: predicted_stiffening(),
    })
}

fn predicted_stiffening() -> f64 {
    let one_layer = (1.0 / (1.0 - POISSON) + 0.5) / (1.0 + POISSON);
    1.0 + (one_layer - 1.0) / (DIVISIONS[1] * DIVISIONS[1]) as f64
}

/// Downward deflection (m) at which the damped beam comes to rest under its own weight.
fn tip(element: impl Element + 'static, options: &Options) -> Result<f64, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, -0.1);
    let mut flex_bodies = FlexBodySet::new();
    // A mass part of twice the first frequency damps every mode at the rate of that frequency.
    let material = LinearElastic::plane_stress(1e6, POISSON)
        .density(1000.0)
        .rayleigh_mass(2.0 * TAU * FREQUENCY);
    let builder = FlexBodyBuilder::rectangle([LENGTH, HEIGHT], DIVISIONS)
        .element(element)
        .material(material)
        .contact_inertia(ContactInertia::Kept)
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let beam = flex_bodies.insert(builder, &mut world)?;
    let mut pipeline = FlexPipeline::new().with_integrator(Beta2::trapezoidal());
    for _ in 0..options.n_steps(720) {
        pipeline.step(&mut world, &mut flex_bodies)?;
    }
    // The middle of the end face.
    let node = DIVISIONS[1] / 2 * (DIVISIONS[0] + 1) + DIVISIONS[0];
    Ok(-flex_bodies[beam].displacement(node)[1])
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    options.refuse_replay()?;
    let outcome = run(&options)?;
    println!("BilinearQuad passes the conformance suite");
    println!(
        "cantilever of 20 x 2 cells: tip {:+.2} % with it, {:+.2} % with the default element",
        100.0 * outcome.tip_error,
        100.0 * outcome.default_tip_error
    );
    println!(
        "it makes the beam {:.4} times stiffer; by the theory of its locking {:.4}",
        outcome.stiffening, outcome.predicted_stiffening
    );
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}
