use super::Toi;
use crate::math::{Vec2, rotation};
use crate::path::samples::{Random, distance, power_of_ten};
use crate::path::{MemberPair, Motion, MotionKind, Path, Surfaces};

mod motions;

/// A pair of members, a motion of both, and the law between them.
struct Scene {
    surfaces: Surfaces,
    motion: Motion,
    pair: MemberPair,
}

impl Scene {
    /// Two members of kinds, with centres about which rigid ones turn.
    fn new(one: (MotionKind, &[Vec2], bool), other: (MotionKind, &[Vec2], bool)) -> Self {
        let mut surfaces = Surfaces::new();
        for (kind, points, closed) in [one, other] {
            surfaces.add_chain(kind, closed, points, closed);
        }
        let mut motion = Motion::new();
        motion.rest(&surfaces);
        Self {
            surfaces,
            motion,
            pair: MemberPair {
                one: 0,
                other: 1,
                name: 0,
                closing: 0.01,
                margin: 0.01,
                least: f64::INFINITY,
                is_asleep: false,
            },
        }
    }

    /// Random members apart from each other, anywhere from below their guard to far away, and random motions of a size
    /// that makes about every second pair meet.
    fn random(random: &mut Random) -> Self {
        let kinds = [MotionKind::Still, MotionKind::Rigid, MotionKind::Flexible];
        loop {
            let mut surfaces = Surfaces::new();
            let kinds = [kinds[1 + random.index(2)], kinds[random.index(3)]];
            let centres = [random.point(1.5), random.point(1.5)];
            let members = [0, 1]
                .map(|side: usize| random.member(&mut surfaces, kinds[side], centres[side], 1.0));
            if Path::new().apart(&surfaces, [0, 1], 0.0).is_none() {
                continue;
            }
            let size = power_of_ten(random.within(1.5));
            let mut motion = Motion::new();
            motion.rest(&surfaces);
            for side in [0, 1] {
                let shift = random.point(size);
                let most = if random.unit() < 0.5 { 0.3 } else { 7.0 };
                let turn = random.within(most);
                match kinds[side] {
                    MotionKind::Still => {}
                    // Not always about a point inside.
                    MotionKind::Rigid => {
                        let centre = centres[side] + random.point(0.2);
                        motion.move_rigid(&surfaces, members[side], centre, shift, turn);
                    }
                    MotionKind::Flexible => {
                        let turn = rotation(0.3 * turn);
                        for end in motion.ends_mut(&surfaces, members[side]) {
                            let stray = random.point(0.2 * size);
                            *end = centres[side] + turn * (*end - centres[side]) + shift + stray;
                        }
                    }
                }
            }
            let distance = distance(&surfaces, surfaces.points(), 0, 1);
            let height = [-0.3, 1e-9, 1e-3, 0.1, 0.8, 1.0, 3.0, 30.0][random.index(8)];
            let margin = distance * power_of_ten(-3.0 * random.unit()) / (1.0 + f64::abs(height));
            let closing = distance + (0.8 - height) * margin;
            let pair = MemberPair {
                one: 0,
                other: 1,
                name: 0,
                closing,
                margin,
                least: f64::INFINITY,
                is_asleep: false,
            };
            return Self {
                surfaces,
                motion,
                pair,
            };
        }
    }

    fn toi(&self) -> Toi {
        Path::new().time_of_impact(&self.surfaces, &self.motion, &[self.pair], &mut Vec::new())
    }

    fn distance_at(&self, t: f64, points: &mut [Vec2]) -> f64 {
        for (index, member) in self.surfaces.members().iter().enumerate() {
            for point in member.points.clone() {
                let track = self.motion.track(&self.surfaces, index, point);
                points[point] = track.at(t, track.heading(t)).0;
            }
        }
        distance(&self.surfaces, points, 0, 1)
    }

    /// Checks the time of impact at many instants; returns whether it was cut though the pair would not have come to
    /// `closing`, the instants after it at which the pair is just over its floor or lower, and the result.
    fn check(&self, n_instants: usize) -> (bool, bool, Toi) {
        let toi = self.toi();
        let mut points = self.surfaces.points().to_vec();
        let start = self.distance_at(0.0, &mut points);
        let floor = self.pair.floor(start);
        for k in 0..=n_instants {
            let t = toi.t * k as f64 / n_instants as f64;
            let distance = self.distance_at(t, &mut points);
            // Coordinates of up to a hundred round the distance by 1e-14; the law's figures are relative.
            assert!(
                distance >= floor * (1.0 - 1e-9) - 4e-14,
                "{distance} < {floor} at {t} of {toi:?}"
            );
        }
        let all = |goal: f64, from: f64, points: &mut [Vec2]| {
            (0..=n_instants).all(|k| {
                let t = from + (1.0 - from) * (k as f64 / n_instants as f64).powi(3);
                self.distance_at(t, points) > goal
            })
        };
        let for_nothing =
            toi.t < 1.0 && start > self.pair.closing && all(self.pair.closing, 0.0, &mut points);
        let near_floor = floor + 0.1 * (start - floor).min(self.pair.margin);
        let early = toi.t < 1.0 && all(near_floor, toi.t, &mut points);
        (for_nothing, early, toi)
    }
}

fn check_many(n_scenes: usize, n_instants: usize) {
    let mut random = Random::new(30);
    let (mut n_cut, mut n_free, mut n_for_nothing, mut n_early, mut n_exhausted) = (0, 0, 0, 0, 0);
    let mut n_advances = 0;
    for _ in 0..n_scenes {
        let scene = Scene::random(&mut random);
        let (for_nothing, early, toi) = scene.check(n_instants);
        n_cut += usize::from(toi.t < 1.0);
        n_free += usize::from(toi.t == 1.0);
        n_for_nothing += usize::from(for_nothing);
        n_early += usize::from(early);
        n_exhausted += toi.n_exhausted;
        n_advances += toi.n_advances;
    }
    println!(
        "cut {n_cut}, free {n_free}, for nothing {n_for_nothing}, early {n_early}, exhausted {n_exhausted}, advances {n_advances}"
    );
    assert!(
        n_cut > n_scenes / 5 && n_free > n_scenes / 5,
        "{n_cut} {n_free}"
    );
    assert!(n_for_nothing * 1_000 <= n_scenes, "{n_for_nothing}");
    // Grazing between the samples, or a stop just before a floor that would not have been met.
    assert!(n_early * 50 <= n_scenes, "{n_early}");
    assert!(n_exhausted * 100 <= n_scenes, "{n_exhausted}");
}

#[test]
fn random_motions_never_come_below_their_floor_and_are_not_cut_for_nothing() {
    check_many(2_000, 200);
}

#[test]
#[ignore = "half a minute"]
fn many_random_motions_never_come_below_their_floor() {
    check_many(20_000, 2_000);
}
