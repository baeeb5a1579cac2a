//! What a feasible path asks of a body of large strain: where it begins, how far it may be gone, and to stop on the way.

use super::trial::impulsive;
use super::{LargeStrain, NOT_FOUND};
use crate::body::Frame;
use crate::fe::finite_strain::Linearization;
use crate::math::judged::{Judged, NEGLIGIBLE};
use crate::system::flex::shared::Shared;

/// Places of a way that are looked at, at equal distances.
const N_PLACES: u8 = 4;

/// Part of a way that is too short to be gone (-).
const LEAST_PART: Judged = NEGLIGIBLE;

impl LargeStrain {
    /// Tells where the base of the path is (m); what is led goes on from there. Returns how far that is, relative to the body's size.
    ///
    /// - `leads`: whether the body is to be led from now on, if this is the last part of a step.
    pub fn set_base(&mut self, shared: &mut Shared, positions: &[f64], leads: bool) -> f64 {
        self.led.base.clear();
        self.led.base.extend_from_slice(positions);
        self.led.is_led |= leads && !self.may_give_up;
        if !self.led.is_led {
            return 0.0;
        }
        self.problem.takes_end = true;
        self.linearize_at_base(shared);
        self.follow_positions(shared);
        self.led.left
    }

    /// Whether the iterate is what one Newton step from the base finds.
    pub fn is_led(&self) -> bool {
        self.led.is_led
    }

    /// Share of the way from the base to the iterate that may be gone (-).
    pub fn part_ahead(&self) -> f64 {
        if self.led.has_base() {
            self.led.reach
        } else {
            1.0
        }
    }

    /// Puts what is led to the base, a place that was looked at.
    pub fn end_at_base(&mut self, shared: &mut Shared) {
        if !self.led.is_led {
            return;
        }
        shared.now.position.copy_from_slice(&self.led.base);
        if shared.shape.kind == Frame::Free {
            self.balance_momentum(shared);
        }
        self.answer_as_at_the_end(shared);
        self.follow_positions(shared);
    }

    /// Answers impulses by what the body is at the iterate.
    pub fn answer_as_at_the_end(&mut self, shared: &mut Shared) {
        let scale = shared.step.weights.b0;
        let equation = (self.problem).equation(&shared.step, &shared.start, &shared.shape);
        let outcome = self.trial.evaluate(&equation, &shared.now.position);
        if outcome.is_err() {
            return;
        }
        // Where there is no such factor the one at hand has to do.
        let asked = (&equation, impulsive(&equation));
        let _ = self.trial.factorize(asked, scale, &mut shared.answer);
        self.ease_pins(shared);
    }

    /// Puts the iterate where one Newton step from the base leads under the contact forces given.
    pub fn linearize_at_base(&mut self, shared: &mut Shared) {
        let scale = shared.step.weights.b0;
        shared.now.position.copy_from_slice(&self.led.base);
        shared.place_pins();
        self.problem.take_loads(shared);
        self.led.force.clear();
        self.led.force.extend_from_slice(&shared.contact.nodal);
        self.led.left = f64::INFINITY;
        let equation = (self.problem).equation(&shared.step, &shared.start, &shared.shape);
        let outcome = self.trial.evaluate(&equation, &shared.now.position);
        if !outcome.is_ok_and(|now| now.norm.is_finite()) {
            return;
        }
        let asked = (&equation, Linearization::Consistent);
        let found = self.trial.factorize(asked, scale, &mut shared.answer);
        if found.is_err() {
            return;
        }
        shared.local.copy_from_slice(&self.trial.residual);
        // Of cells that are all but flat the stiffness may leave nothing of the masses in the factor: their momentum is asked for by itself.
        let lacking = match shared.shape.kind {
            Frame::Free => self.lacking_shift(shared).norm() / shared.shape.size,
            _ => 0.0,
        };
        self.led.left = lacking.max(go_by_local(shared));
    }

    /// Moves what is led by what it answers to the change of the contact forces.
    pub fn answer_at_base(&mut self, shared: &mut Shared) {
        let forces = shared.contact.nodal.iter().zip(&mut self.led.force);
        for (local, (now, known)) in shared.local.iter_mut().zip(forces) {
            *local = now - *known;
            *known = *now;
        }
        shared.shape.clear_fixed(&mut shared.local);
        go_by_local(shared);
    }

    /// Finds how far towards the iterate no cell turns over and, of what is led, the forces that are out of balance do work; returns how far the
    /// body is from its end, relative to its size.
    pub fn look_ahead(&mut self, shared: &Shared) -> f64 {
        self.problem.take_loads(shared);
        let equation = (self.problem).equation(&shared.step, &shared.start, &shared.shape);
        // Forces that rounding of the positions makes do work in no direction.
        let rounding = f64::EPSILON * self.trial.row_sum * shared.extent();
        let (led, trial) = (&mut self.led, &mut self.trial);
        let way = led.base.iter().zip(&shared.now.position);
        let length: f64 = way.map(|(from, to)| (to - from).abs()).sum();
        let least = match led.is_led {
            true => -f64::from(2 * N_PLACES) * rounding * length,
            false => f64::NEG_INFINITY,
        };
        // The power of what is out of balance along the way; none where a cell is turned over.
        let mut power = |part: f64| {
            led.place.clear();
            let way = led.base.iter().zip(&shared.now.position);
            led.place
                .extend(way.clone().map(|(from, to)| from + part * (to - from)));
            let outcome = trial.evaluate(&equation, &led.place);
            let power = (way.zip(&trial.residual)).map(|((from, to), force)| force * (to - from));
            outcome
                .is_ok_and(|now| now.norm.is_finite())
                .then(|| power.sum::<f64>())
        };
        // Surfaces may stop the path anywhere before, and areas are no straight function of the way.
        let mut reach = 1.0;
        let start = power(0.0);
        while reach > LEAST_PART {
            let mut last = start;
            let mut work = Some(0.0);
            for place in 1..=N_PLACES {
                let now = power(reach * f64::from(place) / f64::from(N_PLACES));
                work = (work.zip(last).zip(now)).map(|((work, last), now)| work + last + now);
                last = now;
            }
            if work.is_some_and(|work| work >= least) {
                break;
            }
            reach *= 0.5;
        }
        // What was not looked at is not gone.
        led.reach = if reach > LEAST_PART { reach } else { 0.0 };
        led.left
            .max(NOT_FOUND * f64::from(u8::from(led.reach < 1.0)))
    }

    /// Puts the nodes where the step could go (m), with the velocities and accelerations that its forces lead to.
    pub fn stop_at(&mut self, shared: &mut Shared, positions: &[f64]) {
        shared.now.position.copy_from_slice(positions);
        self.led.is_led = false;
        if self.problem.takes_end {
            self.answer_as_at_the_end(shared);
        }
        shared.now.follow_centre(&shared.shape, &shared.start.frame);
    }
}

/// Moves the iterate by what the forces in `local` do; returns how far a node goes, relative to the body's size.
fn go_by_local(shared: &mut Shared) -> f64 {
    let scale = shared.step.weights.b0;
    shared.answer.solve(&mut shared.local);
    let mut moved = 0.0f64;
    for (x, increment) in shared.now.position.iter_mut().zip(&shared.local) {
        *x += scale * increment;
        moved = moved.max((scale * increment).abs());
    }
    moved / shared.shape.size
}
