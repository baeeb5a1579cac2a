//! An onlooker: judges every step of a scene by where things are and how they move, not by what the step says of itself.

use super::*;
use foil2d::body::AttachmentTarget;
use std::collections::HashMap;

/// The deepest that something was in something else.
#[derive(Clone, Debug, Default)]
pub struct Overlap {
    /// Depth (m).
    pub depth: f64,
    /// Depth by the thickness of the thinner flexible body of the two (-).
    pub share: f64,
    pub step: usize,
    pub what: String,
}

/// What a step took, told in numbers that are the same on every machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    pub n_factorizations: u64,
    pub n_pivots: usize,
}

/// What was seen.
pub struct Onlooker {
    thickness: HashMap<FlexBodyHandle, f64>,
    n_steps: usize,
    stopped: Option<[usize; 2]>,
    error: Option<String>,
    unsolved: Vec<usize>,
    overlap: Overlap,
    /// What the report of the step with the deepest overlap says (m).
    pub told: f64,
    /// Energy of the scene before the first step and after every one (J).
    pub energy: Vec<f64>,
    /// Work of every step.
    pub work: Vec<Work>,
}

/// A flexible body as it stands.
struct Flexible {
    handle: FlexBodyHandle,
    outline: Outline,
    thickness: f64,
    groups: InteractionGroups,
}

/// A rigid collider as it stands.
struct Rigid {
    figure: Figure,
    groups: InteractionGroups,
    parent: Option<RigidBodyHandle>,
}

impl Default for Onlooker {
    fn default() -> Self {
        Self {
            thickness: HashMap::new(),
            n_steps: 0,
            stopped: None,
            error: None,
            unsolved: Vec::new(),
            overlap: Overlap::default(),
            told: 0.0,
            energy: Vec::new(),
            work: Vec::new(),
        }
    }
}

impl Onlooker {
    /// Deepest overlap of a body by its thickness (-): far above the rounding of rapier's poses, far below what can be seen.
    pub const DEEPEST: f64 = 0.01;

    /// How much deeper a rigid body may be in the ground (-): rapier alone, which moves those that touch nothing flexible, lets corners of
    /// boxes that fall on polylines and height fields dip by 6 to 9 % of their thickness for a step.
    const RIGID: f64 = 10.0;

    /// Factorizations after which a scene is stopped, and told of: a hundred times what the hardest of these scenes needs.
    const PATIENCE: u64 = 1_000_000;

    /// Takes up to `n` steps and looks after each; `each` sees the scene then.
    pub fn watch(&mut self, scene: &mut Scene, n: usize, mut each: impl FnMut(&Scene)) {
        for step in 0..n {
            if self.error.is_some() || self.stopped.is_some() {
                return;
            }
            let spent: u64 = self.work.iter().map(|work| work.n_factorizations).sum();
            if spent > Self::PATIENCE {
                self.stopped = Some([step, n]);
                return;
            }
            self.step(scene);
            each(scene);
        }
    }

    /// Takes a step and looks.
    pub fn step(&mut self, scene: &mut Scene) {
        if self.energy.is_empty() {
            self.energy.push(energy_of(scene));
        }
        match scene.try_step() {
            Ok(report) => {
                self.work.push(Work {
                    n_factorizations: report.n_factorizations(),
                    n_pivots: report.n_pivots(),
                });
                if !is_solved(report) {
                    self.unsolved.push(self.n_steps);
                }
            }
            Err(error) => {
                self.error = Some(format!("step {}: {error}", self.n_steps));
                return;
            }
        }
        if sick_flexible(&scene.bodies).is_some() || sick_rigid(&scene.world).is_some() {
            self.error = Some(format!("step {}: not finite", self.n_steps));
            return;
        }
        let overlap = self.overlap_in(scene);
        if overlap.share > self.overlap.share {
            self.told = scene.report().gap_violation();
            self.overlap = overlap;
        }
        self.energy.push(energy_of(scene));
        self.n_steps += 1;
    }

