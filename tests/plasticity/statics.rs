//! Bars that are pulled, let go and pressed, against closed forms and a return mapping of its own; forces and tangents of whole bodies.

use super::support::{KINDS, Metal, Point, dot, plate};
use foil2d::fe::finite_strain::{FiniteStrainModel, Form, Linearization};
use foil2d::fe::material::hyperelastic::Hencky;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{LargeSettings, LoadCase, LoadStepper};

const METAL: Metal = Metal {
    young: 2e5,
    poisson: 0.3,
    y: 400.0,
    h: 3e3,
};

/// A plate 2 x 1 m whose right end is moved along x, with its other sides free or, if told, moved as well.
struct Bar {
    model: FiniteStrainModel,
    stepper: LoadStepper,
    positions: Vec<f64>,
    is_held: Vec<bool>,
    stretch: [f64; 2],
}

impl Bar {
    fn new(kind: CellKind, metal: &Metal, is_free: bool) -> Self {
        let model = plate([2.0, 1.0], [1, 1], kind, metal.law());
        let rest = model.rest_positions();
        let is_held = rest.chunks_exact(2).flat_map(|x| {
            let (ends, sides) = (x[0] == 0.0 || x[0] == 2.0, x[1] == 0.0 || x[1] == 1.0);
            [ends, if is_free { x[1] == 0.0 } else { sides }]
        });
        let settings = LargeSettings::conserving().with_tolerance(1e-11);
        Self {
            is_held: is_held.collect(),
            positions: rest.to_vec(),
            stepper: LoadStepper::new(model.clone(), settings).expect("good settings"),
            stretch: [1.0; 2],
            model,
        }
    }

    /// Stretches to this; returns the force over the right end (N) and what has been dissipated (J).
    fn stretch(&mut self, stretch: [f64; 2]) -> (f64, f64) {
        let rest = self.model.rest_positions().to_vec();
        let places: Vec<f64> = rest
            .chunks_exact(2)
            .flat_map(|x| [stretch[0] * x[0], stretch[1] * x[1]])
            .collect();
        let zeros = vec![0.0; rest.len()];
        let case = LoadCase {
            from: &zeros,
            to: &zeros,
            is_held: &self.is_held,
            places: &places,
            n_increments: 1,
        };
        let report = self
            .stepper
            .solve(case, &mut self.positions)
            .expect("an equilibrium");
        assert_eq!(report.n_increments, 1, "the return is that of one step");
        self.stretch = stretch;
        let reaction = self.stepper.reaction().chunks_exact(2);
        let right = reaction
            .zip(rest.chunks_exact(2))
            .filter(|(_, x)| x[0] == 2.0);
        (right.map(|(force, _)| force[0]).sum(), report.flowed)
    }
}

/// Stretch `λ` along, `1/λ` across: `e = 2/√3 ln λ` and the deviator keeps its direction, so that nothing depends on steps. Loading gives `α` by
/// `3 μ (e - α) = Y + H α`, unloading is elastic until `3 μ (e - e' - α) = -(Y + H α)`, where it flows back.
#[test]
fn a_plate_in_plain_shear_has_the_stress_of_the_closed_form_back_and_forth() {
    let Metal { y, h, .. } = METAL;
    let stiffness = 3.0 * METAL.mu();
    let of = |e: f64| (0.5 * 3f64.sqrt() * e).exp();
    let most = 0.12;
    let alpha = (stiffness * most - y) / (stiffness + h);
    let back_at = most - 2.0 * (y + h * alpha) / stiffness;
    let end = back_at - 0.07;
    // Backwards beyond: 3 μ (back_at - e - x) = H x.
    let flow = stiffness * (back_at - end) / (stiffness + h);
    let path = [
        (y / stiffness, y),
        (most, y + h * alpha),
        (
            most - alpha * 0.02,
            stiffness * (most - 0.02 * alpha - alpha),
        ),
        (back_at, -(y + h * alpha)),
        (end, -(y + h * (alpha + flow))),
    ];
    for kind in KINDS {
        let mut bar = Bar::new(kind, &METAL, false);
        let mut dissipated = 0.0;
        for (e, mises) in path {
            let stretch = of(e);
            let (force, flowed) = bar.stretch([stretch, 1.0 / stretch]);
            dissipated += flowed;
            // The deviator is (√3/2, -√3/2, 0) 2/3 times von Mises' stress, and there is no pressure.
            let due = mises / 3f64.sqrt() / stretch;
            assert!(
                (force - due).abs() < 1e-10 * y,
                "{kind:?} at {e}: {force} for {due}"
            );
        }
        let total = alpha + flow;
        let due = 2.0 * (y * total + 0.5 * h * total * total);
        assert!(
            (dissipated / due - 1.0).abs() < 1e-10,
            "{dissipated} for {due}"
        );
        let found = bar.stepper.flowed().iter().map(|point| point.strain);
        for strain in found {
            assert!((strain / total - 1.0).abs() < 1e-10, "{strain} for {total}");
        }
    }
}

