//! Materials, by their names.

use super::super::at::At;
use super::super::names::no_such;
use super::super::problem::Problem;
use super::super::scene::{Law, MaterialSpec};
use super::super::source::Source;
use super::super::words::of_material;
use foil2d::fe::material::hyperelastic::Hyperelastic;
use foil2d::fe::material::{MaterialError, Rayleigh};
use foil2d::prelude::*;
use std::sync::Arc;

/// A material of either kind.
pub enum Made {
    Linear(LinearElastic),
    Hyperelastic(HyperelasticSolid),
}

/// The material of a name.
pub fn material(source: &Source, name: &At<String>) -> Result<Made, Problem> {
    let materials = &source.scene.materials;
    let spec = materials
        .get(name.get())
        .ok_or_else(|| source.problem(name, no_such("material", name.get(), materials.keys())))?;
    let found = spec.get();
    let made = made_of(found);
    let valid = match &made {
        Made::Linear(linear) => linear.validate(),
        Made::Hyperelastic(solid) => solid.validate(),
    };
    valid.map_err(|error| {
        let what = of_material(&error);
        match error {
            MaterialError::Young { .. } => source.problem(&found.young, what),
            MaterialError::PoissonPlaneStress { .. } | MaterialError::PoissonPlaneStrain { .. } => {
                source.problem(&found.poisson, what)
            }
            MaterialError::Density { .. } => source.problem(&found.density, what),
            MaterialError::DampingMass { .. } => source.problem(&found.drag, what),
            MaterialError::DampingStiffness { .. } => source.problem(&found.rayleigh, what),
            _ => source.problem(spec, what),
        }
    })?;
    Ok(made)
}

fn made_of(spec: &MaterialSpec) -> Made {
    let rayleigh = Rayleigh {
        mass: *spec.drag.get(),
        stiffness: *spec.rayleigh.get(),
    };
    let (young, poisson) = (*spec.young.get(), *spec.poisson.get());
    let density = *spec.density.get();
    let linear =
        |material: LinearElastic| Made::Linear(material.density(density).damping(rayleigh));
    let solid = |law: Arc<dyn Hyperelastic>| {
        let solid = HyperelasticSolid::of(law).with_density(density);
        Made::Hyperelastic(solid.with_damping(rayleigh))
    };
    match spec.law {
        Law::PlaneStress => linear(LinearElastic::plane_stress(young, poisson)),
        Law::PlaneStrain => linear(LinearElastic::plane_strain(young, poisson)),
        Law::Corotated => solid(Arc::new(Corotated::plane_strain(young, poisson))),
        Law::StableNeoHookean => solid(Arc::new(StableNeoHookean::plane_strain(young, poisson))),
        Law::NeoHookean => solid(Arc::new(NeoHookean::plane_strain(young, poisson))),
    }
}
