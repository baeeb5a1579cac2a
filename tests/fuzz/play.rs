//! A world, what the test knows to be in it, and the choice of the next operation.

use crate::chance::Chance;
use crate::common::*;
use crate::hooks::{Hooks, Listener, Mood};
use foil2d::body::AttachmentTarget;
use foil2d::pipeline::StepError;
use std::error::Error;

pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// An impulse joint and its ends.
#[derive(Clone, Copy)]
pub struct Link {
    pub handle: ImpulseJointHandle,
    pub ends: [RigidBodyHandle; 2],
}

/// An attachment and its ends.
pub struct Tie {
    pub handle: AttachmentHandle,
    pub body: FlexBodyHandle,
    pub target: AttachmentTarget,
}

/// A collider that is no surface of ours, and the body it lies on.
#[derive(Clone, Copy)]
pub struct Part {
    pub handle: ColliderHandle,
    pub parent: Option<RigidBodyHandle>,
}

pub struct Play {
    pub seed: u64,
    pub chance: Chance,
    pub scene: Scene,
    pub hooks: Hooks,
    pub listener: Listener,
    pub flexible: Vec<FlexBodyHandle>,
    pub rigid: Vec<RigidBodyHandle>,
    /// Carriers whose bodies were forgotten.
    pub empty_carriers: Vec<RigidBodyHandle>,
    pub parts: Vec<Part>,
    pub links: Vec<Link>,
    pub ties: Vec<Tie>,
    /// Bodies given what cannot be stepped, and not mended since.
    pub spoiled: Vec<FlexBodyHandle>,
    /// What was removed, by which nothing may be found again.
    pub gone: Vec<FlexBodyHandle>,
    /// What is being done.
    pub context: String,
    pub n_steps: usize,
    pub n_unfinished: usize,
    pub n_steps_untied: usize,
    pub n_unfinished_untied: usize,
    pub n_cut: usize,
    pub n_refused: usize,
    pub n_quarantined: usize,
    pub n_lost: usize,
    pub fastest: f64,
}

impl Play {
    /// A floor and two walls.
    pub fn new(seed: u64) -> Self {
        let mut scene = Scene::new(1.0 / 60.0);
        let mut parts = Vec::new();
        let mut add = |handle| {
            parts.push(Part {
                handle,
                parent: None,
            });
        };
        add(scene.ground(0.5));
        for x in [-4.0, 4.0] {
            let wall = ColliderBuilder::cuboid(0.5, 5.0).translation(vec2(x, 4.0));
            add(scene.fixed(wall));
        }
        Self {
            seed,
            chance: Chance::new(seed),
            scene,
            hooks: Hooks::default(),
            listener: Listener::default(),
            flexible: Vec::new(),
            rigid: Vec::new(),
            empty_carriers: Vec::new(),
            parts,
            links: Vec::new(),
            ties: Vec::new(),
            spoiled: Vec::new(),
            gone: Vec::new(),
            context: String::new(),
            n_steps: 0,
            n_unfinished: 0,
            n_steps_untied: 0,
            n_unfinished_untied: 0,
            n_cut: 0,
            n_refused: 0,
            n_quarantined: 0,
            n_lost: 0,
            fastest: 0.0,
        }
    }

    pub fn summary(&self) -> String {
        format!(
            "seed {:#x}: {} steps, {} unfinished ({} of {} steps without attachments), {} cut, {} refused as they must be, {} quarantined, {} lost, {:?} events, fastest {:.0} m/s",
            self.seed,
            self.n_steps,
            self.n_unfinished,
            self.n_unfinished_untied,
            self.n_steps_untied,
            self.n_cut,
            self.n_refused,
            self.n_quarantined,
            self.n_lost,
            self.listener.n_events,
            self.fastest
        )
    }

    /// One operation.
    pub fn operate(&mut self) -> Outcome<()> {
        let kind = self.chance.below(20);
        let name = match kind {
            0 | 1 => self.insert_flexible()?,
            2 => self.remove_flexible()?,
            3..=5 => self.change_flexible()?,
            6 => self.spoil_or_mend()?,
            7 | 8 => self.insert_rigid(),
            9 => self.remove_rigid(),
            10..=12 => self.change_rigid(),
            13 => self.move_rigid(),
            14 => self.change_colliders(),
            15 | 16 => self.change_links(),
            17 | 18 => self.change_ties()?,
            _ => self.change_world(),
        };
        self.context = format!("seed {:#x}, step {} ({name})", self.seed, self.n_steps);
        if std::env::var_os("FUZZ_TRACE").is_some() {
            println!("{}", self.context);
        }
        Ok(())
    }

