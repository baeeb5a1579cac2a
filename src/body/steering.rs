//! What a user changes on a body between steps. All of it wakes the body.

use super::error::{FlexBodyError, check_finite, check_held};
use super::flex_body::FlexBody;

impl FlexBody {
    /// Sets a constant force on a node (N), until it is set again.
    ///
    /// # Errors
    /// If the node does not exist or the force is not finite.
    pub fn set_nodal_force(&mut self, node: usize, force: [f64; 2]) -> Result<(), FlexBodyError> {
        self.check_node(node)?;
        check_finite("the force", &force)?;
        self.nodal_force[2 * node..2 * node + 2].copy_from_slice(&force);
        self.is_disturbed = true;
        Ok(())
    }

    /// Sets the force per mass besides gravity (m/s²).
    ///
    /// # Errors
    /// If it is not finite, or rapier's precision cannot hold it.
    pub fn set_body_force(&mut self, acceleration: [f64; 2]) -> Result<(), FlexBodyError> {
        check_held("the body force", &acceleration)?;
        self.body_force = acceleration.into();
        self.is_disturbed = true;
        Ok(())
    }

    /// Sets the factor on the world's gravity (-).
    ///
    /// # Errors
    /// If it is not finite, or rapier's precision cannot hold it.
    pub fn set_gravity_scale(&mut self, scale: f64) -> Result<(), FlexBodyError> {
        check_held("the gravity scale", &[scale])?;
        self.gravity_scale = scale;
        self.is_disturbed = true;
        Ok(())
    }

    /// Prescribes the displacement of a pinned node (m); directions that are not pinned are ignored.
    ///
    /// # Errors
    /// If the node does not exist, is not pinned, or rapier's precision cannot hold the displacement.
    pub fn set_pin_displacement(
        &mut self,
        node: usize,
        displacement: [f64; 2],
    ) -> Result<(), FlexBodyError> {
        self.check_node(node)?;
        if !(self.is_fixed[2 * node] || self.is_fixed[2 * node + 1]) {
            return Err(FlexBodyError::NotPinned(node));
        }
        check_held("the displacement", &displacement)?;
        self.prescribed[2 * node..2 * node + 2].copy_from_slice(&displacement);
        self.is_disturbed = true;
        Ok(())
    }

    /// Sets all nodal velocities, interleaved (m/s); pinned directions stay at rest.
    ///
    /// # Errors
    /// If the length is not two per node or rapier's precision cannot hold a velocity.
    pub fn set_velocities(&mut self, velocities: &[f64]) -> Result<(), FlexBodyError> {
        if velocities.len() != self.state.velocity.len() {
            return Err(FlexBodyError::Length {
                name: "the velocities",
                found: velocities.len(),
                n_nodes: self.n_nodes(),
            });
        }
        check_held("the velocities", velocities)?;
        for ((own, &new), &is_fixed) in self
            .state
            .velocity
            .iter_mut()
            .zip(velocities)
            .zip(&self.is_fixed)
        {
            *own = if is_fixed { 0.0 } else { new };
        }
        self.velocity_changed();
        self.is_disturbed = true;
        Ok(())
    }

    /// Wakes the body, and with it all that it touches, at the next step.
    ///
    /// `IslandManager::wake_up` with [`FlexBody::rigid_body_handle`] does it at once.
    pub fn wake_up(&mut self) {
        self.is_disturbed = true;
    }

    fn check_node(&self, node: usize) -> Result<(), FlexBodyError> {
        let n_nodes = self.n_nodes();
        if node < n_nodes {
            Ok(())
        } else {
            Err(FlexBodyError::Node { node, n_nodes })
        }
    }
}
