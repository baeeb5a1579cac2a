use super::*;
use crate::linalg::block_matrix::BlockMatrix;

mod blocks;
mod chains;
mod corrections;
mod piles;
mod random;
#[cfg(feature = "serde-serialize")]
mod remembered;
mod soft;

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
            local: f64::INFINITY,
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
    let outcome = match solver.solve(&scene.problem(), &mut p, &mut slip, &mut a) {
        Ok(outcome) => outcome,
        Err(error) => panic!("valid data: {error}"),
    };
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

#[test]
fn a_start_that_is_right_but_for_its_size_needs_no_factorization() {
    // A point of 4 kg that falls at 3 m/s and drifts at 1 m/s sticks to the ground.
    let mut mass = BlockMatrix::from_cells(1, [[0]].iter().map(|cell| &cell[..]));
    mass.add_diagonal(0, [4.0, 4.0]);
    let row = ConeRow {
        entries: (0, 1),
        law: ConeLaw::Contact { friction: 0.5 },
        free: [-3.0, 1.0],
        give: [0.0; 2],
        acted: [0.0; 2],
        scale: [0.25; 2],
        local: f64::INFINITY,
    };
    let entry = ConeEntry {
        node: 0,
        normal: [0.0, 1.0],
        tangent: [1.0, 0.0],
    };
    let problem = ConeProblem {
        matrix: &mass,
        load: &[0.0; 2],
        rows: &[row],
        entries: &[entry],
    };
    let mut solver = ConeSolver {
        scales_start: true,
        ..ConeSolver::default()
    };
    for size in [1e-3, 1.0, 1e4] {
        let mut impulses = [[3.0 * size, -size]];
        let outcome = solver.solve(&problem, &mut impulses, &mut [0.0], &mut Vec::new());
        assert!(
            outcome.is_ok_and(|outcome| outcome.is_solved && outcome.n_factorizations == 0),
            "{outcome:?}"
        );
        assert!((impulses[0][0] - 12.0).abs() < 1e-12 && (impulses[0][1] + 4.0).abs() < 1e-12);
    }
}

/// Two masses with a stiff spring between them, both tied to a third: each row would move all three far, and both together only the spring, next to nothing.
#[test]
fn what_is_tied_at_both_ends_of_something_stiff_finds_its_forces_in_two_steps() {
    let (mass, stiffness, [one, other]) = (1.0, 1e9, [2e-6, -1e-6]);
    let cells = [vec![0], vec![1, 2]];
    let mut matrix = BlockMatrix::from_cells(3, cells.iter().map(|cell| &cell[..]));
    for node in 0..3 {
        matrix.add_diagonal(node, [mass; 2]);
    }
    let mut spring = [0.0; 16];
    (spring[0], spring[2], spring[8], spring[10]) = (stiffness, -stiffness, -stiffness, stiffness);
    matrix.add_cell(&[1, 2], &spring);
    let mut scene = Scene {
        load: vec![0.0; matrix.n_dofs()],
        matrix,
        rows: Vec::new(),
        entries: Vec::new(),
    };
    let local = 1.0 / (mass + stiffness);
    for (node, apart) in [(1, one), (2, other)] {
        let grips = [(0, [-1.0, 0.0], [0.0; 2]), (node, [1.0, 0.0], [0.0; 2])];
        let row = scene.row(ConeLaw::Bilateral, [-apart, 0.0], [0.0; 2], &grips);
        // Of the rigid mass, and of the other two with the spring stiff.
        (row.scale, row.local) = ([1.5 / mass, 0.0], local);
    }
    let settings = ConeSettings {
        // As passes ask for: a motion, whatever force that leaves.
        gap_tolerance: 1e-8,
        ..ConeSettings::default()
    };
    let answer = solve_with(
        &mut ConeSolver::new(settings),
        &scene,
        &[[0.0; 2]; 2],
        &[0.0; 2],
    );
    // All momentum together is zero.
    let first = -(one + other) / 3.0;
    let exact = mass * (first + one) + stiffness * (one - other);
    assert!(
        (answer.p[0][0] / exact - 1.0).abs() < 1e-3,
        "{} of {exact}",
        answer.p[0][0]
    );
    assert!(answer.outcome.n_factorizations <= 2, "{:?}", answer.outcome);
}

/// A spring in series with something stiff gives way by all of its compliance: errors of `w` are forces by that.
#[test]
fn what_is_held_by_a_spring_is_as_soft_as_that() {
    let mut scene = Scene::bodies(&[[2.0, 1.0]]);
    let grips = Scene::grips(0, 1.0, [1.0, 0.0], [0.0, 0.0]);
    let row = scene.row(ConeLaw::Bilateral, [1.0, 0.0], [0.5; 2], &grips);
    row.local = 1e-6;
    let resistance = |scene: &Scene, give: f64| {
        let mut scene = scene.clone();
        scene.rows[0].give = [give, 0.0];
        let mut reduced = Reduced::default();
        reduced.restate(&scene.problem());
        reduced.resistance[0]
    };
    let is_near = |found: f64, exact: f64| (found / exact - 1.0).abs() < 1e-12;
    assert!(is_near(resistance(&scene, 0.0), 1e-4));
    assert!(is_near(resistance(&scene, 3.0), 3.0001));
    // Nothing is softer than all of what moves.
    scene.rows[0].local = 1.0;
    assert_eq!(resistance(&scene, 3.0), 3.5);
}
