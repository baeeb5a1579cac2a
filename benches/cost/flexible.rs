//! A body of this crate, and the steps rapier takes for it.

use crate::measure::{Burst, Clock, Outcome, Side, median};
use crate::scene::{DENSITY, POISSON, Phase, Scene};
use foil2d::coupling::RapierSets;
use foil2d::fe::mesh::CellKind;
use foil2d::pipeline::StepError;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// Stiffness-proportional damping of the block (s): a third of critical at its lowest frequencies, so that it rests.
const BLOCK_DAMPING: f64 = 2e-3;

/// One scene with a flexible body.
pub struct FlexSide {
    scene: Scene,
    kind: CellKind,
    world: PhysicsWorld,
    bodies: FlexBodySet,
    body: FlexBodyHandle,
    pipeline: FlexPipeline,
    carrier: CarrierAlone,
}

impl FlexSide {
    pub fn new(scene: &Scene, kind: CellKind) -> Outcome<Self> {
        let mut world = scene.world();
        let mut bodies = FlexBodySet::new();
        let body = bodies.insert(builder(scene, kind)?, &mut world)?;
        Ok(Self {
            scene: *scene,
            kind,
            world,
            bodies,
            body,
            pipeline: FlexPipeline::new(),
            carrier: CarrierAlone::new(scene, kind)?,
        })
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.pipeline
            .step(&mut self.world, &mut self.bodies)
            .map(|_| ())
    }

    fn surface(&self) -> Vec<Vector> {
        let collider = &self.world.colliders[self.bodies[self.body].collider_handle()];
        let polyline = collider.shape().as_polyline();
        polyline.map_or_else(Vec::new, |polyline| polyline.vertices().to_vec())
    }
}

impl Side for FlexSide {
    fn label(&self) -> String {
        format!("foil2d {:?}", self.kind)
    }

    fn n_warm_up(&self) -> usize {
        self.scene.n_warm_up
    }

    fn advance(&mut self, n_steps: usize) -> Outcome<()> {
        for _ in 0..n_steps {
            self.step()?;
        }
        self.carrier.replay(&[(false, self.surface())]);
        Ok(())
    }

    fn burst(&mut self, n_steps: usize, clock: &Clock) -> Outcome<Option<Burst>> {
        let mut steps = Vec::with_capacity(n_steps);
        let mut moves = Vec::with_capacity(n_steps);
        for _ in 0..n_steps {
            let (time, outcome) = clock.time(|| self.step());
            outcome?;
            let report = self.pipeline.report();
            let counts = self.scene.phase != Phase::Landed || !report.contacts().is_empty();
            steps.push((counts, time, 1e6 * report.times().rapier));
            let is_detected = self.pipeline.report().is_detected();
            moves.push((is_detected, self.surface()));
        }
        let replayed = self.carrier.replay(&moves);
        let (mut whole, mut rapier) = (Vec::new(), Vec::new());
        for ((_, time, reported), replayed) in
            steps.iter().zip(&replayed).filter(|(step, _)| step.0)
        {
            whole.push(*time);
            rapier.push(if cfg!(feature = "timing") {
                *reported
            } else {
                *replayed
            });
        }
        Ok(median(&mut whole).map(|whole| Burst {
            whole,
            rapier: median(&mut rapier),
        }))
    }

    fn tip_deflection(&self) -> f64 {
        let body = &self.bodies[self.body];
        -body.displacement(self.scene.tip(body.mesh()))[1]
    }
}

fn builder(scene: &Scene, kind: CellKind) -> Outcome<FlexBodyBuilder> {
    let is_clamped = scene.is_clamped();
    let damping = if is_clamped { 0.0 } else { BLOCK_DAMPING };
    let material = LinearElastic::plane_stress(scene.young, POISSON)
        .density(DENSITY)
        .rayleigh(damping);
    let builder = FlexBodyBuilder::mesh(scene.mesh(kind)?).material(material);
    let builder = if scene.is_large() {
        builder
    } else {
        builder.small_strain()
    };
    let builder = builder
        .translation(scene.origin())
        // Asleep it would cost next to nothing; rapier's soft bodies are timed awake.
        .can_sleep(false);
    Ok(if is_clamped {
        builder.pin_where(|[x, _]| x == 0.0, Pin::both())
    } else {
        builder
    })
}

/// A world in which only the body's surface moves, as it was seen to: rapier's share of a step.
struct CarrierAlone {
    world: PhysicsWorld,
    surface: ColliderHandle,
}

impl CarrierAlone {
    fn new(scene: &Scene, kind: CellKind) -> Outcome<Self> {
        let mut world = scene.world();
        let mut bodies = FlexBodySet::new();
        let body = bodies.insert(builder(scene, kind)?, &mut world)?;
        let surface = bodies[body].collider_handle();
        Ok(Self { world, surface })
    }

    /// Takes rapier's step for every surface, after one without length where there was one, and returns the times (µs).
    fn replay(&mut self, moves: &[(bool, Vec<Vector>)]) -> Vec<f64> {
        let clock = Clock::plain();
        let mut times = Vec::with_capacity(moves.len());
        for (is_detected, vertices) in moves {
            let (time, ()) = clock.time(|| {
                let mut sets = RapierSets::of_world(&mut self.world, &(), &());
                if *is_detected {
                    sets.detect();
                }
                sets.step();
            });
            times.push(time);
            self.write(vertices);
        }
        times
    }

    fn write(&mut self, vertices: &[Vector]) {
        let world = &mut self.world;
        let Some(collider) = world.colliders.get_mut(self.surface) else {
            return;
        };
        if let Some(polyline) = collider.shape_mut().as_polyline_mut() {
            polyline.update_vertices(|own| own.copy_from_slice(vertices));
        }
        let aabb = collider.compute_aabb();
        world
            .broad_phase
            .set_aabb(&world.integration_parameters, self.surface, aabb);
    }
}
