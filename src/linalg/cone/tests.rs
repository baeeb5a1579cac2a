use super::*;
use crate::linalg::block_matrix::BlockMatrix;

/// Bodies of two nodes, `(x, y)` and `(angle, unused)`, and meshes of springs, with rows between them.
#[derive(Clone)]
struct Scene {
    matrix: BlockMatrix,
    load: Vec<f64>,
    rows: Vec<ConeRow>,
    entries: Vec<ConeEntry>,
}

/// `(node, normal, tangent)`.
type Grip = (usize, [f64; 2], [f64; 2]);

impl Scene {
    /// Rigid bodies, `[mass, inertia]` each.
    fn bodies(masses: &[[f64; 2]]) -> Self {
        let n_nodes = 2 * masses.len();
        let cells: Vec<[usize; 1]> = (0..n_nodes).map(|node| [node]).collect();
        let mut matrix = BlockMatrix::from_cells(n_nodes, cells.iter().map(|cell| &cell[..]));
        for (body, &[mass, inertia]) in masses.iter().enumerate() {
            matrix.add_diagonal(2 * body, [mass, mass]);
            matrix.add_diagonal(2 * body + 1, [inertia, 1.0]);
        }
        Self {
            load: vec![0.0; matrix.n_dofs()],
            matrix,
            rows: Vec::new(),
            entries: Vec::new(),
        }
    }

    fn row(
        &mut self,
        law: ConeLaw,
        free: [f64; 2],
        scale: [f64; 2],
        grips: &[Grip],
    ) -> &mut ConeRow {
        let start = self.entries.len() as u32;
        self.entries
            .extend(grips.iter().map(|&(node, normal, tangent)| ConeEntry {
                node: node as u32,
                normal,
                tangent,
            }));
        let entries = (start, self.entries.len() as u32);
        self.rows.push(ConeRow {
            entries,
            law,
            free,
            give: [0.0; 2],
            acted: [0.0; 2],
            scale,
        });
        let last = self.rows.len() - 1;
        &mut self.rows[last]
    }

    /// The grips of a point with lever `arm` on a rigid body.
    fn grips(body: usize, sign: f64, normal: [f64; 2], arm: [f64; 2]) -> [Grip; 2] {
        let tangent = [-normal[1], normal[0]];
        let turn = |axis: [f64; 2]| sign * (arm[0] * axis[1] - arm[1] * axis[0]);
        [
            (
                2 * body,
                normal.map(|x| sign * x),
                tangent.map(|x| sign * x),
            ),
            (2 * body + 1, [turn(normal), 0.0], [turn(tangent), 0.0]),
        ]
    }

    fn problem(&self) -> ConeProblem<'_> {
        ConeProblem {
            matrix: &self.matrix,
            load: &self.load,
            rows: &self.rows,
            entries: &self.entries,
        }
    }

    /// `scale` by the diagonal of `A` alone, exact for rigid bodies.
    fn estimate(&mut self) {
        for row in &mut self.rows {
            row.scale = [0.0; 2];
            for entry in &self.entries[row.entries.0 as usize..row.entries.1 as usize] {
                let Some(block) = self.matrix.block(entry.node as usize, entry.node as usize)
                else {
                    continue;
                };
                for k in 0..2 {
                    row.scale[0] += entry.normal[k].powi(2) / block[3 * k];
                    row.scale[1] += entry.tangent[k].powi(2) / block[3 * k];
                }
            }
        }
    }
}

struct Answer {
    p: Vec<[f64; 2]>,
    slip: Vec<f64>,
    a: Vec<f64>,
    outcome: ConeOutcome,
}

fn solve_with(solver: &mut ConeSolver, scene: &Scene, p: &[[f64; 2]], slip: &[f64]) -> Answer {
    let (mut p, mut slip, mut a) = (p.to_vec(), slip.to_vec(), Vec::new());
    let outcome = solver
        .solve(&scene.problem(), &mut p, &mut slip, &mut a)
        .expect("valid data");
    Answer {
        p,
        slip,
        a,
        outcome,
    }
}

fn solve(scene: &Scene) -> Answer {
    let n = scene.rows.len();
    let settings = ConeSettings {
        slip_tolerance: 0.0,
        ..ConeSettings::default()
    };
    solve_with(
        &mut ConeSolver::new(settings),
        scene,
        &vec![[0.0; 2]; n],
        &vec![0.0; n],
    )
}

fn motion(scene: &Scene, answer: &Answer, index: usize) -> [f64; 2] {
    let row = &scene.rows[index];
    let mut w = [0, 1].map(|k| row.free[k] + row.give[k] * answer.p[index][k]);
    for entry in &scene.entries[row.entries.0 as usize..row.entries.1 as usize] {
        let dofs = &answer.a[2 * entry.node as usize..][..2];
        w[0] += entry.normal[0] * dofs[0] + entry.normal[1] * dofs[1];
        w[1] += entry.tangent[0] * dofs[0] + entry.tangent[1] * dofs[1];
    }
    w
}

