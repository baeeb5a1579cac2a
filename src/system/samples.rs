//! Blocks of bodies, for tests.

use super::{FlexBlock, FlexLoad, Step};
use crate::body::{FlexBody, FlexBodyBuilder};
use crate::integrator::Beta2;
use crate::math::Vec2;
use std::sync::Arc;

/// The body of a builder that is right.
pub(crate) fn body_of(builder: FlexBodyBuilder) -> FlexBody {
    match builder.build() {
        Ok(body) => body,
        Err(error) => panic!("a plain body: {error}"),
    }
}

/// The block of a body at the beginning of a step of this length (s), predicted under the body's own loads without gravity.
pub(crate) fn predicted(body: &FlexBody, dt: f64) -> FlexBlock {
    let fixed = body.fixed_dofs().to_vec();
    let model = Arc::clone(body.touched_model());
    let mut block = FlexBlock::new(model, fixed, body.frame());
    let step = Step::new(&Beta2::default(), dt);
    let load = FlexLoad {
        force: body.nodal_forces(),
        gravity: Vec2::zeros(),
        prescribed: body.prescribed(),
        reaction: body.reactions(),
    };
    let mut state = body.state().clone();
    let started = block.start(step, &mut state, &load);
    assert!(started.is_ok() && block.predict(step, &state, &load).is_ok());
    block
}
