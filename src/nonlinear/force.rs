//! The vector of internal forces `Q(x, ẋ)` of (C.1).

/// Where the tangent of an iteration came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TangentSource {
    /// The force law gave it.
    #[default]
    Supplied,
    /// Central differences of the force, `4 n` more evaluations.
    FiniteDifferences,
}

/// A law of internal forces; on the left of (C.1), so that a spring has `Q = +k x`.
pub trait InternalForce {
    /// Writes `Q(x, ẋ)` (N).
    ///
    /// - `position` (m), `velocity` (m/s), `force`: one entry per dof.
    fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]);

    /// Writes the tangents `k = ∂Q/∂x` (N/m) and `c = ∂Q/∂ẋ` (N s/m) at `x`, `v`, row-major, shape `(n, n)`, both zero on entry.
    ///
    /// Returns where they come from; a law without tangents keeps this method, writes nothing and asks for finite
    /// differences. An inexact tangent slows the iterations down but does not change what they end at.
    fn tangent(&self, x: &[f64], v: &[f64], k: &mut [f64], c: &mut [f64]) -> TangentSource {
        let _ = (x, v, k, c);
        TangentSource::FiniteDifferences
    }
}

impl<F: InternalForce + ?Sized> InternalForce for &F {
    fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]) {
        (**self).force(position, velocity, force);
    }

    fn tangent(&self, x: &[f64], v: &[f64], k: &mut [f64], c: &mut [f64]) -> TangentSource {
        (**self).tangent(x, v, k, c)
    }
}