/// Signorini's and Coulomb's laws, read from the page and not from the solver: the largest violation as a force,
/// `sqrt(W) |p - proj(p - w/W)|` with friction's bound from the present normal force, relative to the largest force; and
/// what is missing of `A a = r + Gᵀ p`, relative to its largest term.
fn violation(scene: &Scene, answer: &Answer) -> (f64, f64) {
    let (mut worst, mut size) = (0.0_f64, 1e-300_f64);
    let mut balance = scene.load.clone();
    let mut largest = scene
        .load
        .iter()
        .fold(1e-300_f64, |most, value| most.max(value.abs()));
    for (index, row) in scene.rows.iter().enumerate() {
        let w = motion(scene, answer, index);
        let total = [0, 1].map(|k| answer.p[index][k] + row.acted[k]);
        let [normal, tangential] = [0, 1].map(|k| row.scale[k] + row.give[k]);
        let step = total[0] - w[0] / normal;
        let mut term = match row.law {
            ConeLaw::Bilateral => (w[0] / normal).abs(),
            ConeLaw::Unilateral | ConeLaw::Contact { .. } => (total[0] - step.max(0.0)).abs(),
            ConeLaw::Box { low, high } => (total[0] - step.max(low).min(high)).abs(),
        } * normal.sqrt();
        if let ConeLaw::Contact { friction } = row.law {
            let bound = friction * total[0].max(0.0);
            let step = total[1] - w[1] / tangential;
            term = term.max((total[1] - step.max(-bound).min(bound)).abs() * tangential.sqrt());
        } else {
            assert_eq!(
                total[1], row.acted[1],
                "rows of one component have no second force"
            );
        }
        worst = worst.max(term);
        size = size.max(normal.sqrt() * total[0].abs());
        for entry in &scene.entries[row.entries.0 as usize..row.entries.1 as usize] {
            for k in 0..2 {
                let force = entry.normal[k] * answer.p[index][0]
                    + if matches!(row.law, ConeLaw::Contact { .. }) {
                        entry.tangent[k] * answer.p[index][1]
                    } else {
                        0.0
                    };
                balance[2 * entry.node as usize + k] += force;
                largest = largest.max(force.abs());
            }
        }
    }
    // forces next to nothing are judged beside the load
    let loads = (0..scene.load.len()).map(|dof| {
        let diagonal = scene
            .matrix
            .block(dof / 2, dof / 2)
            .map_or(1.0, |block| block[3 * (dof % 2)]);
        scene.load[dof].abs() / diagonal.sqrt()
    });
    size = loads.fold(size, |size, load| size.max(1e-3 * load));
    let mut product = vec![0.0; balance.len()];
    scene.matrix.multiply(&answer.a, &mut product);
    let missing = balance
        .iter()
        .zip(&product)
        .fold(0.0_f64, |most, (want, have)| most.max((want - have).abs()));
    (worst / size, missing / largest)
}

/// A box of width 2 and height 1 on two points of the ground, pushed sideways.
fn block_on_plane(weight: f64, push: f64, friction: f64, heights: [f64; 2]) -> Scene {
    let mut scene = Scene::bodies(&[[2.0, 1.0]]);
    scene.load[0] = push;
    scene.load[1] = -weight;
    for (arm, height) in [-1.0, 1.0].into_iter().zip(heights) {
        // tangent of the upward normal points left
        let grips = Scene::grips(0, 1.0, [0.0, 1.0], [arm, -0.5]);
        scene.row(
            ConeLaw::Contact { friction },
            [height, 0.0],
            [1.0; 2],
            &grips,
        );
    }
    scene.estimate();
    scene
}

#[test]
fn a_block_sticks_with_the_push_shared_and_the_moment_balanced() {
    let scene = block_on_plane(10.0, 3.0, 0.5, [0.0; 2]);
    let answer = solve(&scene);
    assert!(answer.outcome.is_solved);
    // moment of the push about the ground: 3 × 0.5 = 2 × 1 × difference / 2
    assert!(
        (answer.p[0][0] - 4.25).abs() < 1e-8 && (answer.p[1][0] - 5.75).abs() < 1e-8,
        "{:?}",
        answer.p
    );
    assert!((answer.p[0][1] + answer.p[1][1] - 3.0).abs() < 1e-8);
    assert!(answer.a.iter().all(|a| a.abs() < 1e-8));
}

