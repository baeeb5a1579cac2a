//! Flexible bodies.

use super::super::names::no_such;
use super::super::problem::Problem;
use super::super::scene::Flexible;
use super::super::shape::{Shaped, shaped};
use super::super::source::Source;
use super::super::words::{Culprit, of_build};
use super::Built;
use super::checks::{check_not_negative, check_number, check_pair, check_positive};
use super::material::{Made, material};
use super::nodes::nodes;
use foil2d::body::BuildError;
use foil2d::prelude::*;

pub fn insert(built: &mut Built, source: &Source, spec: &Flexible) -> Result<(), Problem> {
    built.names.refuse_taken(source, &spec.name)?;
    check(source, spec)?;
    let shaped = shaped(source, &spec.shape, built.nodes_left)?;
    let mut body = FlexBodyBuilder::mesh(shaped.mesh.clone())
        .translation(spec.translation.get().0)
        .rotation(*spec.rotation.get())
        .linvel(spec.linvel.get().0)
        .angvel(*spec.angvel.get())
        .thickness(*spec.thickness.get())
        .friction(*spec.friction.get())
        .restitution(*spec.restitution.get());
    body = match material(source, &spec.material)? {
        Made::Linear(linear) => body.material(linear),
        Made::Hyperelastic(solid) => body.material(solid),
    };
    body = of_regions(body, source, spec, &shaped)?;
    if *spec.small_strain.get() {
        body = body.small_strain();
    }
    for pin in &spec.pin {
        let held = Pin { x: pin.x, y: pin.y };
        for node in nodes(source, &shaped, pin.nodes.get())? {
            body = body.pin(node, held);
        }
    }
    for force in &spec.force {
        check_pair(source, "force", &force.force)?;
        let chosen = nodes(source, &shaped, &force.nodes)?;
        let share = force.force.get().0.map(|all| all / chosen.len() as f64);
        for node in chosen {
            body = body.nodal_force(node, share);
        }
    }
    let handle = built
        .flex_bodies
        .insert(body, &mut built.world)
        .map_err(|error| refused(source, spec, &shaped, &error))?;
    let name = spec.name.get();
    built.names.flexible.insert(name.clone(), handle);
    built.nodes_left = built.nodes_left.saturating_sub(shaped.mesh.n_nodes());
    built.shaped.insert(name.clone(), shaped);
    Ok(())
}

fn check(source: &Source, spec: &Flexible) -> Result<(), Problem> {
    check_pair(source, "translation", &spec.translation)?;
    check_number(source, "rotation", &spec.rotation)?;
    check_pair(source, "linvel", &spec.linvel)?;
    check_number(source, "angvel", &spec.angvel)?;
    check_positive(source, "thickness", &spec.thickness)?;
    check_not_negative(source, "friction", &spec.friction)?;
    check_not_negative(source, "restitution", &spec.restitution)
}

/// Gives regions of the mesh materials of their own.
fn of_regions(
    mut body: FlexBodyBuilder,
    source: &Source,
    spec: &Flexible,
    shaped: &Shaped,
) -> Result<FlexBodyBuilder, Problem> {
    for (region, name) in &spec.regions {
        if shaped.mesh.region_named(region).is_none() {
            let known = shaped.mesh.region_names().map(|(_, own)| own);
            let what = no_such("region", region, known);
            return Err(source.problem(name, what));
        }
        body = match material(source, name)? {
            Made::Linear(linear) => body.region_material(region.as_str(), linear),
            Made::Hyperelastic(solid) => body.region_material(region.as_str(), solid),
        };
    }
    Ok(body)
}

/// Whether the digits that are left where a body is put are too few for the shape of its cells.
fn is_far(spec: &Flexible, shaped: &Shaped) -> bool {
    let [x, y] = spec.translation.get().0;
    let rounding = f64::EPSILON * x.abs().max(y.abs());
    rounding > 1e-6 * shaped.mesh.quality().min_edge
}

/// Why the library did not take the body, told at the key that is at fault.
fn refused(source: &Source, spec: &Flexible, shaped: &Shaped, error: &BuildError) -> Problem {
    let (culprit, what) = of_build(error, &shaped.mesh);
    match culprit {
        Culprit::Cell if is_far(spec, shaped) => source.problem(
            &spec.translation,
            "so far from the origin the places of nodes are lost in rounding: put the body nearer",
        ),
        Culprit::Shape | Culprit::Cell => source.problem(&spec.shape, what),
        Culprit::Material => source.problem(&spec.material, what),
        Culprit::Region(region) => match spec.regions.get(&region) {
            Some(name) => source.problem(name, what),
            None => source.problem(&spec.material, what),
        },
        Culprit::SmallStrain => source.problem(&spec.small_strain, what),
        Culprit::Translation => source.problem(&spec.translation, what),
        Culprit::Velocity if spec.angvel.byte().is_some() => source.problem(&spec.angvel, what),
        Culprit::Velocity => source.problem(&spec.linvel, what),
        Culprit::Pin => match spec.pin.last() {
            Some(pin) => source.problem(&pin.nodes, what),
            None => source.problem(&spec.name, what),
        },
        Culprit::Name => source.problem(&spec.name, what),
    }
}
