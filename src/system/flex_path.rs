//! What a feasible path asks of a flexible block: where it begins, how far its frame has turned, and to stop on the way.

use super::flex_block::FlexBlock;
use super::large_block::{Large, NOT_FOUND};
use super::large_equation::{equation_of, factorize, factorize_definite, impulsive};
use crate::body::{Frame, FrameMotion};
use crate::fe::model::Model;
use crate::linalg::block_matrix::BlockMatrix;
use crate::math::{Vec2, node_vec, rotation, set_node_vec};
use crate::path::clearance;

/// Places of a way that are looked at, at equal distances.
const N_PLACES: u8 = 4;

/// Part of a way that is too short to be gone (-).
const LEAST_PART: f64 = 1e-3;

impl FlexBlock {
    /// `A` in the frame, pinned dofs taken out.
    pub fn effective(&self) -> &BlockMatrix {
        &self.effective
    }

    /// Least distance of the surface from itself at rest (m).
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Operations of one factorization of `A`, roughly.
    pub fn factor_operations(&self) -> f64 {
        let stored = self.factor.n_nonzeros() as f64;
        stored * stored / self.n_dofs() as f64
    }

    /// A direction at a node in the frame, without what pins hold.
    pub fn local_row(&self, node: usize, direction: Vec2) -> [f64; 2] {
        let local = self.turn.transpose() * direction;
        [0, 1].map(|axis| {
            if self.is_fixed[2 * node + axis] {
                0.0
            } else {
                local[axis]
            }
        })
    }

    /// All positions at the beginning of the step, interleaved (m).
    pub fn start_positions(&self) -> &[f64] {
        &self.start_position
    }

    /// The frame at the beginning of the step.
    pub fn start_frame(&self) -> &FrameMotion {
        &self.start_frame
    }

    /// Angle of the frame at the iterate (rad).
    pub fn angle(&self) -> f64 {
        self.frame.angle
    }

    /// Tells where the base of the path is (m); what is led goes on from there. Returns how far that is, relative to the body's size.
    ///
    /// - `leads`: whether the body is to be led from now on, if this is the last part of a step.
    pub fn set_base(&mut self, positions: &[f64], leads: bool) -> f64 {
        let Some(mut large) = self.large.take() else {
            return 0.0;
        };
        large.led.base.clear();
        large.led.base.extend_from_slice(positions);
        large.led.is_led |= leads && !large.may_give_up;
        let is_led = large.led.is_led;
        if is_led {
            large.led.takes_end = true;
            self.linearize_at_base(&mut large);
        }
        let left = large.led.left;
        self.large = Some(large);
        if is_led {
            self.follow_positions();
            return left;
        }
        0.0
    }

    /// Whether the iterate is what one Newton step from the base finds.
    pub fn is_led(&self) -> bool {
        self.large.as_ref().is_some_and(|large| large.led.is_led)
    }

    /// Share of the way from the base to the iterate that may be gone (-).
    pub fn part_ahead(&self) -> f64 {
        let led = self.large.as_ref().map(|large| &large.led);
        led.filter(|led| led.has_base())
            .map_or(1.0, |led| led.reach)
    }

    /// Puts what is led to the base, a place that was looked at.
    pub fn end_at_base(&mut self) {
        let Some(mut large) = self.large.take_if(|large| large.led.is_led) else {
            return;
        };
        self.position.copy_from_slice(&large.led.base);
        if self.kind == Frame::Free {
            self.balance_momentum(&large);
        }
        self.answer_as_at_the_end(&mut large);
        self.large = Some(large);
        self.follow_positions();
    }

    /// Answers impulses by what the body is at the iterate.
    pub(super) fn answer_as_at_the_end(&mut self, large: &mut Large) {
        let scale = self.step.weights.b0;
        let equation = equation_of(
            &large.model,
            &self.step,
            large.led.takes_end,
            [&large.load, &self.start_position, &large.coast],
            &self.is_fixed,
        );
        let (residual, reaction) = (&mut large.residual, &mut large.reaction);
        let outcome = equation.evaluate(&self.position, &mut large.deformation, residual, reaction);
        if outcome.is_err() {
            return;
        }
        self.n_factorizations += 1;
        self.compliance.clear();
        let matrices = (&mut large.tangent, &mut self.effective);
        let found = factorize_definite(
            (&equation, impulsive(&equation)),
            scale,
            &large.deformation,
            matrices,
            &mut self.factor,
        );
        if let Ok(found) = found {
            large.row_sum = found.row_sum;
        }
        self.ease_pins(large);
    }