#[test]
fn a_block_slides_at_the_friction_left_over_and_without_a_gap() {
    let scene = block_on_plane(10.0, 7.0, 0.5, [0.0; 2]);
    let answer = solve(&scene);
    assert!(answer.outcome.is_solved, "{:?}", answer.outcome);
    assert!((answer.a[0] - 1.0).abs() < 1e-8, "(7 - 0.5 10) / 2");
    assert!((0..2).all(|row| motion(&scene, &answer, row)[0].abs() < 1e-8));
    let [p, q] = [answer.p[0], answer.p[1]];
    assert!((p[1] - 0.5 * p[0]).abs() < 1e-8 && (q[1] - 0.5 * q[0]).abs() < 1e-8);
}

#[test]
fn a_block_that_is_pulled_up_carries_nothing() {
    let answer = solve(&block_on_plane(-1.0, 2.0, 0.5, [0.0; 2]));
    assert_eq!(answer.p, [[0.0; 2]; 2]);
    assert!((answer.a[0] - 1.0).abs() < 1e-14 && (answer.a[1] - 0.5).abs() < 1e-14);
    assert_eq!(answer.outcome.n_factorizations, 0);
}

#[test]
fn a_block_tips_over_the_edge_that_it_is_pushed_to() {
    // the moment of the push exceeds that of the weight
    let scene = block_on_plane(1.0, 40.0, 100.0, [0.0; 2]);
    let answer = solve(&scene);
    assert_eq!(answer.p[0], [0.0; 2]);
    assert!(answer.p[1][0] > 0.0 && answer.a[2] < 0.0);
    assert!(violation(&scene, &answer).0 < 1e-8);
}

#[test]
fn without_friction_a_contact_is_a_stop() {
    let scene = block_on_plane(10.0, 4.0, 0.0, [0.0; 2]);
    let answer = solve(&scene);
    assert!((answer.a[0] - 2.0).abs() < 1e-10 && answer.a[1].abs() < 1e-8);
    assert!(answer.p.iter().all(|p| p[1] == 0.0));
}

/// Small deterministic pseudo-random numbers.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A few bodies with contacts of random place and direction, on the ground and with each other.
fn random_contacts(
    random: &mut Random,
    n_bodies: usize,
    n_contacts: usize,
    friction: f64,
) -> Scene {
    let masses: Vec<[f64; 2]> = (0..n_bodies)
        .map(|_| [random.within(0.5, 2.0), random.within(0.2, 1.0)])
        .collect();
    let mut scene = Scene::bodies(&masses);
    for body in 0..n_bodies {
        for dof in 4 * body..4 * body + 3 {
            scene.load[dof] = random.within(-3.0, 3.0);
        }
        scene.load[4 * body + 1] -= 6.0;
    }
    for contact in 0..n_contacts {
        let body = contact % n_bodies;
        let turn = random.within(-0.6, 0.6);
        let normal = [turn.sin(), turn.cos()];
        let mut grips = Scene::grips(
            body,
            1.0,
            normal,
            [random.within(-1.0, 1.0), random.within(-1.0, -0.3)],
        )
        .to_vec();
        let other = (random.next() * (n_bodies + 1) as f64) as usize;
        if other < body {
            grips.extend(Scene::grips(
                other,
                -1.0,
                normal,
                [random.within(-1.0, 1.0), random.within(0.3, 1.0)],
            ));
        }
        let free = [random.within(-0.5, 1.0), random.within(-1.0, 1.0)];
        scene.row(ConeLaw::Contact { friction }, free, [1.0; 2], &grips);
    }
    scene.estimate();
    scene
}

/// Solves for one choice of statuses (0 open, 1 stick, 2 and 3 slip) by dense elimination, if it can be.
fn solve_statuses(scene: &Scene, choice: &[usize]) -> Option<Vec<[f64; 2]>> {
    let n = choice.len();
    let unit = |index: usize| -> Answer {
        let mut p = vec![[0.0; 2]; n];
        if index < 2 * n {
            p[index / 2][index % 2] = 1.0;
        }
        let mut a = if index < 2 * n {
            vec![0.0; scene.load.len()]
        } else {
            scene.load.clone()
        };
        for (row, p) in scene.rows.iter().zip(&p) {
            scene.problem().push(row, 1.0, *p, &mut a);
        }
        for (dof, a) in a.iter_mut().enumerate() {
            *a /= scene
                .matrix
                .block(dof / 2, dof / 2)
                .map_or(1.0, |block| block[3 * (dof % 2)]);
        }
        Answer {
            p: vec![[0.0; 2]; n],
            slip: Vec::new(),
            a,
            outcome: ConeOutcome::default(),
        }
    };
    let free: Vec<[f64; 2]> = {
        let answer = unit(2 * n);
        (0..n).map(|row| motion(scene, &answer, row)).collect()
    };
    let mut system = nalgebra::DMatrix::zeros(2 * n, 2 * n);
    let mut right = nalgebra::DVector::zeros(2 * n);
    for row in 0..n {
        let mu = scene.rows[row].friction();
        let is_open = choice[row] == 0;
        let slips = [0.0, 0.0, 1.0, -1.0][choice[row]];
        if is_open {
            system[(2 * row, 2 * row)] = 1.0;
            system[(2 * row + 1, 2 * row + 1)] = 1.0;
            continue;
        }
        for column in 0..2 * n {
            let answer = unit(column);
            let w = motion(scene, &answer, row)
                .iter()
                .zip(scene.rows[row].free)
                .map(|(w, free)| w - free)
                .collect::<Vec<_>>();
            system[(2 * row, column)] = w[0];
            if choice[row] == 1 {
                system[(2 * row + 1, column)] = w[1];
            }
        }
        right[2 * row] = -free[row][0];
        if choice[row] == 1 {
            right[2 * row + 1] = -free[row][1];
        } else {
            system[(2 * row + 1, 2 * row + 1)] = 1.0;
            system[(2 * row + 1, 2 * row)] = -slips * mu;
        }
    }
    let solution = system.lu().solve(&right)?;
    Some(
        (0..n)
            .map(|row| [solution[2 * row], solution[2 * row + 1]])
            .collect(),
    )
}

