//! What a rigid body weighs with the flexible bodies that are attached to it.
//!
//! Whether a step resolves a spring depends on the mass that swings on it: a light hub swings with what is welded to it.

use crate::constraint::joint::{JointGrip, JointLaw, JointRow, unit_wrench};
use crate::math::{Vec2, perp};
use crate::system::{Block, Moments};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// A flexible body that is held to a rigid one.
#[derive(Clone, Copy, Debug)]
struct Load {
    hub: usize,
    body: usize,
    /// A place where it is held (m).
    at: Vec2,
    /// Whether it is held at another place too, so that it turns with the hub.
    is_welded: bool,
}

/// The loads of an island.
#[derive(Debug, Default)]
pub(super) struct Laden {
    loads: Vec<Load>,
}

impl Laden {
    /// Finds what is held to rigid bodies that springs hold.
    pub fn find(&mut self, rows: &[JointRow], grips: &[JointGrip], blocks: &[Block]) {
        self.loads.clear();
        if !rows.iter().any(is_spring) {
            return;
        }
        for row in rows.iter().filter(|row| holds(row)) {
            let grips = &grips[row.grips.0..row.grips.1];
            let mut hubs = grips.iter().filter(|grip| is_free_hub(blocks, grip));
            let hub = hubs.next();
            for grip in grips {
                if let (Some(hub), Block::Flex(body)) = (hub, &blocks[grip.block])
                    && !body.is_pinned()
                {
                    let at = blocks[hub.block].start_position(hub.point);
                    self.add(hub.block, grip.block, at);
                }
            }
        }
    }

    fn add(&mut self, hub: usize, body: usize, at: Vec2) {
        let known = |load: &&mut Load| load.hub == hub && load.body == body;
        match self.loads.iter_mut().find(known) {
            Some(load) => load.is_welded |= load.at != at,
            None => self.loads.push(Load {
                hub,
                body,
                at,
                is_welded: false,
            }),
        }
    }

    /// `G M⁻¹ Gᵀ` of a row between rigid blocks with what is held to them (1/kg), `None` if that is nothing.
    pub fn row_mobility(
        &self,
        blocks: &[Block],
        (grips, direction, is_turn): (&[JointGrip], Vec2, bool),
    ) -> Option<f64> {
        if !grips.iter().any(|grip| self.carries(grip.block)) {
            return None;
        }
        let mut sum = 0.0;
        for grip in grips {
            let wrench = unit_wrench(grip, direction, is_turn);
            sum += match &blocks[grip.block] {
                Block::Rigid(_) if self.carries(grip.block) => {
                    self.mobility(grip.block, wrench, blocks)?
                }
                Block::Rigid(block) => block.mobility_between(wrench, wrench),
                Block::Flex(_) => return None,
            };
        }
        Some(sum)
    }

    /// Whether a block carries anything.
    fn carries(&self, block: usize) -> bool {
        self.loads.iter().any(|load| load.hub == block)
    }

    /// How a unit wrench on a hub moves along itself (1/kg), with all that is held to it as if that were rigid; `None` of what weighs nothing.
    fn mobility(&self, hub: usize, wrench: [f64; 3], blocks: &[Block]) -> Option<f64> {
        let own = blocks[hub].start_moments();
        let mut mass = Matrix3::from_diagonal(&Vector3::new(own.mass, own.mass, own.inertia));
        for load in self.loads.iter().filter(|load| load.hub == hub) {
            mass += load.mass(own.centre, &blocks[load.body].start_moments());
        }
        let wrench = Vector3::from(wrench);
        let moved = mass.cholesky()?.solve(&wrench);
        Some(wrench.dot(&moved))
    }
}

impl Load {
    /// The mass that it adds, for the velocity of a point (m) and the spin of the hub (kg, kg m, kg m²).
    fn mass(&self, about: Vec2, body: &Moments) -> Matrix3<f64> {
        if self.is_welded {
            let mut mass = at_point(Matrix2::identity() * body.mass, body.centre - about);
            mass[(2, 2)] += body.inertia;
            return mass;
        }
        // Held at one place it gives way there by turning.
        let lever = perp(self.at - body.centre);
        let mobility = Matrix2::identity() / body.mass + lever * lever.transpose() / body.inertia;
        let mass = mobility.try_inverse().unwrap_or_default();
        at_point(mass, self.at - about)
    }
}