/// Free sides, nothing out of the plane: the deviator turns as the bar begins to flow. The return of principal logarithmic strains, by bisection, in
/// the same increments.
#[test]
fn a_bar_is_pulled_let_go_and_pressed_as_its_principal_strains_tell() {
    for kind in KINDS {
        for y in [400.0, 4e3] {
            let metal = Metal { y, ..METAL };
            let mut bar = Bar::new(kind, &metal, true);
            let mut point = Point::default();
            for strain in [
                0.001, 0.003, 0.005, 0.007, 0.01, 0.03, 0.05, 0.07, 0.09, 0.11, 0.109, 0.105, 0.09,
                0.07, 0.05, 0.03, 0.01, -0.01, -0.03,
            ] {
                let (force, _) = bar.stretch([f64::exp(strain), 1.0]);
                let (stress, _, after) = point.pull(&metal, strain);
                point = after;
                let due = stress / f64::exp(strain);
                let error = (force - due).abs() / y;
                assert!(error < 1e-9, "{kind:?} at {strain}: {force} for {due}");
            }
        }
    }
}

/// Of strains so small that their squares do not count the force is that of the small-strain theory: `E/(1 - ν²) ε` up to the yield at
/// `Y/√(1 - ν + ν²)`, the unloading as steep. What is left are powers of `Y/E`, and extrapolated from three of them the third.
#[test]
fn small_strains_are_those_of_the_small_theory() {
    let forces = |y: f64| {
        let metal = Metal { y, h: 0.0, ..METAL };
        let modulus = metal.young / (1.0 - 0.3 * 0.3);
        let limit = y / (1.0f64 - 0.3 + 0.09).sqrt();
        let mut bar = Bar::new(CellKind::Quad4, &metal, true);
        let mut at = |strain: f64| bar.stretch([1.0 + strain, 1.0]).0;
        let yields = at(limit / modulus);
        let top = at(3.0 * limit / modulus);
        let back = at(2.5 * limit / modulus);
        // The next elastic point, the slope back.
        [yields / limit, (top - back) / (0.5 * limit)]
    };
    let found = [4e-4, 2e-4, 1e-4].map(|share| forces(share * METAL.young));
    for quantity in 0..2 {
        let [coarse, middle, fine] = found.map(|level| level[quantity]);
        assert!((fine - 1.0).abs() < 1e-3, "{fine}");
        let extrapolated = (8.0 * fine - 6.0 * middle + coarse) / 3.0;
        assert!((extrapolated - 1.0).abs() < 1e-8, "{extrapolated}");
    }
}

