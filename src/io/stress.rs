//! Stresses in the world's axes.

use crate::body::FlexBody;
use crate::fe::model::ModelError;
use crate::fe::recovery::Stress;
use crate::math::rotation;

/// Cauchy's stress at every node (Pa), in the world's axes: of a body of small strain `R s Rᵀ` of what it has in its own.
///
/// # Errors
/// If an element cannot evaluate its strain.
pub(super) fn world_stress(body: &FlexBody) -> Result<Vec<Stress>, ModelError> {
    let mut stresses = body.stress()?;
    if body.large().is_none() {
        let turn = rotation(body.angle());
        for stress in &mut stresses {
            let own = crate::math::Mat2::new(stress.xx, stress.xy, stress.xy, stress.yy);
            let turned = turn * own * turn.transpose();
            (stress.xx, stress.xy, stress.yy) = (turned.m11, turned.m12, turned.m22);
        }
    }
    Ok(stresses)
}
