//! What acts on a free rigid body in a step.

/// Data of a free rigid body for one step.
#[derive(Clone, Copy, Debug)]
pub struct RigidLoad {
    /// Inverse mass in x, y and inverse inertia about z (1/kg, 1/kg, 1/(kg m²)); zero along locked axes.
    pub inverse_mass: [f64; 3],
    /// Applied force and torque, gravity included (N, N, N m).
    pub force: [f64; 3],
    /// Damping rates in x, y and rotation (1/s).
    pub damping: [f64; 3],
}

impl RigidLoad {
    /// Acceleration that the applied forces give to the body alone (m/s², rad/s²).
    pub fn drive(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.inverse_mass[i] * self.force[i])
    }
}