#[test]
fn small_problems_give_an_answer_that_enumeration_gives_too() {
    let mut random = Random(7);
    let (mut n_found, mut n_slipping) = (0, 0);
    for _ in 0..60 {
        let n = 2 + (random.next() * 2.0) as usize;
        let scene = random_contacts(&mut random, 3, n, 0.4);
        let answer = solve(&scene);
        assert!(answer.outcome.is_solved, "{:?}", answer.outcome);
        let mut nearest = f64::INFINITY;
        for code in 0..4usize.pow(n as u32) {
            let choice: Vec<usize> = (0..n)
                .map(|row| code / 4usize.pow(row as u32) % 4)
                .collect();
            let Some(p) = solve_statuses(&scene, &choice) else {
                continue;
            };
            let distance = p
                .iter()
                .zip(&answer.p)
                .flat_map(|(p, q)| [(p[0] - q[0]).abs(), (p[1] - q[1]).abs()])
                .fold(0.0, f64::max);
            if distance < nearest {
                nearest = distance;
                n_slipping += usize::from(choice.iter().any(|&status| status > 1));
            }
        }
        assert!(violation(&scene, &answer).0 < 1e-7);
        n_found += usize::from(nearest < 1e-7);
    }
    assert_eq!(n_found, 60);
    assert!(
        n_slipping > 20,
        "{n_slipping} of the problems slip somewhere"
    );
}

#[test]
fn random_problems_obey_the_laws() {
    let mut counts = [0; 3];
    let (mut work, mut worst_solved) = (0, 0.0_f64);
    for seed in 0..500 {
        let mut random = Random(1000 + seed);
        let n_bodies = 2 + (random.next() * 6.0) as usize;
        let friction = [0.0, 0.2, 0.5, 1.0][seed as usize % 4];
        let mut scene = random_contacts(&mut random, n_bodies, 2 * n_bodies, friction);
        for body in 0..n_bodies {
            // a joint to the next body, a motor and a stop
            if seed % 3 == 0 && body + 1 < n_bodies && body % 3 == 0 {
                for axis in [[1.0, 0.0], [0.0, 1.0]] {
                    let mut grips = Scene::grips(body, 1.0, axis, [0.7, 0.1]).to_vec();
                    grips.extend(Scene::grips(body + 1, -1.0, axis, [-0.7, 0.2]));
                    scene.row(
                        ConeLaw::Bilateral,
                        [random.within(-0.01, 0.01), 0.0],
                        [1.0; 2],
                        &grips,
                    );
                }
                scene.row(
                    ConeLaw::Box {
                        low: -0.4,
                        high: 0.8,
                    },
                    [random.within(-1.0, 1.0), 0.0],
                    [1.0; 2],
                    &[(2 * body + 1, [1.0, 0.0], [0.0; 2])],
                );
                scene.row(
                    ConeLaw::Unilateral,
                    [random.within(-0.5, 0.5), 0.0],
                    [1.0; 2],
                    &[(2 * body, [0.6, 0.8], [0.0; 2])],
                );
            }
        }
        scene.estimate();
        let answer = solve(&scene);
        let (violated, missing) = violation(&scene, &answer);
        assert!(missing < 1e-12, "seed {seed}: balance {missing:e}");
        assert!(answer.p.iter().flatten().all(|p| p.is_finite()));
        counts[0] += usize::from(answer.outcome.is_solved);
        counts[1] += usize::from(violated < 1e-7);
        counts[2] += usize::from(answer.outcome.used_interior_point);
        if answer.outcome.is_solved {
            worst_solved = worst_solved.max(violated);
        }
        work += answer.outcome.n_factorizations;
    }
    // random normals wedge bodies: some have no answer, or several, between which slips wander
    assert!(counts[0] >= 495 && counts[1] >= 495, "{counts:?}");
    assert!(worst_solved < 1e-7, "{worst_solved:e}");
    assert!(
        work < 9000,
        "{work} factorizations, {} with the interior point",
        counts[2]
    );
}

