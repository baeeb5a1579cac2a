//! Strips between two walls.

use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

pub const LENGTH: f64 = 1.0;
pub const HEIGHT: f64 = 0.02;
pub const THICKNESS: f64 = 0.3;
pub const YOUNG: f64 = 2e6;
pub const DENSITY: f64 = 1000.0;
pub const STRETCH: f64 = 1.05;

pub struct Run {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub strip: FlexBodyHandle,
}

impl Run {
    /// A body in a world without gravity.
    pub fn new(body: FlexBodyBuilder, dt: f64) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0);
        world.integration_parameters.dt = dt as Real;
        let mut flex_bodies = FlexBodySet::new();
        let strip = flex_bodies
            .insert(body, &mut world)
            .expect("a body of large strain");
        Self {
            world,
            flex_bodies,
            flex: FlexPipeline::new(),
            strip,
        }
    }

    pub fn step(&mut self) {
        self.flex
            .step(&mut self.world, &mut self.flex_bodies)
            .expect("a step without contact");
    }

    pub fn strip(&self) -> &FlexBody {
        &self.flex_bodies[self.strip]
    }

    /// Forces that hold the right end and the left one, along the strip (N).
    pub fn pulls(&self) -> [f64; 2] {
        [LENGTH, 0.0].map(|at| {
            let nodes = self.strip().mesh().nodes().iter().enumerate();
            let end = nodes.filter(|(_, [x, _])| *x == at);
            end.map(|(node, _)| self.strip().reaction(node)[0]).sum()
        })
    }
}

pub fn is_end([x, _]: [f64; 2]) -> bool {
    x == 0.0 || x == LENGTH
}

/// A strip of 40 x 2 cells, pinned at both ends.
pub fn strip(material: impl Material + 'static) -> FlexBodyBuilder {
    free_strip(material).pin_where(is_end, Pin::both())
}

pub fn free_strip(material: impl Material + 'static) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([LENGTH, HEIGHT], [40, 2])
        .material(material)
        .thickness(THICKNESS)
}

pub fn hooke() -> LinearElastic {
    LinearElastic::plane_stress(YOUNG, 0.3).density(DENSITY)
}

/// Lamé's constants of the neo-Hookean law in the plane that is Hooke's law of [`hooke`] at rest: `μ`, and that `λ` with which
/// `E/(1 - ν²) = λ + 2 μ`.
pub fn constants() -> [f64; 2] {
    let nu = 0.3;
    let mu = 0.5 * YOUNG / (1.0 + nu);
    [YOUNG / (1.0 - nu * nu) - 2.0 * mu, mu]
}

/// Root of a rising function between two places.
pub fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The neo-Hookean solid `W = μ/2 (λx² + λy² - 2) - μ ln J + λ/2 ln² J` stretched along x with free sides: the stretch along y and the nominal stress along x (Pa).
pub fn neo_hookean([lambda, mu]: [f64; 2], stretch: f64) -> [f64; 2] {
    let nominal = |own: f64, other: f64| mu * (own - 1.0 / own) + lambda * (own * other).ln() / own;
    let across = root(|across| nominal(across, stretch), [0.2, 3.0]);
    [across, nominal(stretch, across)]
}
