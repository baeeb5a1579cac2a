//! Whether a moving point has passed through a moving line.

pub type P = [f64; 2];

pub fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn cross(a: P, b: P) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: P, b: P) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Share `t` of the way from `a` to `b`.
pub fn mix(a: P, b: P, t: f64) -> P {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

/// A point and an open line as a step leaves them.
#[derive(Clone, Debug)]
pub struct Frame {
    pub point: P,
    pub line: Vec<P>,
}

/// How often the point passed through the line from left to right less the other way, as both go straight from one frame to the next;
/// passing beyond the line's ends does not count.
pub fn net_crossings(from: &Frame, to: &Frame) -> i32 {
    let segments = from.line.windows(2).zip(to.line.windows(2));
    segments
        .map(|(before, after)| {
            let ends = [[before[0], after[0]], [before[1], after[1]]];
            passages(ends, [from.point, to.point])
        })
        .sum()
}

/// Passages through one segment: the area spanned with the point is a quadratic in time.
fn passages(ends: [[P; 2]; 2], point: [P; 2]) -> i32 {
    let along = [0, 1].map(|time| sub(ends[1][time], ends[0][time]));
    let offset = [0, 1].map(|time| sub(point[time], ends[0][time]));
    let (along_rate, offset_rate) = (sub(along[1], along[0]), sub(offset[1], offset[0]));
    let a = cross(along_rate, offset_rate);
    let b = cross(along_rate, offset[0]) + cross(along[0], offset_rate);
    let c = cross(along[0], offset[0]);
    let mut sum = 0;
    for t in roots(a, b, c) {
        // Half-open, so that a passage at a common node or at a frame counts once.
        if !(t > 0.0 && t <= 1.0) {
            continue;
        }
        let at = mix(offset[0], offset[1], t);
        let on = mix(along[0], along[1], t);
        let share = dot(at, on) / dot(on, on);
        if (0.0..1.0).contains(&share) {
            sum += if 2.0 * a * t + b < 0.0 { 1 } else { -1 };
        }
    }
    sum
}

/// Real roots of `a t² + b t + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 || (a == 0.0 && b == 0.0) {
        return Vec::new();
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let mut found = Vec::new();
    if q != 0.0 {
        found.push(c / q);
    }
    if a != 0.0 {
        found.push(q / a);
    }
    found
}

/// Whether a closed line goes round a point: by the edges that a ray to the right of it crosses.
pub fn encloses(surface: &[P], point: P) -> bool {
    let ends = surface.iter().zip(surface.iter().cycle().skip(1));
    let turns = ends.map(|(from, to)| {
        let rises = [from, to].map(|end| end[1] > point[1]);
        let is_left = cross(sub(*to, *from), sub(point, *from)) > 0.0;
        match rises {
            [false, true] if is_left => 1,
            [true, false] if !is_left => -1,
            _ => 0,
        }
    });
    turns.sum::<i32>() > 0
}

/// On which side of the line the point is, by its nearest segment: 1 left, -1 right, 0 if it is nearest to an end and so
/// may be going round it.
pub fn side(frame: &Frame) -> i32 {
    let mut best = (f64::INFINITY, 0usize, 0.0);
    for (index, pair) in frame.line.windows(2).enumerate() {
        let along = sub(pair[1], pair[0]);
        let share = (dot(sub(frame.point, pair[0]), along) / dot(along, along)).clamp(0.0, 1.0);
        let off = sub(frame.point, mix(pair[0], pair[1], share));
        if dot(off, off) < best.0 {
            best = (dot(off, off), index, share);
        }
    }
    let (_, index, share) = best;
    let last = frame.line.len() - 2;
    if (index == 0 && share == 0.0) || (index == last && share == 1.0) {
        return 0;
    }
    let pair = [frame.line[index], frame.line[index + 1]];
    let area = cross(sub(pair[1], pair[0]), sub(frame.point, pair[0]));
    if share > 0.0 && share < 1.0 {
        return if area > 0.0 { 1 } else { -1 };
    }
    // At a node: the sharper of both segments decides.
    let other = if share == 0.0 { index - 1 } else { index + 1 };
    let next = [frame.line[other], frame.line[other + 1]];
    let turn =
        cross(sub(pair[1], pair[0]), sub(next[1], next[0])) * if share == 0.0 { -1.0 } else { 1.0 };
    // Nearest to a node from outside the bend: the bend turns away from the point.
    if turn > 0.0 { -1 } else { 1 }
}
