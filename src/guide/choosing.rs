//! What you want, and what to choose for it.
//!
//! # Bodies
//!
//! | you want | choose |
//! |---|---|
//! | bodies that bend or stretch far | the default; for another law [`HyperelasticSolid`](crate::fe::material::hyperelastic::HyperelasticSolid), see [`large_or_small`](super::large_or_small) |
//! | stiff bodies at the least cost, linear beam theory | [`small_strain`](crate::body::FlexBodyBuilder::small_strain): one factorization for ever, strains of a few percent |
//! | several materials in a body | [`region_material`](crate::body::FlexBodyBuilder::region_material), with regions by [`regions_by`](crate::body::FlexBodyBuilder::regions_by) or [`Mesh::with_regions`](crate::fe::mesh::Mesh::with_regions) |
//! | tyres, balloons, cushions | a mesh with holes and an [`inner_pressure`](crate::body::FlexBodyBuilder::inner_pressure): isothermal, adiabatic or constant; [`FlexBody::set_inner_pressure`](crate::body::FlexBody::set_inner_pressure) pumps; fast tyres are braked as they roll ([limits](crate::guide::limits), *Rolling*), less in shorter steps |
//! | metals that yield | [`J2Plasticity`](crate::fe::material::hyperelastic::J2Plasticity) |
//! | a bar one cell thick that bounces right | `small_strain` and [`ContactInertia::RedistributedAt`](crate::body::ContactInertia::RedistributedAt) |
//! | an element or a law of your own | an `impl` of [`Element`](crate::fe::element::Element), [`Material`](crate::fe::material::Material) or [`Hyperelastic`](crate::fe::material::hyperelastic::Hyperelastic); suites named `conformance` test it |
//!
//! # Steps
//!
//! | you want | choose |
//! |---|---|
//! | contact that settles at any step | the default, [`Beta2::damped`](crate::integrator::Beta2::damped)`(0.9)`: what the step does not resolve dies out, slow vibrations of `ω` (rad/s) are damped with a ratio of about `0.013 ω dt`, with small strain `0.026 ω dt` |
//! | vibrations that keep their energy | [`Beta2::trapezoidal`](crate::integrator::Beta2::trapezoidal), with steps that resolve the impacts |
//! | vibrations that die out | damping of the material, see [`mesh_and_step`](super::mesh_and_step) |
//! | explicit steps, no factorization of the mesh | [`Beta2::central_difference`](crate::integrator::Beta2::central_difference) and bodies of `small_strain`; too long a step is refused, and the critical one told |
//! | to stop where a step is not solved | [`refusing_unsolved`](crate::pipeline::FlexPipeline::refusing_unsolved) |
//! | other budgets and thresholds | [`FlexPipeline::parameters`](crate::pipeline::FlexParameters), plain values as rapier's `IntegrationParameters` |
//!
//! ```
//! use foil2d::prelude::*;
//! let mut flex = FlexPipeline::new().with_integrator(Beta2::trapezoidal()).refusing_unsolved();
//! flex.parameters.max_newton = 40;
//! assert!(flex.parameters.refuses_unsolved);
//! ```
//!
//! # To compare
//!
//! | you want | choose |
//! |---|---|
//! | ADINA's constraint functions | [`ContactMethod::ConstraintFunction`](crate::kkt::ContactMethod) in [`with_contact_method`](crate::pipeline::FlexPipeline::with_contact_method) |
//! | the printed method, to see it fail on impact | [`ImpactTreatment::Plain`](crate::kkt::ImpactTreatment) in [`with_impact`](crate::pipeline::FlexPipeline::with_impact); `Projected` and `ImplicitForces` beside it |
//! | no feasible path | [`FlexParameters::feasible_path`](crate::pipeline::FlexParameters::feasible_path)` = false`: surfaces are then kept apart by the forces alone, and may pass through each other |
//!
//! # In and out
//!
//! | you want | choose |
//! |---|---|
//! | shapes and meshes drawn elsewhere, files and pictures of a run | [`files`](super::files) |
//! | meshes, stresses and forces through rapier's debug renderer | feature `debug-render`, `pipeline::FlexDebugRender` |
//! | to save and restore | feature `serde-serialize`, `pipeline::Snapshot`; materials and elements of your own by name, `KnownLaws` |
//! | the same bits on every platform | feature `enhanced-determinism`; `parallel` gives rapier's threads and changes no bit |