    /// The deepest overlap of the scene as it stands.
    fn overlap_in(&mut self, scene: &Scene) -> Overlap {
        let mut worst = Overlap::default();
        let n_steps = self.n_steps;
        let mut note = |depth: f64, thickness: f64, what: &dyn Fn() -> String| {
            if depth / thickness > worst.share {
                worst = Overlap {
                    depth,
                    share: depth / thickness,
                    step: n_steps,
                    what: what(),
                };
            }
        };
        let flexible: Vec<_> = scene
            .bodies
            .iter()
            .map(|(handle, body)| {
                let thickness = *self
                    .thickness
                    .entry(handle)
                    .or_insert_with(|| thickness_of(body));
                let groups = scene.world.colliders[body.collider_handle()].collision_groups();
                Flexible {
                    handle,
                    outline: Outline::of(body),
                    thickness,
                    groups,
                }
            })
            .collect();
        let surfaces: Vec<_> = scene
            .bodies
            .iter()
            .map(|(_, body)| body.collider_handle())
            .collect();
        let rigid: Vec<_> = scene
            .world
            .colliders
            .iter()
            .filter(|(handle, _)| !surfaces.contains(handle))
            .map(|(_, collider)| Rigid {
                figure: Figure::of(collider),
                groups: collider.collision_groups(),
                parent: collider.parent(),
            })
            .collect();
        // What is attached without contacts may overlap.
        let ties: Vec<_> = scene
            .bodies
            .iter_attachments()
            .filter(|(_, tie)| !tie.contacts_enabled())
            .map(|(_, tie)| (tie.body(), tie.target()))
            .collect();
        let is_tied = |body, target| ties.contains(&(body, target));
        for (i, own) in flexible.iter().enumerate() {
            for (j, other) in rigid.iter().enumerate() {
                let target = other.parent.map(AttachmentTarget::RigidBody);
                let is_tied = target.is_some_and(|target| is_tied(own.handle, target));
                if own.groups.test(other.groups) && !is_tied {
                    let depth = other.figure.depth_of_outline(&own.outline);
                    note(depth, own.thickness, &|| {
                        format!("flexible {i}, rigid collider {j}")
                    });
                }
            }
            for (j, other) in flexible.iter().enumerate().skip(i + 1) {
                let [to, back] = [other, own].map(|body| AttachmentTarget::Flexible(body.handle));
                let is_tied = is_tied(own.handle, to) || is_tied(other.handle, back);
                if own.groups.test(other.groups) && !is_tied {
                    let depth = own.outline.depth_in(&other.outline);
                    note(depth, own.thickness.min(other.thickness), &|| {
                        format!("flexible {i}, flexible {j}")
                    });
                }
            }
        }
        for (i, ground) in rigid.iter().enumerate() {
            if matches!(ground.figure, Figure::Convex { .. }) {
                continue;
            }
            for (j, other) in rigid.iter().enumerate() {
                if ground.groups.test(other.groups) {
                    let depth = ground.figure.depth_of_figure(&other.figure);
                    note(depth, Self::RIGID * other.figure.thickness(), &|| {
                        format!("rigid collider {j} under ground {i}")
                    });
                }
            }
        }
        worst
    }

    pub fn n_unsolved(&self) -> usize {
        self.unsolved.len()
    }

    pub fn overlap(&self) -> &Overlap {
        &self.overlap
    }

    /// Largest rise of the energy above the least it had been (J).
    pub fn rise(&self) -> f64 {
        let mut least = f64::MAX;
        let rises = self.energy.iter().map(|&energy| {
            least = least.min(energy);
            energy - least
        });
        rises.fold(0.0, f64::max)
    }

    /// The most of the steps from `first` on, each number for itself.
    pub fn most_from(&self, first: usize) -> Work {
        let mut most = Work::default();
        for work in self.work.iter().skip(first) {
            most.n_factorizations = most.n_factorizations.max(work.n_factorizations);
            most.n_pivots = most.n_pivots.max(work.n_pivots);
        }
        most
    }

    /// Mean pivots of the steps from `first` on.
    pub fn mean_pivots_from(&self, first: usize) -> f64 {
        let steps = self.work.get(first..).unwrap_or_default();
        let sum: usize = steps.iter().map(|work| work.n_pivots).sum();
        sum as f64 / steps.len() as f64
    }