/// `columns × rows` unit boxes with two contacts on every face that touches; the lowest stand on the ground.
fn pile(n_columns: usize, n_rows: usize, mass: impl Fn(usize) -> f64, disturb: f64) -> Scene {
    let n = n_columns * n_rows;
    let masses: Vec<[f64; 2]> = (0..n)
        .map(|body| {
            let m = mass(body / n_columns);
            [m, m / 6.0]
        })
        .collect();
    let mut scene = Scene::bodies(&masses);
    let mut random = Random(3);
    for body in 0..n {
        scene.load[4 * body + 1] = -9.81 * masses[body][0];
        for dof in 4 * body..4 * body + 3 {
            scene.load[dof] += disturb * 9.81 * masses[body][0] * random.within(-1.0, 1.0);
        }
    }
    let mut touch = |upper: usize, lower: Option<usize>, normal: [f64; 2]| {
        let tangent = [-normal[1], normal[0]];
        for side in [-0.5, 0.5] {
            let arm = |half: f64| [0, 1].map(|k| half * normal[k] + side * tangent[k]);
            let mut grips = Scene::grips(upper, 1.0, normal, arm(-0.5)).to_vec();
            if let Some(lower) = lower {
                grips.extend(Scene::grips(lower, -1.0, normal, arm(0.5)));
            }
            scene.row(
                ConeLaw::Contact { friction: 0.5 },
                [0.0; 2],
                [1.0; 2],
                &grips,
            );
        }
    };
    for body in 0..n {
        touch(body, body.checked_sub(n_columns), [0.0, 1.0]);
        if body % n_columns > 0 {
            touch(body, Some(body - 1), [1.0, 0.0]);
        }
    }
    scene.estimate();
    scene
}

/// The force of the ground on everything.
fn ground_force(scene: &Scene, answer: &Answer) -> f64 {
    let on_ground = scene
        .rows
        .iter()
        .zip(&answer.p)
        .filter(|(row, _)| row.entries.1 - row.entries.0 == 2);
    on_ground.map(|(_, p)| p[0]).sum()
}

#[test]
fn a_pile_of_a_hundred_rests_on_its_weight_and_costs_nothing_twice() {
    let scene = pile(10, 10, |_| 1.0, 0.0);
    let mut solver = ConeSolver::default();
    let n = scene.rows.len();
    let first = solve_with(&mut solver, &scene, &vec![[0.0; 2]; n], &vec![0.0; n]);
    assert!(first.outcome.is_solved && first.outcome.residual <= 1e-8);
    assert!((ground_force(&scene, &first) / 981.0 - 1.0).abs() < 1e-8);
    assert!(first.outcome.n_factorizations <= 40);
    let again = solve_with(&mut solver, &scene, &first.p, &first.slip);
    assert!(
        again.outcome.is_solved
            && again.outcome.n_factorizations <= 1
            && again.outcome.n_analyses == 0
    );
    // redundant rows keep what they carry
    let moved = again
        .p
        .iter()
        .zip(&first.p)
        .flat_map(|(p, q)| [p[0] - q[0], p[1] - q[1]])
        .fold(0.0_f64, |most, d| most.max(d.abs()));
    assert!(moved < 1e-6, "{moved:e}");
}

#[test]
fn a_disturbed_pile_is_solved_within_its_budget() {
    for disturb in [0.1, 0.5, 1.0, 2.0] {
        let scene = pile(10, 10, |_| 1.0, disturb);
        let n = scene.rows.len();
        // a gap of 1e-3 beside accelerations of 10
        let settings = ConeSettings {
            tolerance: 1e-8,
            gap_tolerance: 1e-3,
            ..ConeSettings::default()
        };
        let answer = solve_with(
            &mut ConeSolver::new(settings),
            &scene,
            &vec![[0.0; 2]; n],
            &vec![0.0; n],
        );
        assert!(
            answer.outcome.is_solved && answer.outcome.n_factorizations <= 100,
            "{disturb}: {:?}",
            answer.outcome
        );
        assert!(violation(&scene, &answer).1 < 1e-12);
    }
}

#[test]
fn a_heavy_top_is_carried() {
    for disturb in [0.0, 0.5] {
        let scene = pile(5, 6, |layer| if layer == 5 { 1000.0 } else { 1.0 }, disturb);
        let answer = solve(&scene);
        assert!(answer.outcome.is_solved);
        assert!(violation(&scene, &answer).1 < 1e-12);
    }
}

