use super::*;
use crate::fe::finite_strain::one_cell::{deformation_gradient, gather as gather_one};
use crate::fe::finite_strain::point::{invariants, stress};
use crate::fe::finite_strain::{
    Deformation, FiniteStrainDescription, FiniteStrainError, FiniteStrainModel,
};
use crate::fe::material::hyperelastic::{NeoHookean, StableNeoHookean};
use crate::fe::mesh::{CellKind, Mesh, generate::rectangle};
use crate::math::sin;

const KINDS: [CellKind; 4] = [
    CellKind::Tri3,
    CellKind::Quad4,
    CellKind::Tri6,
    CellKind::Quad8,
];
const FORM: Form = Form::EnergyMomentum { decay: 0.1 };

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn model(mesh: Mesh) -> Result<FiniteStrainModel, FiniteStrainError> {
    let law = NeoHookean::plane_strain(1e5, 0.3);
    let description = FiniteStrainDescription::new(mesh, law, 1000.0);
    FiniteStrainModel::assemble(description)
}

/// Positions moved by up to `size` (m), another way for every seed.
fn moved(model: &FiniteStrainModel, size: f64, seed: usize) -> Vec<f64> {
    let rest = model.rest_positions().iter().enumerate();
    rest.map(|(dof, x)| x + size * sin(78.233 * (dof + 1) as f64 + 4.1 * seed as f64))
        .collect()
}

fn step(model: &FiniteStrainModel, size: f64) -> (Deformation, Vec<f64>, Vec<f64>) {
    let (start, end) = (moved(model, size, 1), moved(model, size, 2));
    let mut deformation = model.deformation(&start);
    let mut force = vec![0.0; model.n_dofs()];
    let outcome = model.subtract_force(FORM, &end, &mut deformation, &mut force);
    assert_eq!(outcome, Ok(()));
    (deformation, end, force)
}

/// Numbers of cells that fill the lanes and that do not; forces of every point one by one.
#[test]
fn cells_side_by_side_have_the_forces_of_each_by_itself() -> Outcome {
    for kind in KINDS {
        for n in 1..6 {
            let model = model(rectangle([n as f64, 1.0], [n, 1], kind)?)?;
            let (deformation, end, force) = step(&model, 0.02);
            let mut expected = vec![0.0; model.n_dofs()];
            for group in &model.groups {
                assert!(group.guards.len() == 0 || !is_near_flat(&deformation));
                let law = group.solid.law.as_ref();
                for cell in 0..group.cells.len() {
                    let nodes = &group.nodes[cell * group.n_nodes..][..group.n_nodes];
                    for point in 0..group.n_points {
                        let place = cell * group.n_points + point;
                        let gradient = &group.gradients[place * group.n_nodes..][..group.n_nodes];
                        let at = |positions: &[f64]| {
                            let mut f = [0.0; 4];
                            for (&node, by) in nodes.iter().zip(gradient) {
                                for k in 0..4 {
                                    f[k] += positions[2 * node as usize + k / 2] * by[k % 2];
                                }
                            }
                            f
                        };
                        let p = stress(law, FORM, at(&moved(&model, 0.02, 1)), at(&end));
                        for (&node, by) in nodes.iter().zip(gradient) {
                            for k in 0..2 {
                                let own = p[2 * k] * by[0] + p[2 * k + 1] * by[1];
                                expected[2 * node as usize + k] -= group.volumes[place] * own;
                            }
                        }
                    }
                }
            }
            // Hourglass modes and smoothed areas are added to what the points say.
            let is_stiffened = matches!(kind, CellKind::Quad4 | CellKind::Quad8);
            for (found, expected) in force.iter().zip(&expected) {
                let size = 1e-11 * 1e5;
                assert!(
                    is_stiffened || (found - expected).abs() < size,
                    "{kind:?} {n}"
                );
            }
            assert!(force.iter().any(|force| force.abs() > 1.0));
        }
    }
    Ok(())
}

