//! How long a body has stayed where it is.

/// Where the nodes were when they last moved, and how long they have stayed there since.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct Stillness {
    places: Vec<f64>,
    /// Time since then (s).
    time: f64,
}

impl Stillness {
    /// How long no node has been farther than the tolerance from where it was when some last was (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Looks at the places and velocities that the nodes have after a step, interleaved.
    ///
    /// What is held where it is may have velocities that turn round in every step, and contact forces with them: they count by the way of one step.
    pub fn look(&mut self, [positions, velocities]: [&[f64]; 2], dt: f64, tolerance: f64) {
        let is_slow = |v: &[f64]| dt * dt * (v[0] * v[0] + v[1] * v[1]) <= tolerance * tolerance;
        let same = self.places.len() == positions.len();
        let mut moved = self.places.chunks_exact(2).zip(positions.chunks_exact(2));
        let is_near = |(was, is): (&[f64], &[f64])| {
            let [x, y] = [is[0] - was[0], is[1] - was[1]];
            x * x + y * y <= tolerance * tolerance
        };
        let is_slow = velocities.chunks_exact(2).all(is_slow);
        if same && is_slow && moved.all(is_near) {
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

    #[test]
    fn what_drifts_by_less_than_the_tolerance_in_every_step_does_not_stay() {
        let mut still = Stillness::default();
        let times = (0..7).map(|step| {
            still.look([&[0.3 * f64::from(step), 1.0], &[0.6, 0.0]], 0.5, 1.0);
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
            still.look([&[2.0 + sign, -sign], &[0.8, -0.8]], 0.5, 1.5);
        }
        assert_eq!(still.time(), 4.0);
    }

    #[test]
    fn what_is_held_with_a_velocity_does_not_stay() {
        let mut still = Stillness::default();
        for step in 0..4 {
            let velocity = if step % 2 == 0 { 3.0 } else { -3.0 };
            still.look([&[1.0, 1.0], &[0.0, velocity]], 0.5, 1.0);
        }
        assert_eq!(still.time(), 0.0);
    }
}