    /// What holds of every scene: all steps were taken and solved, and nothing was in anything.
    pub fn check(&self, findings: &mut Findings, scene: &str) {
        findings.check(self.error.is_none(), || {
            format!("{scene}: {}", self.error.as_deref().unwrap_or_default())
        });
        findings.check(self.stopped.is_none(), || {
            let [step, n] = self.stopped.unwrap_or_default();
            format!("{scene}: stopped at step {step} of {n}")
        });
        findings.check(self.unsolved.is_empty(), || {
            let (n, first) = (self.unsolved.len(), self.unsolved[0]);
            format!(
                "{scene}: {n} of {} steps not solved, the first {first}",
                self.n_steps
            )
        });
        let overlap = &self.overlap;
        findings.check(overlap.share < Self::DEEPEST, || {
            format!(
                "{scene}: {} {:.2e} m deep, {:.1} % of a thickness, at step {}; told: {:.1e} m",
                overlap.what,
                overlap.depth,
                1e2 * overlap.share,
                overlap.step,
                self.told
            )
        });
    }

    /// That nothing brought energy: it never rises by more than this share of `scale` (J).
    pub fn check_energy(&self, findings: &mut Findings, scene: &str, scale: f64) {
        /// What rounding of rapier's poses and the integrator's swing within a step may show (-).
        const SHARE: f64 = 0.01;
        let rise = self.rise();
        findings.check(rise < SHARE * scale, || {
            format!("{scene}: {rise:.3e} J gained, {scale:.3e} J were brought")
        });
    }
}

/// Twice the area by the length of the outline (m): the thickness of a strip or a ring, half the side of a square.
pub fn thickness_of(body: &FlexBody) -> f64 {
    let nodes = body.mesh().nodes();
    let segments = body.mesh().boundary().segments().iter();
    let lengths = segments.map(|&[a, b]| {
        let [from, to] = [nodes[a], nodes[b]];
        (to[0] - from[0]).hypot(to[1] - from[1])
    });
    2.0 * body.mesh().area() / lengths.sum::<f64>()
}

/// Moving bodies that are not the carriers of flexible ones.
pub fn free_bodies(scene: &Scene) -> Vec<RigidBodyHandle> {
    let carriers: Vec<_> = scene
        .bodies
        .iter()
        .map(|(_, body)| body.rigid_body_handle())
        .collect();
    let all = scene.world.bodies.iter();
    let free =
        all.filter(|(handle, body)| body.body_type().is_dynamic() && !carriers.contains(handle));
    free.map(|(handle, _)| handle).collect()
}

/// Kinetic energy of a rigid body (J).
pub fn kinetic_of(body: &RigidBody) -> f64 {
    let ([x, y], spin) = (velocity_of(body), f64::from(body.angvel()));
    let mass = f64::from(body.mass());
    0.5 * mass * (x * x + y * y) + 0.5 * inertia_of(body) * spin * spin
}

/// Inertia of a rigid body about its centre (kg m²), zero of one that cannot turn.
pub fn inertia_of(body: &RigidBody) -> f64 {
    let inverse = f64::from(body.mass_properties().effective_world_inv_inertia);
    if inverse > 0.0 { 1.0 / inverse } else { 0.0 }
}

/// Kinetic, elastic and potential energy of all bodies (J), asleep or not.
pub fn energy_of(scene: &Scene) -> f64 {
    let gravity = [scene.world.gravity.x, scene.world.gravity.y].map(f64::from);
    let potential = |mass: f64, at: Point| -mass * (gravity[0] * at[0] + gravity[1] * at[1]);
    let flexible = scene.bodies.iter().map(|(_, body)| {
        let own = body.energy();
        own.kinetic + own.elastic + potential(body.mass(), body.centre_of_mass())
    });
    let rigid = free_bodies(scene).into_iter().map(|handle| {
        let body = &scene.world.bodies[handle];
        let centre = body.center_of_mass();
        let centre = [centre.x, centre.y].map(f64::from);
        kinetic_of(body) + potential(f64::from(body.mass()), centre)
    });
    flexible.chain(rigid).sum()
}

/// Momentum of all bodies (N s).
pub fn momentum_of(scene: &Scene) -> [f64; 2] {
    let flexible = scene.bodies.iter().map(|(_, body)| body.momentum());
    let rigid = free_bodies(scene).into_iter().map(|handle| {
        let body = &scene.world.bodies[handle];
        velocity_of(body).map(|part| part * f64::from(body.mass()))
    });
    let all = flexible.chain(rigid);
    all.fold([0.0; 2], |[x, y], part| [x + part[0], y + part[1]])
}
