//! Velocities of a rigid motion, and those that pins give to a body.

use crate::math::{Vec2, cross, node_vec, perp, rounding, set_node_vec};
use nalgebra::{Matrix3, Vector3};

/// Share of the largest eigenvalue below which one says that the pins leave that motion free.
const FREE: f64 = rounding::SHARE;

/// Velocities of a rigid motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidRates {
    /// Where the velocity is measured (m).
    pub about: Vec2,
    /// Velocity there (m/s).
    pub velocity: Vec2,
    /// Spin (rad/s).
    pub spin: f64,
}

/// What held dofs know of a rigid motion: the rows of their velocities in it, and the pseudo-inverse of their sum of squares. What they do not tell, as
/// sliding along a guide, is left out.
struct Pins {
    about: Vec2,
    /// Turns are measured by how fast the dofs move in them (m).
    arm: f64,
    inverse: Matrix3<f64>,
}

impl Pins {
    fn new(dofs: &[usize], position: &[f64]) -> Self {
        let n = dofs.len() as f64;
        let places = || dofs.iter().map(|&dof| node_vec(position, dof / 2));
        let about = places().sum::<Vec2>() / n;
        let spread = places()
            .map(|place| (place - about).norm_squared())
            .sum::<f64>()
            / n;
        let mut pins = Self {
            about,
            arm: if spread > 0.0 { spread.sqrt() } else { 1.0 },
            inverse: Matrix3::zeros(),
        };
        let rows = dofs.iter().map(|&dof| pins.row(position, dof));
        let squares: Matrix3<f64> = rows.map(|row| row * row.transpose()).sum();
        let found = squares.symmetric_eigen();
        let largest = found.eigenvalues.max();
        for (value, vector) in found
            .eigenvalues
            .iter()
            .zip(found.eigenvectors.column_iter())
        {
            if *value > FREE * largest {
                pins.inverse += vector * vector.transpose() / *value;
            }
        }
        pins
    }

    fn row(&self, position: &[f64], dof: usize) -> Vector3<f64> {
        let turning = perp(node_vec(position, dof / 2) - self.about)[dof % 2] / self.arm;
        match dof % 2 {
            0 => Vector3::new(1.0, 0.0, turning),
            _ => Vector3::new(0.0, 1.0, turning),
        }
    }
}

/// Adds the least forces of held dofs that have this resultant (N) and this moment about a place (N m), as far as they can have them.
pub(super) fn push_by_pins(
    dofs: &[usize],
    position: &[f64],
    (force, moment, about): (Vec2, f64, Vec2),
    forces: &mut [f64],
) {
    let pins = Pins::new(dofs, position);
    let own = moment + cross(about - pins.about, force);
    let shares = pins.inverse * Vector3::new(force.x, force.y, own / pins.arm);
    for &dof in dofs {
        forces[dof] += pins.row(position, dof).dot(&shares);
    }
}

impl RigidRates {
    /// The rigid motion nearest to the velocities of held dofs, `None` if these rest. What the dofs do not tell of it, as sliding along a guide, is left
    /// out.
    pub(super) fn of_pins(
        dofs: &[usize],
        position: &[f64],
        velocity: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        if dofs.iter().all(|&dof| velocity(dof) == 0.0) {
            return None;
        }
        let pins = Pins::new(dofs, position);
        let rows = dofs.iter();
        let right: Vector3<f64> = rows
            .map(|&dof| velocity(dof) * pins.row(position, dof))
            .sum();
        let rates = pins.inverse * right;
        Some(Self {
            about: pins.about,
            velocity: Vec2::new(rates[0], rates[1]),
            spin: rates[2] / pins.arm,
        })
    }

    /// Velocity at a place (m/s).
    pub fn at(&self, place: Vec2) -> Vec2 {
        self.velocity + self.spin * perp(place - self.about)
    }

    /// Writes the velocities at nodal positions, interleaved.
    pub(super) fn write_at(&self, position: &[f64], velocity: &mut [f64]) {
        for node in 0..position.len() / 2 {
            set_node_vec(velocity, node, self.at(node_vec(position, node)));
        }
    }

    /// Whether both are one motion.
    pub fn is_same(&self, other: &Self) -> bool {
        self.spin == other.spin && self.at(other.about) == other.velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [f64; 8] = [3.0, 1.0, 4.0, 1.0, 4.0, 1.5, 3.0, 1.5];

    fn of(dofs: &[usize], motion: &RigidRates) -> Option<RigidRates> {
        RigidRates::of_pins(dofs, &PLACES, |dof| {
            motion.at(node_vec(&PLACES, dof / 2))[dof % 2]
        })
    }

    #[test]
    fn a_rigid_motion_is_found_wherever_pins_tell_of_it() {
        let motion = RigidRates {
            about: Vec2::new(-7.0, 2.0),
            velocity: Vec2::new(1.5, -0.5),
            spin: 0.8,
        };
        for dofs in [&[0, 1, 2, 3, 4, 5, 6, 7][..], &[0, 1, 4, 5], &[0, 1, 3]] {
            let found = of(dofs, &motion).expect("pins that move");
            for place in [Vec2::zeros(), Vec2::new(5.0, -2.0)] {
                let off = (found.at(place) - motion.at(place)).norm();
                assert!(off < 1e-12, "{dofs:?}: {off}");
            }
        }
    }

    #[test]
    fn guides_and_hinges_tell_of_what_they_hold() {
        let lifted = RigidRates {
            about: Vec2::zeros(),
            velocity: Vec2::new(2.0, 1.0),
            spin: 0.0,
        };
        // Rollers: nothing holds x.
        let found = of(&[1, 3], &lifted).expect("rollers that move");
        assert!((found.at(Vec2::new(9.0, 9.0)) - Vec2::new(0.0, 1.0)).norm() < 1e-12);
        // A hinge: nothing holds the turn.
        let found = of(&[4, 5], &lifted).expect("a hinge that moves");
        assert_eq!(found.spin, 0.0);
        assert!((found.velocity - lifted.velocity).norm() < 1e-12);
        let at_rest = RigidRates {
            velocity: Vec2::zeros(),
            ..lifted
        };
        assert_eq!(of(&[0, 1, 2, 3], &at_rest), None);
    }
}
