//! What is wrong with a body, its material or what holds it.

use super::meshes::of_mesh;
use foil2d::body::{AttachmentError, BuildError, FlexBodyError, Region};
use foil2d::fe::finite_strain::FiniteStrainError;
use foil2d::fe::material::MaterialError;
use foil2d::fe::mesh::Mesh;
use foil2d::fe::model::ModelError;

/// What of a flexible body is at fault.
pub enum Culprit {
    Shape,
    /// The shape of a cell where the body is put.
    Cell,
    Material,
    /// The material of a region.
    Region(String),
    SmallStrain,
    Translation,
    Velocity,
    Pin,
    Name,
}

pub fn of_material(error: &MaterialError) -> String {
    match error {
        MaterialError::Density { value } => {
            format!("the density is {value} kg/m³: give a positive finite value")
        }
        MaterialError::DampingMass { value } => {
            format!("`drag` is {value} 1/s: give zero or a positive finite value")
        }
        MaterialError::DampingStiffness { value } => {
            format!("`rayleigh` is {value} s: give zero or a positive finite value")
        }
        error => error.to_string(),
    }
}

/// What is wrong, and with what.
pub fn of_build(error: &BuildError, mesh: &Mesh) -> (Culprit, String) {
    match error {
        BuildError::Mesh(error) => (Culprit::Shape, of_mesh(error).1),
        BuildError::Material(error) => (Culprit::Material, of_material(error)),
        BuildError::Model(error) | BuildError::Large(FiniteStrainError::Model(error)) => {
            of_model(error, mesh)
        }
        BuildError::Large(FiniteStrainError::Material(error)) => {
            (Culprit::Material, of_material(error))
        }
        BuildError::NoLargeLaw { .. } => (
            Culprit::Material,
            "in plane stress with `poisson` from -0.5 down there is no law for large strains: give `small_strain = true`, or a `law` of plane strain"
                .to_owned(),
        ),
        BuildError::FlowSmallStrain { .. } => (
            Culprit::SmallStrain,
            "a body of small strain has no plastic flow: leave `small_strain` out".to_owned(),
        ),
        BuildError::NoRegion { region, .. } => match region {
            Region::Name(name) => (
                Culprit::Region(name.clone()),
                format!("the mesh has no region `{name}`"),
            ),
            Region::Number(number) => (
                Culprit::Material,
                format!("the mesh has no region {number}"),
            ),
        },
        BuildError::OutOfRange { name, value } => (
            Culprit::Shape,
            format!(
                "the {name} of the body is {value:e}, and what can be stepped lies between 1e-36 and 1e36: choose a size, thickness, density and modulus nearer to one"
            ),
        ),
        BuildError::Place { place: [x, y], .. } => (
            Culprit::Translation,
            format!(
                "a node lies at ({x:e}, {y:e}) m, farther than can be computed: make the body smaller, or put it nearer to the origin"
            ),
        ),
        BuildError::Number { name, value, cure } => {
            let culprit = match *name {
                "linvel.x" | "linvel.y" | "angvel" | "the velocity of a node" => Culprit::Velocity,
                "translation.x" | "translation.y" | "rotation" => Culprit::Translation,
                _ => Culprit::Name,
            };
            (culprit, format!("{name} is {value}: {cure}"))
        }
        BuildError::RotatingPins => (
            Culprit::Pin,
            "the pins of the body hold some displacement but leave it free to turn: hold one node along x and y (a hinge), or another one so that it cannot turn".to_owned(),
        ),
        error => (Culprit::Name, error.to_string()),
    }
}

fn of_model(error: &ModelError, mesh: &Mesh) -> (Culprit, String) {
    match error {
        ModelError::RegionDamping(region) => {
            let mut names = mesh.region_names();
            let name = names.find(|(own, _)| own == region).map(|(_, name)| name);
            let name = name.map_or_else(|| region.to_string(), str::to_owned);
            let what = format!(
                "the material of region `{name}` has other `rayleigh` or `drag` than the rest of the body, which is damped as one: give all of them the same"
            );
            (Culprit::Region(name), what)
        }
        ModelError::Thickness(_) => (Culprit::Name, error.to_string()),
        ModelError::Element { cell, .. } => (
            Culprit::Cell,
            format!(
                "cell {cell} is turned over or all but flat, or its material has no stiffness: mesh the body anew"
            ),
        ),
        error => (Culprit::Shape, error.to_string()),
    }
}

/// What of an attachment is at fault.
pub enum AttachCulprit {
    Kind,
    Nodes,
    To,
}

/// What is wrong, and with what.
pub fn of_attachment(error: &AttachmentError, mesh: &Mesh) -> (AttachCulprit, String) {
    let place = |node: usize| {
        let found = mesh.nodes().get(node);
        found.map_or_else(String::new, |[x, y]| format!(" at [{x}, {y}]"))
    };
    match error {
        AttachmentError::PinnedNode(node) => (
            AttachCulprit::Nodes,
            format!(
                "the node{} is held by a `pin` and cannot move: choose others, or leave the pin out",
                place(*node)
            ),
        ),
        AttachmentError::InteriorNode(node) => (
            AttachCulprit::Nodes,
            format!("the node{} lies inside the body: choose some of its boundary", place(*node)),
        ),
        AttachmentError::WeldOfOne => (
            AttachCulprit::Kind,
            "a weld of one node cannot keep a direction: choose two nodes or more, or `kind = \"pin\"`"
                .to_owned(),
        ),
        AttachmentError::SameBody => (
            AttachCulprit::To,
            "a body cannot be attached to itself: name another one".to_owned(),
        ),
        AttachmentError::TooFar { distance, most } => (
            AttachCulprit::Nodes,
            format!(
                "the nodes are {distance} m from where they are to be held on the other body, beyond {most} m, half the size of the smaller one: put the bodies nearer, or take a `spring`"
            ),
        ),
        AttachmentError::Strained { nodes: [one, other], length, held } => (
            AttachCulprit::Nodes,
            format!(
                "the nodes{} and{} are {length} m apart and would be held {held} m apart: choose only nodes that lie along the other body's surface",
                place(*one),
                place(*other)
            ),
        ),
        AttachmentError::Negative(name) => (
            AttachCulprit::Kind,
            format!("the {name} is negative: give zero or more"),
        ),
        AttachmentError::NotFinite(_) => (
            AttachCulprit::Kind,
            "stiffness and damping are to be finite numbers up to 1e18".to_owned(),
        ),
        AttachmentError::Body(FlexBodyError::NotFinite(_)) => (
            AttachCulprit::Kind,
            "stiffness and damping are to be finite numbers up to 1e18".to_owned(),
        ),
        error => (AttachCulprit::Nodes, error.to_string()),
    }
}