/// What a cell answers does not depend on who stands beside it: the same digits in any place.
#[test]
fn lanes_know_nothing_of_each_other() -> Outcome {
    for kind in KINDS {
        let whole = model(rectangle([5.0, 1.0], [5, 1], kind)?)?;
        let (_, _, force) = step(&whole, 0.02);
        let energy = whole.elastic_energy(&moved(&whole, 0.02, 2));
        let (mut sum, mut energies) = (vec![0.0; whole.n_dofs()], 0.0);
        let mesh = whole.mesh();
        let cells: Vec<_> = mesh.cells().map(|cell| cell.nodes.to_vec()).collect();
        for nodes in cells {
            let places = nodes.iter().map(|&node| mesh.nodes()[node]).collect();
            let numbers: Vec<usize> = (0..nodes.len()).collect();
            let own = Mesh::from_cells(places, kind, &[numbers]);
            let one = model(own?)?;
            let pick = |all: &[f64]| -> Vec<f64> {
                nodes
                    .iter()
                    .flat_map(|&node| [all[2 * node], all[2 * node + 1]])
                    .collect()
            };
            let (start, end) = (pick(&moved(&whole, 0.02, 1)), pick(&moved(&whole, 0.02, 2)));
            let mut deformation = one.deformation(&start);
            let mut own = vec![0.0; one.n_dofs()];
            let outcome = one.subtract_force(FORM, &end, &mut deformation, &mut own);
            assert_eq!(outcome, Ok(()));
            for (slot, &node) in nodes.iter().enumerate() {
                sum[2 * node] += own[2 * slot];
                sum[2 * node + 1] += own[2 * slot + 1];
            }
            energies += one.elastic_energy(&end);
        }
        // Hourglass modes and smoothed areas are added after all points: sums of another order.
        let most = if matches!(kind, CellKind::Quad4 | CellKind::Quad8) {
            1e-12 * 1e3
        } else {
            0.0
        };
        let mut pairs = sum.iter().zip(&force);
        assert!(
            pairs.all(|(sum, force)| (sum - force).abs() <= most),
            "{kind:?}"
        );
        assert!((energies - energy).abs() < 1e-12 * energy, "{kind:?}");
    }
    Ok(())
}

/// Flat places are found wherever they are, and nothing else is: against `det F` of every place.
#[test]
fn flat_places_are_those_of_little_area() -> Outcome {
    for kind in KINDS {
        let model = model(rectangle([5.0, 1.0], [5, 1], kind)?)?;
        let (mut n_flat, mut n_clear) = (0, 0);
        for (seed, size) in (0..200).zip([0.01, 0.05, 0.2, 0.4, 0.8].into_iter().cycle()) {
            let positions = moved(&model, size, seed);
            let deformation = model.deformation(&positions);
            for group in &model.groups {
                let found = &deformation.start.is_flat[group.flat_places()];
                for (cell, found) in found.iter().enumerate() {
                    let expected = match group.n_nodes {
                        4 => has_flat_place::<4>(group, cell, &positions),
                        6 => has_flat_place::<6>(group, cell, &positions),
                        8 => has_flat_place::<8>(group, cell, &positions),
                        _ => false,
                    };
                    assert_eq!(*found, expected, "{kind:?} {seed} {size}");
                    n_flat += usize::from(*found);
                    n_clear += usize::from(!*found);
                }
            }
        }
        assert!(
            n_clear > 100 && (n_flat > 20 || kind == CellKind::Tri3),
            "{kind:?}: {n_flat} flat, {n_clear} not"
        );
    }
    Ok(())
}

/// Where the law has an energy for what is turned, no place is guarded.
#[test]
fn laws_that_admit_everything_guard_nothing() -> Outcome {
    let mesh = rectangle([1.0, 1.0], [2, 2], CellKind::Tri6)?;
    let law = StableNeoHookean::plane_strain(1e5, 0.3);
    let description = FiniteStrainDescription::new(mesh, law, 1000.0);
    let model = FiniteStrainModel::assemble(description)?;
    assert!(model.groups.iter().all(|group| group.guards.len() == 0));
    let folded: Vec<f64> = model.rest_positions().iter().map(|x| -x * x).collect();
    assert!(!is_near_flat(&model.deformation(&folded)));
    Ok(())
}

fn is_near_flat(deformation: &Deformation) -> bool {
    deformation.start.is_flat.contains(&true)
}

fn has_flat_place<const N: usize>(group: &CellGroup, cell: usize, positions: &[f64]) -> bool {
    let differences = gather_one(&group.nodes.as_chunks::<N>().0[cell], positions);
    let mut places = group.guard_gradients::<N>(cell);
    places.any(|gradient| {
        let [_, j] = invariants(deformation_gradient(&differences, gradient));
        j < 0.1 || j.is_nan()
    })
}