/// Forces are the slopes of the incremental potential, tangents those of the forces, after flow in another direction.
#[test]
fn forces_and_tangents_are_derivatives_of_stored_and_dissipated_energy() {
    for kind in KINDS {
        let model = plate([1.0, 0.5], [2, 1], kind, METAL.law());
        let at = |[xx, xy, yx, yy]: [f64; 4], wave: f64| -> Vec<f64> {
            let place = |x: &[f64]| {
                let wave = wave * (5.0 * x[0] - 3.0 * x[1]).sin();
                [xx * x[0] + xy * x[1] + wave, yx * x[0] + yy * x[1] - wave]
            };
            model
                .rest_positions()
                .chunks_exact(2)
                .flat_map(place)
                .collect()
        };
        let start = at([1.03, 0.1, -0.02, 0.95], 0.01);
        let mut deformation = model.deformation(&start);
        assert!(model.commit_flow(&start, deformation.flowed_mut()) > 0.0);
        let flowed = deformation.flowed().to_vec();
        let end = at([0.97, -0.05, 0.06, 1.04], -0.02);
        let potential = |x: &[f64]| {
            let energy = model.energy_after(x, &flowed);
            energy.stored + energy.dissipated
        };
        let mut force = |form: Form, x: &[f64]| {
            let mut residual = vec![0.0; model.n_dofs()];
            model
                .subtract_force(form, x, &mut deformation, &mut residual)
                .expect("a place that is admitted");
            residual
        };
        let conserving = Form::EnergyMomentum { decay: 0.0 };
        let pulls = force(conserving, &end);
        let way: Vec<f64> = end
            .iter()
            .zip(&start)
            .map(|(end, start)| end - start)
            .collect();
        let work = -dot(&pulls, &way);
        let after = model.energy_after(&end, &flowed);
        let before = model.energy_after(&start, &flowed).stored;
        assert!(after.dissipated > 1.0);
        let due = after.stored - before + after.dissipated;
        assert!(
            (work / due - 1.0).abs() < 1e-11,
            "{kind:?}: {work} for {due}"
        );

        let step = 1e-6;
        let resting = force(Form::Equilibrium, &end);
        for dof in 0..model.n_dofs() {
            let [above, below] = [step, -step].map(|step| {
                let mut x = end.clone();
                x[dof] += step;
                potential(&x)
            });
            let error = (above - below) / (2.0 * step) + resting[dof];
            assert!(
                error.abs() < 1e-4,
                "{kind:?} {dof}: {error:e} of {}",
                resting[dof]
            );
        }
        let mut matrix = model.new_matrix();
        force(Form::Equilibrium, &end);
        let mut columns = Vec::new();
        for dof in 0..model.n_dofs() {
            let [above, below] = [step, -step].map(|step| {
                let mut x = end.clone();
                x[dof] += step;
                force(Form::Equilibrium, &x)
            });
            let column = above
                .iter()
                .zip(&below)
                .map(|(a, b)| (b - a) / (2.0 * step));
            columns.push(column.collect::<Vec<f64>>());
        }
        force(Form::Equilibrium, &end);
        let consistent = Linearization::Consistent;
        model.add_tangent(Form::Equilibrium, consistent, &deformation, &mut matrix);
        for (column, due) in columns.iter().enumerate() {
            let mut unit = vec![0.0; model.n_dofs()];
            unit[column] = 1.0;
            let mut found = vec![0.0; model.n_dofs()];
            matrix.multiply_add(1.0, &unit, &mut found);
            for (found, due) in found.iter().zip(due) {
                assert!(
                    (found - due).abs() < 1e-7 * 2e5,
                    "{kind:?}: {found} for {due}"
                );
            }
        }
    }
}

/// Below the yield stress a body is one of its elastic law, to rounding: the law takes `t - 2 J` by its two terms, the flow as a sum of squares.
#[test]
fn a_body_that_does_not_yield_has_the_forces_of_henckys_law() {
    use foil2d::fe::finite_strain::FiniteStrainDescription;
    for kind in KINDS {
        let strong = Metal { y: 1e9, ..METAL };
        let model = plate([1.0, 0.5], [3, 2], kind, strong.law());
        let law = Hencky::plane_strain(METAL.young, METAL.poisson);
        let description = FiniteStrainDescription::new(model.mesh().clone(), law, 1000.0);
        let elastic = FiniteStrainModel::assemble(description).expect("a body");
        let place = |x: &[f64]| [1.2 * x[0] + 0.1 * x[1] * x[1], 0.9 * x[1] - 0.2 * x[0]];
        let end: Vec<f64> = model
            .rest_positions()
            .chunks_exact(2)
            .flat_map(place)
            .collect();
        for form in [Form::Equilibrium, Form::EnergyMomentum { decay: 0.1 }] {
            let forces = [&model, &elastic].map(|model| {
                let mut residual = vec![0.0; model.n_dofs()];
                let mut deformation = model.deformation(model.rest_positions());
                let found = model.subtract_force(form, &end, &mut deformation, &mut residual);
                found.expect("an admitted place");
                residual
            });
            let size = forces[1]
                .iter()
                .fold(0.0f64, |most, force| most.max(force.abs()));
            for (found, due) in forces[0].iter().zip(&forces[1]) {
                assert!(
                    (found - due).abs() < 1e-13 * size,
                    "{kind:?}: {found} {due}"
                );
            }
        }
        let energies = [
            model.energy_after(&end, &model.virgin()).stored,
            elastic.elastic_energy(&end),
        ];
        assert!((energies[0] / energies[1] - 1.0).abs() < 1e-13);
    }
}