/// Run by hand, in release: times of piles in motion and at rest.
#[test]
#[ignore = "prints times"]
fn times() {
    for (columns, rows) in [(10, 10), (20, 50)] {
        let mut solver = ConeSolver::new(ConeSettings {
            tolerance: 1e-6,
            gap_tolerance: 1e-2,
            ..ConeSettings::default()
        });
        let n = pile(columns, rows, |_| 1.0, 0.0).rows.len();
        let (mut p, mut slip) = (vec![[0.0; 2]; n], vec![0.0; n]);
        for disturb in [0.0, 0.0, 0.1, 0.11, 0.12, 0.5, 0.55, 0.6, 1.0, 0.0, 0.0] {
            let scene = pile(columns, rows, |_| 1.0, disturb);
            let start = std::time::Instant::now();
            let answer = solve_with(&mut solver, &scene, &p, &slip);
            let o = answer.outcome;
            println!(
                "{:5} boxes {n} rows disturb {disturb:4} {:9.1} us factorizations {:3} analyses {} residual {:.1e} dilation {:.1e} solved {} interior {}",
                columns * rows,
                start.elapsed().as_secs_f64() * 1e6,
                o.n_factorizations,
                o.n_analyses,
                o.residual,
                o.dilation,
                o.is_solved,
                o.used_interior_point
            );
            (p, slip) = (answer.p, answer.slip);
        }
    }
}

#[test]
fn redundant_contacts_keep_what_they_carry() {
    let mut scene = Scene::bodies(&[[3.0, 1.0]]);
    scene.load[1] = -12.0;
    for k in 0..8 {
        scene.row(
            ConeLaw::Contact { friction: 0.6 },
            [0.0; 2],
            [1.0; 2],
            &Scene::grips(0, 1.0, [0.0, 1.0], [k as f64 - 3.5, -0.5]),
        );
    }
    scene.estimate();
    // any division that carries the weight without a moment is a solution, friction against itself included
    let carried = [
        [3.0, 0.4],
        [0.0, 0.0],
        [2.0, -0.3],
        [1.0, -0.1],
        [1.0, 0.0],
        [2.0, 0.5],
        [0.0, 0.0],
        [3.0, -0.5],
    ];
    let answer = solve_with(&mut ConeSolver::default(), &scene, &carried, &[0.0; 8]);
    assert!(answer.outcome.is_solved && answer.outcome.n_factorizations == 0);
    assert!(
        answer
            .p
            .iter()
            .zip(carried)
            .all(|(p, q)| (p[0] - q[0]).abs() + (p[1] - q[1]).abs() < 1e-12)
    );
}

/// Bodies in a line, each tied to the one before and the first to the world, in both directions.
fn chain(n_links: usize) -> Scene {
    let mut scene = Scene::bodies(&vec![[1.0, 0.1]; n_links]);
    for link in 0..n_links {
        scene.load[4 * link + 1] = -10.0;
        for axis in [[1.0, 0.0], [0.0, 1.0]] {
            let mut grips = Scene::grips(link, 1.0, axis, [0.0, 0.5]).to_vec();
            if link > 0 {
                grips.extend(Scene::grips(link - 1, -1.0, axis, [0.0, -0.5]));
            }
            scene.row(ConeLaw::Bilateral, [0.0; 2], [1.0; 2], &grips);
        }
    }
    scene.estimate();
    scene
}

#[test]
fn a_hanging_chain_carries_the_weight_below_every_joint() {
    let scene = chain(100);
    let answer = solve(&scene);
    assert!(
        answer.outcome.is_solved && answer.outcome.n_factorizations <= 3,
        "{:?}",
        answer.outcome
    );
    for link in 0..100 {
        let weight = 10.0 * (100 - link) as f64;
        // the softest mode of the chain magnifies a residual of 1e-9 a few thousand times
        assert!(
            (answer.p[2 * link + 1][0] - weight).abs() < 1e-2 && answer.p[2 * link][0].abs() < 1e-5
        );
    }
    assert!(answer.a.iter().all(|a| a.abs() < 1e-4));
}

#[test]
fn ties_that_contradict_each_other_end_in_a_compromise_and_say_so() {
    let mut scene = Scene::bodies(&[[1.0, 1.0]]);
    for free in [-1.0, 2.0] {
        scene.row(
            ConeLaw::Bilateral,
            [free, 0.0],
            [1.0; 2],
            &[(0, [1.0, 0.0], [0.0; 2])],
        );
    }
    scene.estimate();
    let answer = solve(&scene);
    assert!(!answer.outcome.is_solved && answer.outcome.residual > 0.0);
    // half way between the two
    assert!((answer.a[0] + 0.5).abs() < 1e-3, "{:?}", answer.a);
    assert!(answer.p.iter().flatten().all(|p| p.is_finite()));
    assert!(violation(&scene, &answer).1 < 1e-12);
}

