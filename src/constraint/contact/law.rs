//! The contact law: Signorini's condition, Coulomb's cone and Newton's restitution; it knows no shape function.

use crate::math::Vec2;

/// Coefficients of one contact, already combined from both colliders by rapier's rules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLaw {
    /// Coulomb's coefficient μ (-).
    pub friction: f64,
    /// Newton's coefficient of restitution e (-), used where an impact is shorter than the step.
    pub restitution: f64,
    /// Distance at which the contact closes (m).
    pub skin: f64,
    /// Direction of the normal force, if the user chose it.
    pub direction: Option<Direction>,
    /// How far the target carries the point along within the step, as a belt that stands still does (m).
    pub carried: Vec2,
}

/// A direction for the normal force that geometry did not give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// Unit normal, from the target to the point, kept for the step.
    pub normal: Vec2,
    /// Gap along it at the beginning of the step (m); that of the geometry if it is not known.
    pub gap: Option<f64>,
}

impl ContactLaw {
    /// Normal velocity asked for after an impact that closes at `approach` (m/s, negative when closing):
    /// `-e v⁻`, and nothing below `threshold`, so that resting contacts do not bounce.
    pub fn rebound(&self, approach: f64, threshold: f64) -> f64 {
        if approach < -threshold {
            -self.restitution * approach
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_closing_contacts_faster_than_the_threshold_rebound() {
        let law = ContactLaw {
            friction: 0.0,
            restitution: 0.5,
            ..ContactLaw::default()
        };
        assert_eq!(law.rebound(-2.0, 0.1), 1.0);
        assert_eq!(law.rebound(-0.05, 0.1), 0.0);
        assert_eq!(law.rebound(2.0, 0.1), 0.0);
    }
}