/// A mass at the end of a lever.
fn at_point(mass: Matrix2<f64>, lever: Vec2) -> Matrix3<f64> {
    let turns = perp(lever);
    let carried = mass * turns;
    Matrix3::new(
        mass[(0, 0)],
        mass[(0, 1)],
        carried.x,
        mass[(1, 0)],
        mass[(1, 1)],
        carried.y,
        carried.x,
        carried.y,
        turns.dot(&carried),
    )
}

fn is_spring(row: &JointRow) -> bool {
    matches!(row.law, JointLaw::Spring(_))
}

fn holds(row: &JointRow) -> bool {
    matches!(row.law, JointLaw::Rigid { .. })
}

/// Whether a grip is that of a rigid body which forces move along all of its dofs.
fn is_free_hub(blocks: &[Block], grip: &JointGrip) -> bool {
    matches!(&blocks[grip.block], Block::Rigid(block) if block.moves_along() == [true; 3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    const HUB: [f64; 2] = [0.3, 0.02];
    const BODY: Moments = Moments {
        mass: 5.0,
        centre: Vec2::new(0.7, -0.4),
        velocity: Vec2::new(0.0, 0.0),
        spin_momentum: 0.0,
        inertia: 0.6,
    };

    /// How far a unit wrench moves the hub along itself, from the masses of both and rows that hold them together at points.
    fn by_multipliers(points: &[Vec2], about: Vec2, wrench: [f64; 3]) -> f64 {
        let n = 6 + 2 * points.len();
        let mut system = DMatrix::<f64>::zeros(n, n);
        let masses = [HUB[0], HUB[0], HUB[1], BODY.mass, BODY.mass, BODY.inertia];
        for (place, mass) in masses.into_iter().enumerate() {
            system[(place, place)] = mass;
        }
        for (slot, point) in points.iter().enumerate() {
            let [hub, body] = [perp(point - about), perp(point - BODY.centre)];
            for (axis, (hub, body)) in hub.iter().zip(body.iter()).enumerate() {
                let row = 6 + 2 * slot + axis;
                for (column, value) in [(axis, -1.0), (2, -hub), (3 + axis, 1.0), (5, *body)] {
                    system[(row, column)] = value;
                    system[(column, row)] = value;
                }
            }
        }
        let mut load = DVector::<f64>::zeros(n);
        load.rows_mut(0, 3).copy_from_slice(&wrench);
        // Two points hold three motions by four rows.
        let moved = system
            .svd(true, true)
            .solve(&load, 1e-9)
            .unwrap_or_default();
        (0..3).map(|i| wrench[i] * moved[i]).sum()
    }

    #[test]
    fn a_laden_hub_moves_as_the_equations_of_both_bodies_say() {
        let about = Vec2::new(0.1, 0.2);
        let points = [Vec2::new(0.15, 0.1), Vec2::new(0.2, 0.3)];
        for wrench in [
            [1.0, 0.0, 0.0],
            [0.3, -0.8, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.8, -0.2],
        ] {
            for is_welded in [false, true] {
                let load = Load {
                    hub: 0,
                    body: 1,
                    at: points[0],
                    is_welded,
                };
                let mut mass = Matrix3::from_diagonal(&Vector3::new(HUB[0], HUB[0], HUB[1]));
                mass += load.mass(about, &BODY);
                let moved = mass.try_inverse().unwrap_or_default() * Vector3::from(wrench);
                let ours = Vector3::from(wrench).dot(&moved);
                let theirs = match is_welded {
                    true => by_multipliers(&points, about, wrench),
                    false => by_multipliers(&points[..1], about, wrench),
                };
                assert!(
                    (ours - theirs).abs() < 1e-9 * theirs,
                    "{wrench:?}: {ours} {theirs}"
                );
            }
        }
    }
}
