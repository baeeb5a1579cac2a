//! How much of an impact is shorter than the step.
//!
//! A contact through a surface without mass gives way by the springs of the surface and by the masses behind it,
//! `W = K_ss⁻¹/s + W_m`, `s = b0 + β b1`. The multiplier that ends an approach `v` within the step is `p = v dt/(b0 W)`; it changes
//! the velocity of these masses by
//!
//! ```text
//! b1 W_m p = v (b1 dt / b0) (W_m / W).
//! ```
//!
//! Up to `W_m/W = b0/(b1 dt)`, one half for the trapezoidal rule, they are slowed and the springs take their motion: the step resolves the
//! impact. Beyond that they are thrown back faster than anything stopped them, and as `1 - β1` of the force is still to act, up to
//! three times as fast as they came where the springs are stiff. There the velocity stage holds the contact.
//!
//! The masses next to the contact count, not those of the whole body: a board that is pinned has no rigid motion and resolves no impact of its
//! cells for that.

use super::settings::SolveSettings;
use crate::constraint::contact::Kinematics;
use crate::math::{Mat2, judged::Judged};
use crate::system::{Block, Response};

/// Share of rigid mobility below which bodies meet by their elasticity; as rigid ones above what is left of the whole.
const ELASTIC: Judged = Judged::new("kkt::ELASTIC", 0.3);

/// How much of a contact's mobility within the step is that of the masses behind the surface, and how much that of rigid bodies, both
/// mapped to [0, 1].
pub(super) fn unresolved_shares(
    blocks: &[Block],
    kinematics: &Kinematics,
    settings: &SolveSettings,
) -> [f64; 2] {
    let normal = kinematics.normal;
    let along = |of: Mat2| normal.dot(&(of * normal));
    let (mut rigid, mut actual, mut springs) = (0.0, 0.0, 0.0);
    // A body that meets itself has no rigid motion against itself.
    let is_own = kinematics.is_own();
    for a in kinematics.attachments() {
        let block = &blocks[a.block];
        if !is_own {
            rigid += a.weight.abs() * block.rigid_mobility(a.grip, normal);
        }
        for b in kinematics.attachments() {
            if a.block == b.block {
                let weight = a.weight * b.weight;
                actual += weight * along(block.compliance(a.grip, b.grip, Response::Velocity));
                springs += weight * along(block.spring_compliance(a.grip, b.grip));
            }
        }
    }
    if actual <= 0.0 {
        return [0.0; 2];
    }
    let resolved = settings.b0 / (settings.b1 * settings.dt);
    [
        smooth_step(1.0 - springs / actual, [resolved, 1.0]),
        share_of(rigid, actual),
    ]
}

/// Maps the share that rigid mobility has of a mobility to [0, 1].
pub(super) fn share_of(rigid: f64, actual: f64) -> f64 {
    let share = if actual > 0.0 { rigid / actual } else { 0.0 };
    smooth_step(share, [ELASTIC.get(), 1.0 - ELASTIC.get()])
}

/// From 0 up to the first bound to 1 from the second on, without a kink; 0 if the bounds leave no room.
fn smooth_step(value: f64, [from, to]: [f64; 2]) -> f64 {
    if from >= to {
        return 0.0;
    }
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{FlexBodyBuilder, Pin};
    use crate::fe::material::LinearElastic;
    use crate::integrator::Beta2;
    use crate::math::Vec2;
    use crate::system::samples::{body_of, predicted};
    use crate::system::{Grip, Point};

    const DT: f64 = 1e-2;

    /// Compliances of velocities of a pinned plate at a node of its upper face, along the face's normal: of the whole and of the springs (1/kg).
    fn compliances(young: f64, density: f64, rayleigh: f64) -> [f64; 2] {
        let material = LinearElastic::plane_stress(young, 0.3)
            .density(density)
            .rayleigh(rayleigh);
        let plate = FlexBodyBuilder::rectangle([1.0, 0.8], [8, 6])
            .small_strain()
            .material(material)
            .pin_where(|[_, y]| y < 1e-9, Pin::both());
        let body = body_of(plate);
        let mut block = predicted(&body, DT);
        let rest = body.model().placed_positions();
        let upper = (0..body.model().n_nodes()).filter(|node| rest[2 * node + 1] > 0.8 - 1e-9);
        let middle = upper.min_by(|a, b| {
            let off = |node: &usize| (rest[2 * node] - 0.5).abs();
            off(a).total_cmp(&off(b))
        });
        let node = middle.unwrap_or(0);
        block.prepare_compliance(node);
        let block = Block::Flex(Box::new(block));
        let grip = Grip {
            point: Point::Node(node),
            lever: Vec2::zeros(),
        };
        let whole = block.compliance(grip, grip, Response::Velocity);
        [whole, block.spring_compliance(grip, grip)].map(|of| of[(1, 1)])
    }

    /// Masses that nothing moves leave the springs alone, which give way by their stiffness.
    #[test]
    fn behind_a_surface_on_immovable_masses_there_are_its_springs_only() {
        for rayleigh in [0.0, 1e-3, 1e-1] {
            let [whole, springs] = compliances(1e6, 1e15, rayleigh);
            assert!(
                springs > 0.0 && (springs / whole - 1.0).abs() < 1e-6,
                "β {rayleigh}: springs {springs:e} of {whole:e}"
            );
            // Twice as stiff, half as much; and masses that move give way besides.
            let [whole, stiffer] = compliances(2e6, 1e3, rayleigh);
            assert!((springs / stiffer - 2.0).abs() < 1e-6 && whole > stiffer);
        }
    }

    #[test]
    fn the_share_of_what_is_held_rises_from_one_bound_to_the_other() {
        assert_eq!(smooth_step(0.5, [0.5, 1.0]), 0.0);
        assert_eq!(smooth_step(0.75, [0.5, 1.0]), 0.5);
        assert_eq!(smooth_step(1.0, [0.5, 1.0]), 1.0);
        assert_eq!(smooth_step(2.0, [1.0, 1.0]), 0.0);
        // `b0/(b1 dt)` of the trapezoidal rule.
        let weights = Beta2::trapezoidal().weights(DT);
        assert!((weights.b0 / (weights.b1 * DT) - 0.5).abs() < 1e-12);
    }
}
