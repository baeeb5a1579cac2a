//! Rigid obstacles: how far a place is from one, and in what direction.

use crate::large::LargeError;
use crate::math::Vec2;

/// A rigid obstacle that nodes of a body are kept out of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    shape: Shape,
    friction: f64,
    travel: Vec2,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// All places from which the normal leads away.
    HalfPlane { point: Vec2, normal: Vec2 },
    /// All places nearer to a segment than the radius; a disc where both ends are one.
    Rounded { ends: [Vec2; 2], radius: f64 },
}

/// Where a node is beside an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    /// Distance (m), negative inside.
    pub(super) gap: f64,
    /// Out of the obstacle, of length one.
    pub(super) normal: Vec2,
    /// By how much the normal turns over the length of a way across it (1/m).
    pub(super) curvature: f64,
}

impl Obstacle {
    /// All that is behind a line.
    ///
    /// - `point`: on the line (m);
    /// - `normal`: out of the obstacle, of any length.
    pub fn half_plane(point: [f64; 2], normal: [f64; 2]) -> Self {
        let normal = Vec2::from(normal);
        Self::of(Shape::HalfPlane {
            point: point.into(),
            normal: normal / normal.norm(),
        })
    }

    /// A disc by its centre and radius (m).
    pub fn disc(centre: [f64; 2], radius: f64) -> Self {
        Self::segment([centre; 2], radius)
    }

    /// A segment between two places with round ends, as thick as twice the radius (m).
    pub fn segment(ends: [[f64; 2]; 2], radius: f64) -> Self {
        let ends = ends.map(Vec2::from);
        Self::of(Shape::Rounded { ends, radius })
    }

    fn of(shape: Shape) -> Self {
        Self {
            shape,
            friction: 0.0,
            travel: Vec2::zeros(),
        }
    }

    /// The same with Coulomb's friction (-).
    pub fn with_friction(self, friction: f64) -> Self {
        Self { friction, ..self }
    }

    /// The same on a straight way (m) that it goes during a load case.
    pub fn moving_by(self, travel: [f64; 2]) -> Self {
        let travel = travel.into();
        Self { travel, ..self }
    }

    /// The obstacle where it is after its way, at rest.
    pub fn moved(self) -> Self {
        let by = self.travel;
        let shape = match self.shape {
            Shape::HalfPlane { point, normal } => Shape::HalfPlane {
                point: point + by,
                normal,
            },
            Shape::Rounded { ends, radius } => Shape::Rounded {
                ends: ends.map(|end| end + by),
                radius,
            },
        };
        Self {
            shape,
            travel: Vec2::zeros(),
            ..self
        }
    }

    /// Coulomb's coefficient (-).
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// The ends of the line that it is around, where it begins (m); none of a half-plane, which has no other side.
    pub(super) fn line(&self) -> Option<[Vec2; 2]> {
        match self.shape {
            Shape::HalfPlane { .. } => None,
            Shape::Rounded { ends, .. } => Some(ends),
        }
    }

    /// How far it has gone at a share of the case (m).
    pub(super) fn gone(&self, share: f64) -> Vec2 {
        share * self.travel
    }

    /// A place (m) beside the obstacle at a share of its way. In the middle of what is round nothing is a number.
    pub(super) fn beside(&self, place: Vec2, share: f64) -> Beside {
        let place = place - self.gone(share);
        match self.shape {
            Shape::HalfPlane { point, normal } => Beside {
                gap: normal.dot(&(place - point)),
                normal,
                curvature: 0.0,
            },
            Shape::Rounded { ends, radius } => {
                let along = ends[1] - ends[0];
                let squared = along.norm_squared();
                let at = (place - ends[0]).dot(&along);
                let (foot, is_end) = if at <= 0.0 || squared == 0.0 {
                    (ends[0], true)
                } else if at >= squared {
                    (ends[1], true)
                } else {
                    (ends[0] + at / squared * along, false)
                };
                let away = place - foot;
                let distance = away.norm();
                Beside {
                    gap: distance - radius,
                    normal: away / distance,
                    curvature: if is_end { 1.0 / distance } else { 0.0 },
                }
            }
        }
    }

    pub(super) fn check(&self, index: usize) -> Result<(), LargeError> {
        let refuse = |what, value| Err(LargeError::Obstacle { index, what, value });
        let is_finite = |v: Vec2| v.x.is_finite() && v.y.is_finite();
        match self.shape {
            Shape::HalfPlane { point, normal } => {
                if !is_finite(point) {
                    return refuse("a point of its line", f64::NAN);
                }
                if !is_finite(normal) {
                    return refuse("a normal without direction", f64::NAN);
                }
            }
            Shape::Rounded { ends, radius } => {
                if !ends.into_iter().all(is_finite) {
                    return refuse("an end", f64::NAN);
                }
                if !(radius > 0.0 && radius.is_finite()) {
                    return refuse("the radius", radius);
                }
            }
        }
        if !(self.friction >= 0.0 && self.friction.is_finite()) {
            return refuse("the coefficient of friction", self.friction);
        }
        if !is_finite(self.travel) {
            return refuse("the way", f64::NAN);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gap and normal against their differences over 1e-6: the normal is the slope of the gap, and turns by the curvature.
    #[test]
    fn the_normal_is_the_slope_of_the_gap_and_turns_by_the_curvature() {
        let obstacles = [
            Obstacle::half_plane([0.3, -0.2], [1.0, 2.0]),
            Obstacle::disc([0.2, 0.1], 0.5),
            Obstacle::segment([[-0.4, 0.0], [0.7, 0.3]], 0.1),
        ];
        let places = [[1.4, 0.2], [0.1, 0.9], [-0.8, 0.1], [0.3, -0.6]];
        for obstacle in obstacles.map(|one| one.moving_by([0.2, -0.1])) {
            for place in places.map(Vec2::from) {
                let at = obstacle.beside(place, 0.5);
                assert!((at.normal.norm() - 1.0).abs() < 1e-15);
                let moved = obstacle.moving_by([0.1, -0.05]).moved().beside(place, 0.7);
                assert!((moved.gap - at.gap).abs() < 1e-15);
                for way in [Vec2::new(1.0, 0.0), Vec2::new(0.6, 0.8)] {
                    let [above, below] =
                        [1e-6, -1e-6].map(|step| obstacle.beside(place + step * way, 0.5));
                    let slope = (above.gap - below.gap) / 2e-6;
                    assert!((slope - at.normal.dot(&way)).abs() < 1e-9);
                    let turn = (above.normal - below.normal) / 2e-6;
                    let across = crate::math::perp(at.normal);
                    let due = at.curvature * across.dot(&way) * across;
                    assert!((turn - due).norm() < 1e-8, "{obstacle:?}");
                }
            }
        }
    }
}
