//! B19, a stick–slip oscillator: two masses, a spring, and friction under one of them.
//!
//! ```text
//!     N = 1e4 N
//!        v
//!     [5 kg]---/\\/\\/\\---[5 kg]--> P = 3 kN until 0.2 s
//!     =========  1e4 N/m
//!     mu = 0.3
//! ```
//!
//! The data leave open where friction acts; here it is under the left mass alone, so that its limit, 3 kN, is the pull.
//!
//! Exact: while the left mass sticks, the right one swings about `P/k` at `sqrt(k/m)`; it breaks loose when the spring pulls
//! with `mu N`, at `t = pi/(2 ω) = 35.124 ms`. While it slides, the centre moves under `P ∓ mu N` and the spring vibrates at
//! `sqrt(2 k/m)`: closed forms, joined where the left mass stops, turns or breaks loose (below, by bisection).
//!
//! Model: two three-node triangles on 1 × 0.01 m, lumped mass, slightly skewed so that only the lower left node touches
//! the floor; the others run on rails. It
//! is hundreds of times stiffer in shear than along (a cell
//! with bending modes is not). Steps of 1/20,000 s.
//!
//! Excellent: displacements to 1e-3 of the largest over 0.5 s.

use super::Outcome;
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use foil2d::prelude::*;

const MASS: f64 = 5.0;
const SPRING: f64 = 1e4;
const LIMIT: f64 = 3e3;
const NORMAL: f64 = 1e4;
const PULL: f64 = 3e3;
const RELEASE: f64 = 0.2;
const END: f64 = 0.5;
const DT: f64 = 5e-5;

/// Positions and velocities of the left and the right mass.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    x: [f64; 2],
    v: [f64; 2],
}

/// The exact motion from one state over a time in which friction (N, on the left mass) and pull stay what they are;
/// without `friction` the left mass sticks.
fn advance(from: State, friction: Option<f64>, pull: f64, t: f64) -> State {
    let swing = |x: f64, v: f64, omega: f64, rest: f64| {
        let (sin, cos) = (omega * t).sin_cos();
        [
            rest + (x - rest) * cos + v / omega * sin,
            v * cos - (x - rest) * omega * sin,
        ]
    };
    let [[x1, x2], [v1, v2]] = [from.x, from.v];
    let Some(friction) = friction else {
        let [x, v] = swing(x2, v2, (SPRING / MASS).sqrt(), x1 + pull / SPRING);
        return State {
            x: [x1, x],
            v: [0.0, v],
        };
    };
    let push = (pull + friction) / (2.0 * MASS);
    let (centre, speed) = (0.5 * (x1 + x2), 0.5 * (v1 + v2));
    let centre = centre + speed * t + 0.5 * push * t * t;
    let speed = speed + push * t;
    // m s'' = pull - friction - 2 k s
    let [s, rate] = swing(
        x2 - x1,
        v2 - v1,
        (2.0 * SPRING / MASS).sqrt(),
        (pull - friction) / (2.0 * SPRING),
    );
    State {
        x: [centre - 0.5 * s, centre + 0.5 * s],
        v: [speed - 0.5 * rate, speed + 0.5 * rate],
    }
}

/// The exact motion at the multiples of `DT`.
fn exact(n: usize) -> Vec<State> {
    let mut state = State::default();
    let mut friction = None;
    let mut states = Vec::new();
    for step in 0..n {
        let pull = if (step as f64 + 0.5) * DT < RELEASE {
            PULL
        } else {
            0.0
        };
        let mut left = DT;
        // No more than a few events fit into a step.
        for _ in 0..8 {
            // Positive once the phase is over.
            let over = |s: &State| match friction {
                None => (SPRING * (s.x[1] - s.x[0])).abs() - LIMIT,
                Some(f) => s.v[0] * f64::signum(f),
            };
            if over(&advance(state, friction, pull, left)) <= 1e-12 {
                break;
            }
            let (mut low, mut high) = (0.0, left);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if over(&advance(state, friction, pull, middle)) > 1e-12 {
                    high = middle
                } else {
                    low = middle
                }
            }
            state = advance(state, friction, pull, high);
            left -= high;
            let spring = SPRING * (state.x[1] - state.x[0]);
            state.v[0] = 0.0;
            friction = (spring.abs() >= LIMIT).then(|| -LIMIT * spring.signum());
        }
        state = advance(state, friction, pull, left);
        states.push(state);
    }
    states
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut scene = Scene::new(DT, Beta2::trapezoidal());
    let height = 0.01;
    // E A/L = 1e4 and 10 kg on four nodes, with a thickness of 1 m.
    let half = 0.5 * height;
    let nodes = vec![[0.0, 0.0], [1.0, half], [1.0, half + height], [0.0, height]];
    let builder = FlexBodyBuilder::cells(nodes, CellKind::Tri3, &[[0, 1, 2], [0, 2, 3]])
        .small_strain()
        .material(LinearElastic::plane_stress(SPRING / height, 0.0).density(2.0 * MASS / height))
        .contact_inertia(ContactInertia::Kept)
        .friction(0.3)
        .pin_where(|[_, y]| y > 0.0, Pin::y());
    let body = scene.add(builder)?;
    scene.ground(0.3);
    scene.step()?;
    scene.bodies[body].set_nodal_force(0, [0.0, -NORMAL])?;
    scene.step()?;
    let n = sheet.n_steps((END / DT) as usize);
    let mut ours = Vec::new();
    for step in 0..n {
        let pull = if (step as f64 + 0.5) * DT < RELEASE {
            PULL
        } else {
            0.0
        };
        for node in [1, 2] {
            scene.bodies[body].set_nodal_force(node, [0.5 * pull, 0.0])?;
        }
        scene.step()?;
        let body = scene.body(body);
        ours.push([[0, 3], [1, 2]].map(|pair| {
            0.5 * pair
                .map(|node| body.displacement(node)[0])
                .iter()
                .sum::<f64>()
        }));
    }
    let exact = exact(n);
    let largest = exact.iter().fold(0.0f64, |a, s| a.max(s.x[1].abs()));
    for (k, name) in ["left", "right"].into_iter().enumerate() {
        let worst = ours
            .iter()
            .zip(&exact)
            .fold(0.0f64, |a, (x, s)| a.max((x[k] - s.x[k]).abs()));
        sheet.absolute(
            format!("largest error of the {name} mass, of the largest way (-)"),
            0.0,
            worst / largest,
            1e-3,
        );
    }
    let last = exact.last().copied().unwrap_or_default();
    sheet.relative(
        "where the left mass is at 0.5 s (m)",
        last.x[0],
        ours.last().map_or(f64::NAN, |x| x[0]),
        2e-3,
    );
    let at = |k: usize| (k + 1) as f64 * DT;
    let mut figure = Figure::new(
        "b19_motion",
        "B19: stick–slip oscillator",
        ["time (s)", "displacement (m)"],
    );
    for (k, name) in ["left", "right"].into_iter().enumerate() {
        let curve = exact
            .iter()
            .enumerate()
            .map(|(i, s)| [at(i), s.x[k]])
            .collect();
        figure = figure.exact(&format!("exact, {name} mass"), curve);
        let dots = ours
            .iter()
            .enumerate()
            .step_by(200)
            .map(|(i, x)| [at(i), x[k]])
            .collect();
        figure = figure.dots(&format!("{name} mass"), dots);
    }
    sheet.figure(figure);
    Ok(())
}