    fn change_world(&mut self) -> &'static str {
        let world = &mut self.scene.world;
        let chance = &mut self.chance;
        match chance.below(4) {
            0 => {
                let lengths = [0.0, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 60.0, 1.0 / 30.0];
                world.integration_parameters.dt = real(lengths[chance.below(5)]);
                "step length"
            }
            1 => {
                let down = if chance.one_in(4) { 0.0 } else { -9.81 };
                world.gravity = vec2(chance.within(-5.0, 5.0), down);
                "gravity"
            }
            2 => {
                let moods = [
                    Mood::Calm,
                    Mood::Filters,
                    Mood::Loosens,
                    Mood::Alters,
                    Mood::Clears,
                ];
                self.hooks.0 = moods[chance.below(5)];
                "hooks"
            }
            _ => {
                world.gravity = vec2(0.0, -9.81);
                world.integration_parameters.dt = real(1.0 / 60.0);
                for _ in 0..10 {
                    self.context = format!("seed {:#x}, step {} (rest)", self.seed, self.n_steps);
                    self.step();
                }
                "rest"
            }
        }
    }

    /// The next step, without checks.
    pub fn try_step(&mut self) -> Result<(), StepError> {
        let scene = &mut self.scene;
        let (world, bodies) = (&mut scene.world, &mut scene.bodies);
        let stepped = scene
            .flex
            .step_with_events(world, bodies, &self.hooks, &self.listener);
        stepped.map(|_| ())
    }

    /// A step that must be taken, and leave all in order.
    #[track_caller]
    pub fn step(&mut self) {
        let stepped = self.try_step();
        assert_eq!(stepped, Ok(()), "{}", self.context);
        self.n_steps += 1;
        let report = self.scene.report();
        if self.ties.is_empty() {
            self.n_steps_untied += 1;
            self.n_unfinished_untied += report.n_unfinished();
        }
        self.n_unfinished += report.n_unfinished();
        self.n_cut += report.n_cut();
        self.n_quarantined += report.quarantined_flex_bodies().len();
        self.forget_orphans();
        self.assert_counted();
        self.assert_finite();
        self.assert_reported();
        self.remove_runaways();
    }

    /// Removes rigid bodies that have left, or that rapier's own joints have flung: what drives apart without end is no scene. How
    /// fast flexible bodies may become is checked.
    fn remove_runaways(&mut self) {
        let world = &mut self.scene.world;
        let mut n_removed = 0;
        self.rigid.retain(|&handle| {
            let body = &world.bodies[handle];
            let is_lost = body.translation().length() > 60.0 || body.linvel().length() > 300.0;
            if is_lost && body.translation().is_finite() && body.linvel().is_finite() {
                world.remove_body(handle);
                n_removed += 1;
                return false;
            }
            true
        });
        self.n_lost += n_removed;
        if n_removed > 0 {
            // Attachments notice it at the next step.
            self.forget_orphans();
        }
    }

    /// A step of which one error is what is documented; nothing moves then.
    #[track_caller]
    pub fn step_refused(&mut self, expected: StepError) {
        let before = self.bits();
        let stepped = self.try_step();
        assert_eq!(stepped, Err(expected), "{}", self.context);
        assert_eq!(before, self.bits(), "{}: it is refused", self.context);
        self.n_refused += 1;
    }

    /// Removes from the test's lists what was held by bodies that are gone.
    pub fn forget_orphans(&mut self) {
        let (flexible, rigid, carriers) = (&self.flexible, &self.rigid, &self.empty_carriers);
        let lives = |body: &RigidBodyHandle| rigid.contains(body) || carriers.contains(body);
        self.ties.retain(|tie| {
            flexible.contains(&tie.body)
                && match tie.target {
                    AttachmentTarget::World => true,
                    AttachmentTarget::RigidBody(body) => lives(&body),
                    AttachmentTarget::Flexible(body) => flexible.contains(&body),
                }
        });
        self.links.retain(|link| link.ends.iter().all(lives));
        self.parts
            .retain(|part| part.parent.as_ref().is_none_or(lives));
        self.spoiled.retain(|body| flexible.contains(body));
    }

    /// Everything but the floor and the walls.
    pub fn remove_all(&mut self) -> Outcome<()> {
        self.context = format!("seed {:#x}, after the last removal", self.seed);
        for handle in std::mem::take(&mut self.flexible) {
            self.scene.bodies.remove(handle, &mut self.scene.world)?;
        }
        let rigid = std::mem::take(&mut self.rigid);
        for handle in rigid
            .into_iter()
            .chain(std::mem::take(&mut self.empty_carriers))
        {
            self.scene.world.remove_body(handle);
        }
        for part in self.parts.drain(3..) {
            self.scene.world.remove_collider(part.handle);
        }
        self.hooks = Hooks::default();
        self.forget_orphans();
        self.assert_counted();
        self.step();
        assert_eq!(self.scene.bodies.len(), 0);
        assert_eq!(self.scene.world.bodies.len(), 0);
        assert_eq!(self.scene.world.colliders.len(), 3);
        let n_pairs = self.scene.world.contact_pairs().count();
        assert_eq!(n_pairs, 0, "{}", self.context);
        Ok(())
    }
}
