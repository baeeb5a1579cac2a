//! One step of `M ẍ + Q(x, ẋ) = R` (C.1) by any member of Beta-2.

use super::dense::{DenseLu, Singular};
use super::error::NonLinearError;
use super::force::InternalForce;
use super::newton::{Newton, NewtonReport, NewtonSettings, StepEquation, require_finite};
use crate::integrator::Beta2;

/// Positions, velocities and accelerations, one entry per dof.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// `x` (m).
    pub position: Vec<f64>,
    /// `ẋ` (m/s).
    pub velocity: Vec<f64>,
    /// `ẍ` (m/s²), which Beta-2 carries from step to step.
    pub acceleration: Vec<f64>,
}

/// Steps a small system with user-given internal forces; keeps the buffers, so that only forces may allocate once it is warm.
///
/// ```
/// use foil2d::integrator::Beta2;
/// use foil2d::nonlinear::{CubicSpring, NewtonSettings, NonLinearStepper};
///
/// // 2 kg on a hardening spring, let go 0.1 m from rest.
/// let spring = CubicSpring { linear: 50.0, cubic: 4e3, damping: 0.0 };
/// let mut stepper = NonLinearStepper::lumped(&[2.0], Beta2::trapezoidal(), NewtonSettings::default())?;
/// let mut motion = stepper.start(&spring, &[0.0], vec![0.1], vec![0.0])?;
/// for _ in 0..100 {
///     let report = stepper.step(0.01, &spring, &[0.0], &mut motion)?;
///     assert!(report.n_iterations() <= 3);
/// }
/// assert!(motion.position[0].abs() <= 0.1001);
/// # Ok::<(), foil2d::nonlinear::NonLinearError>(())
/// ```
#[derive(Clone, Debug)]
pub struct NonLinearStepper {
    /// Row-major (kg).
    mass: Vec<f64>,
    n_dofs: usize,
    method: Beta2,
    settings: NewtonSettings,
    operators: [Vec<f64>; 2],
    newton: Newton,
}

impl NonLinearStepper {
    /// A system with one mass (kg) per dof.
    ///
    /// # Errors
    /// If a mass is not finite or a setting is out of range.
    pub fn lumped(
        masses: &[f64],
        method: Beta2,
        settings: NewtonSettings,
    ) -> Result<Self, NonLinearError> {
        let n_dofs = masses.len();
        let mut mass = vec![0.0; n_dofs * n_dofs];
        for (dof, value) in masses.iter().enumerate() {
            mass[dof * (n_dofs + 1)] = *value;
        }
        Self::new(mass, n_dofs, method, settings)
    }

    /// A system with a mass matrix (kg), row-major, shape `(n_dofs, n_dofs)`.
    ///
    /// The mass may be singular, if stiffness or damping holds the dofs without inertia.
    ///
    /// # Errors
    /// If the matrix is not finite or has another shape, or a setting is out of range.
    pub fn new(
        mass: Vec<f64>,
        n_dofs: usize,
        method: Beta2,
        settings: NewtonSettings,
    ) -> Result<Self, NonLinearError> {
        require_length("the mass matrix", &mass, n_dofs * n_dofs)?;
        require_finite("the mass", &mass, |slot| slot / n_dofs.max(1))?;
        settings.check()?;
        Ok(Self {
            mass,
            n_dofs,
            method,
            settings,
            operators: [vec![0.0; n_dofs], vec![0.0; n_dofs]],
            newton: Newton::new(n_dofs),
        })
    }

    /// A motion with given positions (m) and velocities (m/s), whose accelerations obey `M ẍ = R - Q(x, ẋ)`.
    ///
    /// # Errors
    /// If the lengths differ, if `M` has no inverse (then set the accelerations yourself), or if something is not finite.
    pub fn start(
        &self,
        law: &(impl InternalForce + ?Sized),
        load: &[f64],
        position: Vec<f64>,
        velocity: Vec<f64>,
    ) -> Result<Motion, NonLinearError> {
        require_length("the load", load, self.n_dofs)?;
        require_length("the positions", &position, self.n_dofs)?;
        require_length("the velocities", &velocity, self.n_dofs)?;
        let mut acceleration = vec![0.0; self.n_dofs];
        law.force(&position, &velocity, &mut acceleration);
        require_finite("the internal force", &acceleration, |dof| dof)?;
        for (value, load) in acceleration.iter_mut().zip(load) {
            *value = load - *value;
        }
        let mut mass = DenseLu::new(self.n_dofs);
        mass.values_mut().copy_from_slice(&self.mass);
        mass.factorize()
            .map_err(
                |Singular { column: dof, pivot }| NonLinearError::SingularTangent { dof, pivot },
            )?;
        mass.solve_in_place(&mut acceleration);
        require_finite("the acceleration", &acceleration, |dof| dof)?;
        Ok(Motion {
            position,
            velocity,
            acceleration,
        })
    }

    /// Advances the motion by `dt` (s) under a load (N) taken at the end of the step.
    ///
    /// # Errors
    /// [`NonLinearError`]; the motion is then unchanged, and [`NonLinearStepper::report`] tells how far the iterations came.
    pub fn step(
        &mut self,
        dt: f64,
        law: &(impl InternalForce + ?Sized),
        load: &[f64],
        motion: &mut Motion,
    ) -> Result<&NewtonReport, NonLinearError> {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(NonLinearError::StepLength(dt));
        }
        require_length("the load", load, self.n_dofs)?;
        for (name, values) in [
            ("the positions", &motion.position),
            ("the velocities", &motion.velocity),
            ("the accelerations", &motion.acceleration),
        ] {
            require_length(name, values, self.n_dofs)?;
            require_finite(name, values, |dof| dof)?;
        }
        let [q0, q1] = &mut self.operators;
        let start = [&motion.position, &motion.velocity, &motion.acceleration];
        Beta2::predict(dt, start.map(Vec::as_slice), q0, q1);
        let equation = StepEquation {
            law,
            mass: &self.mass,
            load,
            dt,
            weights: self.method.weights(dt),
            operators: [q0, q1, &motion.acceleration],
        };
        self.newton.solve(&equation, &self.settings)?;
        let end = &self.newton.current;
        motion.position.copy_from_slice(&end.position);
        motion.velocity.copy_from_slice(&end.velocity);
        motion.acceleration.copy_from_slice(&end.acceleration);
        Ok(&self.newton.report)
    }

    /// What the iterations of the last step did, also if it failed.
    pub fn report(&self) -> &NewtonReport {
        &self.newton.report
    }
}

fn require_length(
    name: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), NonLinearError> {
    if values.len() == expected {
        return Ok(());
    }
    Err(NonLinearError::Length {
        name,
        found: values.len(),
        expected,
    })
}
