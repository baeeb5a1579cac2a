//! How long a body has stayed where it is, in equilibrium.

use crate::math::judged::Judged;

/// How far a node of a body at rest is at most from where it was, over the body's size, and how much of its loads is at most out of
/// balance: displacements and forces are then those of equilibrium to some six digits. Rapier's own threshold, 5 cm/s, would freeze a
/// beam that swings.
const STILL: Judged = Judged::new("body::STILL", 1e-6);

/// How far a node of a body of this size may move at rest (m).
pub(crate) fn rest_way(size: f64) -> f64 {
    STILL * size
}

/// What may be left of loads that accelerate a body by so much if nothing balances them (m/s²).
pub(super) fn unbalance(load: f64) -> f64 {
    STILL * load
}

/// What counts as rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rest {
    /// Length of the step (s).
    pub dt: f64,
    /// How far a node is at most from where it was (m).
    pub way: f64,
    /// Acceleration that is at most left of what its loads would give it (m/s²).
    pub unbalance: f64,
}

/// Where the nodes were when they last moved, and how long they have stayed there since.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Stillness {
    places: Vec<f64>,
    /// Velocities after the last step.
    velocities: Vec<f64>,
    /// Time since then (s).
    time: f64,
}

impl Stillness {
    /// How long no node has been farther off than the tolerance from where it was when some last was, and no force out of balance (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Looks at the places and velocities that the nodes have after a step, interleaved.
    ///
    /// What is held where it is may have velocities that turn round in every step, and contact forces with them: they count by the way of one step. What
    /// swings so little that it stays may still be far from equilibrium if it is stiff: that shows in how its velocities change.
    pub fn look(&mut self, [positions, velocities]: [&[f64]; 2], rest: Rest) {
        let Rest { dt, way, unbalance } = rest;
        let has_size = |limit: f64| move |v: &[f64]| v[0] * v[0] + v[1] * v[1] <= limit * limit;
        let differ = |was: &[f64], is: &[f64]| [is[0] - was[0], is[1] - was[1]];
        let all_within = |before: &[f64], after: &[f64], limit: f64| {
            let mut pairs = before.chunks_exact(2).zip(after.chunks_exact(2));
            before.len() == after.len() && pairs.all(|(was, is)| has_size(limit)(&differ(was, is)))
        };
        let stays = velocities.chunks_exact(2).all(has_size(way / dt))
            && all_within(&self.velocities, velocities, dt * unbalance)
            && all_within(&self.places, positions, way);
        self.velocities.clear();
        self.velocities.extend_from_slice(velocities);
        if stays {
            self.time += dt;
            return;
        }
        self.time = 0.0;
        self.places.clear();
        self.places.extend_from_slice(positions);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REST: Rest = Rest {
        dt: 0.5,
        way: 1.0,
        unbalance: f64::INFINITY,
    };

    #[test]
    fn what_drifts_by_less_than_the_tolerance_in_every_step_does_not_stay() {
        let mut still = Stillness::default();
        let times = (0..7).map(|step| {
            still.look([&[0.3 * f64::from(step), 1.0], &[0.6, 0.0]], REST);
            still.time()
        });
        let times: Vec<f64> = times.collect();
        assert_eq!(times, [0.0, 0.5, 1.0, 1.5, 0.0, 0.5, 1.0]);
    }

    #[test]
    fn what_trembles_within_the_tolerance_stays() {
        let mut still = Stillness::default();
        for step in 0..9 {
            let sign = if step % 2 == 0 { 0.4 } else { -0.4 };
            still.look(
                [&[2.0 + sign, -sign], &[0.8, -0.8]],
                Rest { way: 1.5, ..REST },
            );
        }
        assert_eq!(still.time(), 4.0);
    }

    #[test]
    fn what_is_held_with_a_velocity_does_not_stay() {
        let mut still = Stillness::default();
        for step in 0..4 {
            let velocity = if step % 2 == 0 { 3.0 } else { -3.0 };
            still.look([&[1.0, 1.0], &[0.0, velocity]], REST);
        }
        assert_eq!(still.time(), 0.0);
    }

    /// Stiff bodies move by little while their forces are far from those of equilibrium.
    #[test]
    fn what_is_out_of_balance_does_not_stay() {
        for (unbalance, stays) in [(1.5, false), (1.7, true)] {
            let mut still = Stillness::default();
            for step in 0..5 {
                let velocity = if step % 2 == 0 { 0.4 } else { -0.4 };
                still.look([&[1.0, 1.0], &[0.0, velocity]], Rest { unbalance, ..REST });
            }
            assert_eq!(still.time() > 0.0, stays, "{unbalance} m/s²");
        }
    }
}