    /// Puts the iterate where one Newton step from the base leads under the contact forces given.
    pub(super) fn linearize_at_base(&mut self, large: &mut Large) {
        let scale = self.step.weights.b0;
        self.position.copy_from_slice(&large.led.base);
        for &dof in &self.fixed_dofs {
            self.position[dof] = self.model.rest_positions()[dof] + self.prescribed[dof];
        }
        for (dof, load) in large.load.iter_mut().enumerate() {
            *load = self.force[dof] + self.contact_force[dof];
        }
        large.led.force.clear();
        large.led.force.extend_from_slice(&self.contact_force);
        large.led.left = f64::INFINITY;
        let equation = equation_of(
            &large.model,
            &self.step,
            large.led.takes_end,
            [&large.load, &self.start_position, &large.coast],
            &self.is_fixed,
        );
        let (residual, reaction) = (&mut large.residual, &mut large.reaction);
        let outcome = equation.evaluate(&self.position, &mut large.deformation, residual, reaction);
        if !outcome.is_ok_and(|now| now.norm.is_finite()) {
            return;
        }
        self.n_factorizations += 1;
        let matrices = (&mut large.tangent, &mut self.effective);
        let deformation = &large.deformation;
        let found = factorize(&equation, scale, deformation, matrices, &mut self.factor);
        self.compliance.clear();
        let Ok(found) = found else {
            return;
        };
        large.row_sum = found.row_sum;
        self.local.copy_from_slice(&large.residual);
        // Of cells that are all but flat the stiffness may leave nothing of the masses in the factor: their momentum is asked for by itself.
        let lacking = match self.kind {
            Frame::Free => self.lacking_shift(large).norm() / self.size,
            _ => 0.0,
        };
        large.led.left = lacking.max(self.go_by_local());
    }

    /// Moves what is led by what it answers to the change of the contact forces.
    pub(super) fn answer_at_base(&mut self, large: &mut Large) {
        let forces = self.contact_force.iter().zip(&mut large.led.force);
        for (local, (now, known)) in self.local.iter_mut().zip(forces) {
            *local = now - *known;
            *known = *now;
        }
        for &dof in &self.fixed_dofs {
            self.local[dof] = 0.0;
        }
        self.go_by_local();
    }

    /// Moves the iterate by what the forces in `local` do; returns how far a node goes, relative to the body's size.
    fn go_by_local(&mut self) -> f64 {
        let scale = self.step.weights.b0;
        self.factor.solve_in_place(&mut self.local);
        self.n_solves += 1;
        let mut moved = 0.0f64;
        for (x, increment) in self.position.iter_mut().zip(&self.local) {
            *x += scale * increment;
            moved = moved.max((scale * increment).abs());
        }
        moved / self.size
    }

    /// Finds how far towards the iterate no cell turns over and, of what is led, the forces that are out of balance do work; returns how far the
    /// body is from its end, relative to its size.
    pub(super) fn look_ahead(&mut self, large: &mut Large) -> f64 {
        for (dof, load) in large.load.iter_mut().enumerate() {
            *load = self.force[dof] + self.contact_force[dof];
        }
        let equation = equation_of(
            &large.model,
            &self.step,
            large.led.takes_end,
            [&large.load, &self.start_position, &large.coast],
            &self.is_fixed,
        );
        // Forces that rounding of the positions makes do work in no direction.
        let rounding = f64::EPSILON * large.row_sum * self.extent();
        let led = &mut large.led;
        let way = led.base.iter().zip(&self.position);
        let length: f64 = way.map(|(from, to)| (to - from).abs()).sum();
        let least = match led.is_led {
            true => -f64::from(2 * N_PLACES) * rounding * length,
            false => f64::NEG_INFINITY,
        };
        let (residual, reaction) = (&mut large.residual, &mut large.reaction);
        let deformation = &mut large.deformation;
        // The power of what is out of balance along the way; none where a cell is turned over.
        let mut power = |part: f64| {
            led.place.clear();
            let way = led.base.iter().zip(&self.position);
            led.place
                .extend(way.clone().map(|(from, to)| from + part * (to - from)));
            let outcome = equation.evaluate(&led.place, deformation, residual, reaction);
            let power = (way.zip(&*residual)).map(|((from, to), force)| force * (to - from));
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
    pub fn stop_at(&mut self, positions: &[f64]) {
        self.position.copy_from_slice(positions);
        if let Some(mut large) = self.large.take() {
            large.led.is_led = false;
            if large.led.takes_end {
                self.answer_as_at_the_end(&mut large);
            }
            self.large = Some(large);
            self.follow_centre();
            return;
        }
        if self.kind == Frame::Fixed {
            let pairs = self.position.iter().zip(self.model.rest_positions());
            for (u, (x, rest)) in self.displacement.iter_mut().zip(pairs) {
                *u = x - rest;
            }
            return;
        }
        let centre = self
            .arms
            .centre(self.kind, &self.position, self.frame.centre);
        let angle = self.arms.angle(&self.position, centre, self.frame.angle);
        (self.frame.centre, self.frame.angle) = (centre, angle);
        self.turn = rotation(angle);
        let back = self.turn.transpose();
        for node in 0..self.model.n_nodes() {
            let arm = back * (node_vec(&self.position, node) - centre);
            let reference = node_vec(&self.arms.reference, node);
            set_node_vec(&mut self.displacement, node, arm - reference);
        }
        self.inertia = self.inertia_of(&self.displacement);
    }
}

/// Least distance of a model's surface from itself at rest (m).
pub(super) fn clearance_of(model: &Model) -> f64 {
    let boundary = model.mesh().boundary();
    let nodes = boundary.nodes().iter();
    let points: Vec<Vec2> = nodes
        .map(|&node| node_vec(model.rest_positions(), node))
        .collect();
    // Segment k starts at boundary node k.
    let edges: Vec<[u32; 2]> = (0..boundary.segments().len())
        .map(|segment| [segment as u32, boundary.next_segment(segment) as u32])
        .collect();
    clearance(&points, &edges)
}
