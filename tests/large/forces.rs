//! Internal forces and tangents of whole bodies.

use super::support::{
    KINDS, deformed, describe, dot, largest, laws, nodes_where, plate, warped_plate,
};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, Form, Linearization};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, Mesh};
use foil2d::fe::model::{MassKind, Model, ModelDescription};
use std::sync::Arc;

const STRETCHED: [f64; 4] = [1.3, 0.4, -0.2, 0.8];

/// A twentieth of the area is left: within the guard of the nodes.
const CRUSHED: [f64; 4] = [1.0, 0.1, -0.1, 0.04];

/// The internal force between two states.
fn force(model: &FiniteStrainModel, form: Form, start: &[f64], end: &[f64]) -> Vec<f64> {
    let mut deformation = model.deformation(start);
    let mut force = vec![0.0; model.n_dofs()];
    model
        .subtract_force(form, end, &mut deformation, &mut force)
        .expect("the states are admissible");
    force.iter_mut().for_each(|value| *value = -*value);
    force
}

/// Force · (x' - x) is the change of energy, to rounding, for any step; forces sum up to nothing and turn nothing.
#[test]
fn the_conserving_force_does_the_work_that_the_energy_rises_by() {
    for kind in KINDS {
        for law in laws(1e5, 0.3) {
            let model = warped_plate(kind, law);
            for (end, wave) in [(STRETCHED, -0.02), (CRUSHED, 1e-3)] {
                let start = deformed(&model, [1.0, 0.1, -0.1, 0.9], 0.01);
                let end = deformed(&model, end, wave);
                let force = force(&model, Form::EnergyMomentum { decay: 0.0 }, &start, &end);
                let name = model.law().name();

                let way: Vec<f64> = end
                    .iter()
                    .zip(&start)
                    .map(|(end, start)| end - start)
                    .collect();
                let rise = model.elastic_energy(&end) - model.elastic_energy(&start);
                let error = (dot(&force, &way) - rise) / rise;
                assert!(error.abs() < 1e-13, "{kind:?} {name}: {error:e}");

                let (mut sum, mut moment) = ([0.0; 2], 0.0);
                for (dof, pair) in force.chunks_exact(2).enumerate() {
                    let x = 0.5 * (start[2 * dof] + end[2 * dof]);
                    let y = 0.5 * (start[2 * dof + 1] + end[2 * dof + 1]);
                    sum = [sum[0] + pair[0], sum[1] + pair[1]];
                    moment += x * pair[1] - y * pair[0];
                }
                let size = largest(&force);
                assert!(largest(&sum) < 1e-13 * size, "{kind:?} {name}: {sum:?}");
                assert!(moment.abs() < 1e-13 * size, "{kind:?} {name}: {moment:e}");
            }
        }
    }
}

/// What is nearly flat has more energy at its nodes the flatter it is, beyond all bounds; what is less so has none.
#[test]
fn the_nodes_of_cells_are_guarded_where_the_law_has_no_energy_for_what_is_turned() {
    for kind in KINDS {
        for law in laws(1e5, 0.3) {
            let has_limit = law.name() == "neo-Hookean" && kind != CellKind::Tri3;
            let model = plate([1.0, 1.0], [1, 1], kind, law);
            // A corner goes towards the diagonal of the others, or beyond it.
            let corner = nodes_where(&model, |[x, y]| x == 1.0 && y == 1.0)[0];
            let at = |share: f64| {
                let mut state = model.rest_positions().to_vec();
                state[2 * corner] = 0.5 + share;
                state[2 * corner + 1] = 0.5 + share;
                state
            };
            let mut deformation = model.deformation(model.rest_positions());
            let mut residual = vec![0.0; model.n_dofs()];
            let state = at(-0.01);
            let outcome =
                model.subtract_force(Form::Equilibrium, &state, &mut deformation, &mut residual);
            let name = model.law().name();
            if has_limit {
                assert!(outcome.is_err(), "{kind:?} {name}");
            }
            if has_limit && kind == CellKind::Quad4 {
                let energies = [1e-2, 1e-4, 1e-8].map(|share| model.elastic_energy(&at(share)));
                assert!(energies.is_sorted_by(|a, b| a < b), "{kind:?} {energies:?}");
            } else if kind == CellKind::Quad4 {
                assert!(outcome.is_ok(), "{kind:?} {name}");
            }
        }
    }
}

