//! Who steps a scene, and what was seen of it.

use crate::clock::median;
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// What may go wrong goes to `main`.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// What a step tells of itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Told {
    pub n_factorizations: u64,
    pub n_pivots: usize,
    pub n_newton: usize,
    pub quality: Quality,
}

/// Something that steps a scene.
pub trait Side {
    /// Who it is.
    fn label(&self) -> String;
    /// Takes a step.
    fn step(&mut self) -> Outcome<Told>;
}

/// This crate.
pub struct Flexible {
    label: &'static str,
    world: PhysicsWorld,
    bodies: FlexBodySet,
    flex: FlexPipeline,
}

impl Flexible {
    pub fn new(label: &'static str, world: PhysicsWorld, bodies: FlexBodySet) -> Self {
        Self {
            label,
            world,
            bodies,
            flex: FlexPipeline::new(),
        }
    }
}

impl Side for Flexible {
    fn label(&self) -> String {
        self.label.to_owned()
    }

    fn step(&mut self) -> Outcome<Told> {
        let report = self.flex.step(&mut self.world, &mut self.bodies)?;
        Ok(Told {
            n_factorizations: report.n_factorizations(),
            n_pivots: report.n_pivots(),
            n_newton: report.n_newton(),
            quality: report.quality(),
        })
    }
}

/// Rapier alone, with or without its own soft bodies.
pub struct Rapier {
    label: &'static str,
    world: PhysicsWorld,
}

impl Rapier {
    pub fn new(label: &'static str, world: PhysicsWorld) -> Self {
        Self { label, world }
    }
}

impl Side for Rapier {
    fn label(&self) -> String {
        self.label.to_owned()
    }

    fn step(&mut self) -> Outcome<Told> {
        self.world.step();
        Ok(Told::default())
    }
}

/// What was seen of one side.
#[derive(Debug)]
pub struct Seen {
    pub label: String,
    /// Times of its steps (µs).
    times: Vec<f64>,
    spent: f64,
    told: Vec<Told>,
}

impl Seen {
    /// Steps of the last second.
    const LAST: usize = 60;

    pub fn of(label: String) -> Self {
        Self {
            label,
            times: Vec::new(),
            spent: 0.0,
            told: Vec::new(),
        }
    }

    pub fn take(&mut self, time: f64, told: Told) {
        self.times.push(time);
        self.spent += time;
        self.told.push(told);
    }

    /// Time of all steps (µs).
    pub fn spent(&self) -> f64 {
        self.spent
    }

    pub fn n_steps(&self) -> usize {
        self.times.len()
    }

    /// Middle and longest time of a step, and middle time of the last second's if all `n_steps` were taken (µs).
    pub fn times(&self, n_steps: usize) -> [Option<f64>; 3] {
        let last = self.times.len().saturating_sub(Self::LAST);
        let middle = |times: &[f64]| median(&mut times.to_vec());
        let worst = self.times.iter().copied().reduce(f64::max);
        let at_rest = middle(&self.times[last..]).filter(|_| self.n_steps() == n_steps);
        [middle(&self.times), worst, at_rest]
    }

    /// A count of every step: mean, most, and mean of the last second.
    pub fn count(&self, of: impl Fn(&Told) -> u64) -> [f64; 3] {
        let last = self.told.len().saturating_sub(Self::LAST);
        let mean = |told: &[Told]| {
            let sum: u64 = told.iter().map(&of).sum();
            sum as f64 / told.len().max(1) as f64
        };
        let most = self.told.iter().map(&of).max();
        let most = most.unwrap_or(0) as f64;
        [mean(&self.told), most, mean(&self.told[last..])]
    }

    /// Steps that were cut, and steps that were not finished.
    pub fn n_unsolved(&self) -> [usize; 2] {
        [Quality::Cut, Quality::Unfinished].map(|quality| {
            let of_quality = self.told.iter().filter(|told| told.quality == quality);
            of_quality.count()
        })
    }
}