#[test]
fn a_motor_pushes_up_to_its_bound() {
    // wanted: a = 5; what it takes: 10
    for (high, expected) in [(4.0, 4.0), (f64::INFINITY, 10.0), (0.0, 0.0)] {
        let mut scene = Scene::bodies(&[[2.0, 1.0]]);
        scene.row(
            ConeLaw::Box { low: -1.0, high },
            [-5.0, 0.0],
            [0.5; 2],
            &[(0, [1.0, 0.0], [0.0; 2])],
        );
        let answer = solve(&scene);
        assert!(
            (answer.p[0][0] - expected).abs() < 1e-8 && answer.outcome.is_solved,
            "{high}: {:?}",
            answer.p
        );
        assert!((answer.a[0] - expected / 2.0).abs() < 1e-8);
    }
}

#[test]
fn give_is_a_spring_in_series_and_acted_forces_count() {
    for acted in [0.0, 1.5] {
        let mut scene = Scene::bodies(&[[2.0, 1.0]]);
        scene.load[1] = -6.0 + acted;
        let row = scene.row(
            ConeLaw::Contact { friction: 0.5 },
            [-1.0, 0.2],
            [0.5; 2],
            &[(0, [0.0, 1.0], [1.0, 0.0])],
        );
        row.give = [0.25, 0.75];
        row.acted = [acted, 0.0];
        let answer = solve(&scene);
        // 0 = -1 + (p + load)/2 + p/4 and 0 = 0.2 + q/2 + 3 q/4
        let p = (1.0 - scene.load[1] / 2.0) / 0.75;
        assert!(
            (answer.p[0][0] - p).abs() < 1e-8 && (answer.p[0][1] + 0.16).abs() < 1e-8,
            "{:?} {p}",
            answer.p
        );
        assert!(violation(&scene, &answer).0 < 1e-8);
    }
    // what acted already may be taken back, but the whole never pulls
    let mut scene = block_on_plane(-1.0, 0.0, 0.5, [0.0; 2]);
    scene.rows.iter_mut().for_each(|row| row.acted = [2.0, 0.5]);
    let answer = solve(&scene);
    assert!(
        violation(&scene, &answer).0 < 1e-8 && answer.p.iter().all(|p| p[0] < 0.0 && p[0] >= -2.0)
    );
}

#[test]
fn units_do_not_matter() {
    // masses in milligrams, lengths in millimetres: forces and slips scale, nothing else happens
    let (mass, length) = (1e6, 1e-3);
    for seed in 0..20 {
        let scene = random_contacts(&mut Random(seed), 3, 4, 0.3);
        let mut scaled = scene.clone();
        scaled.matrix.assign_scaled(mass, &scene.matrix);
        scaled
            .load
            .iter_mut()
            .for_each(|load| *load *= mass * length);
        for row in &mut scaled.rows {
            row.free = row.free.map(|free| free * length);
            row.scale = row.scale.map(|scale| scale / mass);
        }
        let (one, other) = (solve(&scene), solve(&scaled));
        assert!(one.outcome.is_solved == other.outcome.is_solved);
        for (p, q) in one.a.iter().zip(&other.a) {
            assert!(
                (p - q / length).abs() < 1e-6,
                "seed {seed}: {p} {}",
                q / length
            );
        }
    }
}

#[test]
fn data_that_states_no_problem_is_told_and_changes_nothing() {
    let scene = block_on_plane(10.0, 3.0, 0.5, [0.0; 2]);
    let spoil: [fn(&mut Scene); 6] = [
        |scene| scene.load[1] = f64::NAN,
        |scene| scene.rows[1].free[0] = f64::INFINITY,
        |scene| scene.rows[0].scale[1] = -1.0,
        |scene| scene.entries[2].node = 7,
        |scene| scene.rows[0].law = ConeLaw::Contact { friction: -0.1 },
        |scene| {
            scene.rows[0].law = ConeLaw::Box {
                low: 1.0,
                high: 2.0,
            }
        },
    ];
    for spoil in spoil {
        let mut bad = scene.clone();
        spoil(&mut bad);
        let (mut p, mut slip, mut a) = ([[1.0; 2]; 2], [2.0; 2], vec![3.0]);
        assert!(
            ConeSolver::default()
                .solve(&bad.problem(), &mut p, &mut slip, &mut a)
                .is_err()
        );
        assert_eq!((p, slip, a), ([[1.0; 2]; 2], [2.0; 2], vec![3.0]));
    }
    let outcome = ConeSolver::default().solve(
        &scene.problem(),
        &mut [[0.0; 2]; 1],
        &mut [0.0; 2],
        &mut Vec::new(),
    );
    assert!(matches!(
        outcome,
        Err(ConeError::Length {
            found: 1,
            expected: 2,
            ..
        })
    ));
}