/// Sides that bend around the corner opposite leave six determinants above zero: what is between the corners has energy, beyond all bounds.
#[test]
fn a_curved_triangle_is_guarded_between_its_corners() {
    let rest = [
        [0.0, 0.0],
        [1.0, 0.0],
        [0.5, 1.0],
        [0.5, 0.0],
        [0.75, 0.5],
        [0.25, 0.5],
    ];
    let mesh =
        Mesh::from_cells(rest.to_vec(), CellKind::Tri6, &[[0, 1, 2, 3, 4, 5]]).expect("a triangle");
    for law in laws(1e5, 0.3) {
        let has_limit = law.name() == "neo-Hookean";
        let mut description =
            FiniteStrainDescription::new(mesh.clone(), Corotated::plane_strain(1.0, 0.0), 1000.0);
        description.law = law;
        let model = FiniteStrainModel::assemble(description).expect("a body");
        let at = |height: f64| {
            let bent = [[0.5, -0.5], [0.75, -0.1], [0.25, -0.1]];
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.5, height]];
            [corners, bent].concat().concat()
        };
        let energies = [0.2, 1e-2, 1e-4, 1e-8].map(|height| model.elastic_energy(&at(height)));
        let is_rising = energies.is_sorted_by(|a, b| a < b) && energies[3] > 1e6 * energies[0];
        let mut deformation = model.deformation(model.rest_positions());
        let mut residual = vec![0.0; model.n_dofs()];
        let state = at(-1e-3);
        let outcome =
            model.subtract_force(Form::Equilibrium, &state, &mut deformation, &mut residual);
        let name = model.law().name();
        assert_eq!(outcome.is_err(), has_limit, "{name}");
        assert_eq!(is_rising, has_limit, "{name}: {energies:?}");
    }
}

/// Along three directions against central differences over 1e-6 m: truncation 1e-11, rounding 1e-9 of the stiffness.
#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    for kind in KINDS {
        for law in laws(1e5, 0.3) {
            let model = warped_plate(kind, law);
            // Nearly flat, the third derivatives are large.
            for (state, wave, bound) in [(STRETCHED, 0.01, 1e-8), (CRUSHED, 1e-3, 1e-5)] {
                let state = deformed(&model, state, wave);
                for form in [Form::Equilibrium, Form::EnergyMomentum { decay: 0.2 }] {
                    let error = error_of_tangent(&model, form, &state);
                    let name = model.law().name();
                    assert!(error < bound, "{kind:?} {name} {form:?}: {error:e}");
                }
            }
        }
    }
}

fn error_of_tangent(model: &FiniteStrainModel, form: Form, state: &[f64]) -> f64 {
    let mut deformation = model.deformation(state);
    let mut matrix = model.new_matrix();
    model
        .subtract_force(
            form,
            state,
            &mut deformation,
            &mut vec![0.0; model.n_dofs()],
        )
        .expect("the state is admissible");
    model.add_tangent(form, Linearization::Consistent, &deformation, &mut matrix);
    let mut worst: f64 = 0.0;
    for direction in 0..3 {
        let way: Vec<f64> = (0..model.n_dofs())
            .map(|dof| (1.0 + dof as f64 * (1.7 + direction as f64)).sin())
            .collect();
        let moved = |step: f64| -> Vec<f64> {
            state
                .iter()
                .zip(&way)
                .map(|(x, way)| x + step * way)
                .collect()
        };
        let [above, below] = [1e-6, -1e-6].map(|step| force(model, form, state, &moved(step)));
        let mut product = vec![0.0; model.n_dofs()];
        matrix.multiply(&way, &mut product);
        for ((above, below), product) in above.iter().zip(&below).zip(&product) {
            worst = worst.max(((above - below) / 2e-6 - product).abs());
        }
        worst /= largest(&product).max(1.0);
    }
    worst
}

/// What impulses are answered by knows of no rigid motion at the end, crushed or not: points, guards of nodes and hourglass modes.
#[test]
fn no_rigid_motion_is_felt_by_the_tangent_for_impulses() {
    for kind in KINDS {
        for law in laws(1e5, 0.3) {
            let model = warped_plate(kind, law);
            for (state, wave) in [(STRETCHED, 0.01), (CRUSHED, 1e-3)] {
                let state = deformed(&model, state, wave);
                let product = |linearization, way: &[f64]| {
                    let mut deformation = model.deformation(&state);
                    let mut unused = vec![0.0; model.n_dofs()];
                    let form = Form::Equilibrium;
                    model
                        .subtract_force(form, &state, &mut deformation, &mut unused)
                        .expect("the state is admissible");
                    let mut matrix = model.new_matrix();
                    model.add_tangent(form, linearization, &deformation, &mut matrix);
                    let mut product = vec![0.0; model.n_dofs()];
                    matrix.multiply(way, &mut product);
                    product
                };
                let turn: Vec<f64> = state.chunks(2).flat_map(|x| [-x[1], x[0]]).collect();
                let other: Vec<f64> = (0..model.n_dofs())
                    .map(|dof| (1.7 * dof as f64).sin())
                    .collect();
                let free = Linearization::Impulsive { most: 1e12 };
                let size = largest(&product(free, &other));
                let felt = largest(&product(free, &turn)) / size;
                let name = model.law().name();
                assert!(felt < 1e-12, "{kind:?} {name}: {felt:e}");
                let shift = [0.3, -0.7].repeat(model.n_nodes());
                let felt = largest(&product(free, &shift)) / size;
                assert!(felt < 1e-12, "{kind:?} {name}: {felt:e}");
                // The definite tangent resists turns: else nothing was shown.
                let resisted = largest(&product(Linearization::Definite, &turn)) / size;
                assert!(resisted > 1e-6, "{kind:?} {name}: {resisted:e}");
                assert!(dot(&other, &product(free, &other)) > 0.0, "{kind:?} {name}");
            }
        }
    }
}

/// At rest a parallelogram is the QM6 element, turned or not.
#[test]
fn a_quadrilateral_at_rest_answers_as_with_its_inner_modes() {
    for law in laws(1e5, 0.3) {
        let mut description = describe([1.0, 0.5], [3, 2], CellKind::Quad4, law);
        for pair in description.rest_positions.chunks_exact_mut(2) {
            let [x, y] = [pair[0], pair[1]];
            pair[0] = 0.8 * x - 0.3 * y;
            pair[1] = 0.6 * x + 1.1 * y;
        }
        let constants = description.law.constants();
        let small = Model::assemble(ModelDescription {
            mesh: Arc::clone(&description.mesh),
            rest_positions: description.rest_positions.clone(),
            placed_positions: Vec::new(),
            elements: Vec::new(),
            material: Arc::new(constants.linear(1000.0)),
            regions: Vec::new(),
            thickness: 1.0,
            mass_kind: MassKind::Lumped,
            massless: Vec::new(),
            held: Vec::new(),
        })
        .expect("a body");
        let model = FiniteStrainModel::assemble(description).expect("the same at large strain");
        let mut matrix = model.new_matrix();
        let deformation = model.deformation(model.rest_positions());
        let form = Form::Equilibrium;
        model.add_tangent(form, Linearization::Consistent, &deformation, &mut matrix);
        let ways = (0..model.n_dofs()).map(|dof| (1.0 + dof as f64).sin());
        let way: Vec<f64> = ways.collect();
        let [mut own, mut due] = [0, 1].map(|_| vec![0.0; model.n_dofs()]);
        matrix.multiply(&way, &mut own);
        small.stiffness().multiply(&way, &mut due);
        let pairs = own.iter().zip(&due);
        let difference: Vec<f64> = pairs.map(|(own, due)| own - due).collect();
        let error = largest(&difference) / largest(&due);
        assert!(error < 1e-13, "{}: {error:e}", model.law().name());

        // Stresses of small displacements, of bending too, at the same points.
        let (u, rest) = (way.iter().map(|way| 1e-7 * way), model.rest_positions());
        let u: Vec<f64> = u.collect();
        let at: Vec<f64> = rest.iter().zip(&u).map(|(x, u)| x + u).collect();
        for cell in 0..6 {
            let found = model.cell_stress(cell, &at);
            let due = small.cell_stress(cell, &u).expect("a cell");
            assert_eq!(found.len(), due.len());
            for (found, (_, due)) in found.iter().zip(due) {
                let pairs = [
                    [found.xx, due.xx],
                    [found.yy, due.yy],
                    [found.xy, due.xy],
                    [found.zz, due.zz],
                ];
                for [found, due] in pairs {
                    // Strains of 1e-6, with what they are to the second order.
                    assert!((found - due).abs() < 1e-5, "{found} Pa, not {due} Pa");
                }
            }
        }
    }
}