#[test]
fn a_soft_block_rests_and_slides_on_the_nodes_of_its_edge() {
    // a lattice of springs with its mass in the nodes, pressed on the ground and pulled sideways
    let (wide, high) = (12, 5);
    let at = |i: usize, j: usize| i + wide * j;
    let mut cells: Vec<[usize; 2]> = Vec::new();
    for j in 0..high {
        for i in 0..wide {
            let reach = [(1, 0), (0, 1), (1, 1)];
            cells.extend(
                reach
                    .iter()
                    .filter(|(x, y)| i + x < wide && j + y < high)
                    .map(|(x, y)| [at(i, j), at(i + x, j + y)]),
            );
        }
    }
    let mut matrix = BlockMatrix::from_cells(wide * high, cells.iter().map(|cell| &cell[..]));
    for cell in &cells {
        let (dx, dy) = (
            (cell[1] % wide) as f64 - (cell[0] % wide) as f64,
            (cell[1] / wide) as f64 - (cell[0] / wide) as f64,
        );
        let along = [-dx, -dy, dx, dy].map(|x| x / (dx * dx + dy * dy).sqrt());
        let spring: Vec<f64> = along
            .iter()
            .flat_map(|a| along.iter().map(move |b| 300.0 * a * b))
            .collect();
        matrix.add_cell(cell, &spring);
    }
    let n_nodes = wide * high;
    (0..n_nodes).for_each(|node| matrix.add_diagonal(node, [1.0; 2]));
    for (pull, friction) in [(0.3, 0.5), (0.9, 0.5)] {
        let load = (0..n_nodes).flat_map(|_| [pull * 10.0, -10.0]).collect();
        let mut scene = Scene {
            matrix: matrix.clone(),
            load,
            rows: Vec::new(),
            entries: Vec::new(),
        };
        for i in 0..wide {
            scene.row(
                ConeLaw::Contact { friction },
                [0.0; 2],
                [1.0; 2],
                &[(at(i, 0), [0.0, 1.0], [1.0, 0.0])],
            );
        }
        scene.estimate();
        let answer = solve(&scene);
        let (violated, missing) = violation(&scene, &answer);
        assert!(
            answer.outcome.is_solved && violated < 1e-7 && missing < 1e-11,
            "{:?} {violated:e} {missing:e}",
            answer.outcome
        );
        let total = answer
            .p
            .iter()
            .fold([0.0; 2], |sum, p| [sum[0] + p[0], sum[1] + p[1]]);
        if pull > friction {
            assert!(
                (total[1] + friction * total[0]).abs() < 1e-6 * total[0],
                "everything slides"
            );
        }
        assert!(
            answer.outcome.n_factorizations <= 40,
            "{:?}",
            answer.outcome
        );
    }
}

#[test]
fn a_pattern_that_covers_the_rows_is_kept() {
    let scene = pile(4, 4, |_| 1.0, 0.3);
    let mut fewer = scene.clone();
    fewer.rows.truncate(20);
    let mut solver = ConeSolver::default();
    let n = scene.rows.len();
    assert_eq!(
        solve_with(&mut solver, &scene, &vec![[0.0; 2]; n], &vec![0.0; n])
            .outcome
            .n_analyses,
        1
    );
    assert_eq!(
        solve_with(&mut solver, &fewer, &[[0.0; 2]; 20], &[0.0; 20])
            .outcome
            .n_analyses,
        0
    );
    assert_eq!(
        solve_with(&mut solver, &scene, &vec![[0.0; 2]; n], &vec![0.0; n])
            .outcome
            .n_analyses,
        0
    );
}

#[test]
fn a_spent_budget_obeys_the_bounds_and_the_balance() {
    let scene = pile(5, 5, |_| 1.0, 1.0);
    let n = scene.rows.len();
    let mut solver = ConeSolver::new(ConeSettings {
        max_factorizations: 2,
        ..ConeSettings::default()
    });
    let answer = solve_with(&mut solver, &scene, &vec![[0.0; 2]; n], &vec![0.0; n]);
    assert!(
        !answer.outcome.is_solved
            && answer.outcome.n_factorizations <= 2
            && answer.outcome.residual < 0.1,
        "{:?}",
        answer.outcome
    );
    assert!(
        answer
            .p
            .iter()
            .all(|p| p[0] >= 0.0 && p[1].abs() <= 0.5 * p[0] * (1.0 + 1e-12))
    );
    assert!(violation(&scene, &answer).1 < 1e-12);
}