/// Patch test: under one and the same `F` in irregular and curved cells no node inside feels a force.
#[test]
fn a_homogeneous_state_is_in_equilibrium_inside() {
    for kind in KINDS {
        for law in laws(1e5, 0.3) {
            let model = warped_plate(kind, law);
            let state = deformed(&model, STRETCHED, 0.0);
            let force = force(&model, Form::Equilibrium, &state, &state);
            let boundary = model.mesh().boundary().nodes();
            let inner = (0..model.n_nodes()).filter(|node| !boundary.contains(node));
            let inside = inner.flat_map(|node| [force[2 * node], force[2 * node + 1]]);
            let inside: Vec<f64> = inside.collect();
            assert!(
                !inside.is_empty() && largest(&inside) < 1e-12 * largest(&force),
                "{kind:?}"
            );
        }
    }
}

/// A force that is taken from differences of coordinates is the same a thousand kilometres away. Coordinates are multiples of 1/64, which
/// are exact there, too.
#[test]
fn forces_lose_no_digits_far_from_the_origin() {
    let law = Arc::clone(&laws(1e9, 0.3)[0]);
    let model = foil2d::fe::finite_strain::FiniteStrainModel::assemble(describe(
        [1.0, 0.5],
        [4, 2],
        CellKind::Tri6,
        law,
    ))
    .expect("the plate is a good body");
    let state: Vec<f64> = deformed(&model, STRETCHED, 0.0)
        .iter()
        .map(|x| (64.0 * x).round() / 64.0)
        .collect();
    let away: Vec<f64> = state.iter().map(|x| x + 1_048_576.0).collect();
    let form = Form::Equilibrium;
    let near = force(&model, form, &state, &state);
    let far = force(&model, form, &away, &away);
    let error = near.iter().zip(&far).map(|(near, far)| near - far);
    let error: Vec<f64> = error.collect();
    assert!(largest(&error) == 0.0, "{:e}", largest(&error));
}

/// What no body can be made of is refused by name, with the number.
#[test]
fn parameters_out_of_range_are_refused() {
    let law = |young: f64, poisson: f64| Arc::clone(&laws(young, poisson)[3]);
    let refused = |change: &dyn Fn(&mut foil2d::fe::finite_strain::FiniteStrainDescription)| {
        let mut description = describe([1.0, 1.0], [1, 1], CellKind::Tri3, law(1e5, 0.3));
        change(&mut description);
        FiniteStrainModel::assemble(description)
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert!(refused(&|_| ()).is_empty());
    assert!(refused(&|d| d.density = 0.0).contains("density is 0"));
    assert!(refused(&|d| d.thickness = -1.0).contains("thickness is -1"));
    assert!(refused(&|d| d.damping.mass = -2.0).contains("-2 1/s"));
    assert!(refused(&|d| d.damping.stiffness = f64::NAN).contains("NaN s"));
    assert!(refused(&|d| d.law = law(1e5, 0.5)).contains("Poisson's ratio is 0.5"));
    assert!(refused(&|d| d.law = law(-1.0, 0.3)).contains("Young's modulus is -1"));
    assert!(refused(&|d| d.rest_positions.truncate(3)).contains("3 rest positions"));
    assert!(refused(&|d| d.rest_positions[0] = 2.0).contains("cell 0"));
    assert!(refused(&|d| d.rest_positions[0] = f64::NAN).contains("cell 0"));
}
