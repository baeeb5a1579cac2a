//! Elements and materials of the user's: saved by name, known again, or refused.

use super::support::*;
use foil2d::fe::element::{Element, QuadraturePoint, Tri3};
use foil2d::fe::material::hyperelastic::{
    Gent, Hyperelastic, MooneyRivlin, MooneyRivlinSheet, NeoHookeanSheet,
};
use foil2d::fe::record::{ElementRecord, KnownLaws, MaterialRecord, ModelRecordError};
use foil2d::pipeline::{Snapshot, SnapshotError};
use std::sync::Arc;

/// Hooke's law under another name, or none.
#[derive(Debug)]
struct Own {
    law: LinearElastic,
    name: Option<&'static str>,
}

impl Material for Own {
    fn density(&self) -> f64 {
        Material::density(&self.law)
    }

    fn stress(&self, strain: [f64; 3]) -> [f64; 3] {
        self.law.stress(strain)
    }

    fn tangent(&self, strain: [f64; 3]) -> [[f64; 3]; 3] {
        self.law.tangent(strain)
    }

    fn energy_density(&self, strain: [f64; 3]) -> f64 {
        self.law.energy_density(strain)
    }

    fn out_of_plane_stress(&self, strain: [f64; 3]) -> f64 {
        self.law.out_of_plane_stress(strain)
    }

    fn wave_speed(&self) -> f64 {
        self.law.wave_speed()
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn record(&self) -> MaterialRecord {
        match self.name {
            Some(name) => MaterialRecord::Named(name.to_owned()),
            None => MaterialRecord::Unknown,
        }
    }
}

/// The linear triangle under another name, or none.
#[derive(Debug)]
struct OwnTriangle(Option<&'static str>);

impl Element for OwnTriangle {
    fn name(&self) -> &'static str {
        "OwnTriangle"
    }

    fn n_corners(&self) -> usize {
        3
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        Tri3.reference_nodes()
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        Tri3.edges()
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        Tri3.quadrature()
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        Tri3.mass_quadrature()
    }

    fn shape(&self, at: [f64; 2], shape: &mut [f64]) {
        Tri3.shape(at, shape);
    }

    fn shape_gradient(&self, at: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        Tri3.shape_gradient(at, shape_gradient);
    }

    fn record(&self) -> ElementRecord {
        match self.0 {
            Some(name) => ElementRecord::Named(name.to_owned()),
            None => ElementRecord::Unknown,
        }
    }
}

fn own(young: f64, name: Option<&'static str>) -> Own {
    let law = LinearElastic::plane_stress(young, 0.3).density(1000.0);
    Own { law, name }
}

fn run(material: Own, element: OwnTriangle) -> (Run, FlexBodyHandle) {
    let mut run = Run::new();
    let body = FlexBodyBuilder::rectangle_of([0.5, 0.5], [4, 4], CellKind::Tri3)
        .element(element)
        .material(material)
        .small_strain()
        .translation([0.0, 0.01]);
    let body = run.flexible(body);
    (0..20).for_each(|_| run.step(&Recorder::default()));
    (run, body)
}

fn taken(run: &Run) -> Result<Snapshot, SnapshotError> {
    Snapshot::take(&run.world, &run.flex_bodies, &run.flex)
}

#[test]
fn a_law_without_a_name_is_refused_when_it_is_saved() {
    let (no_material, body) = run(own(1e6, None), OwnTriangle(Some("triangle")));
    let error = taken(&no_material).expect_err("nobody could find it again");
    let SnapshotError::Body {
        body: named,
        source: ModelRecordError::UnnamedMaterial(text),
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!(named, body);
    assert!(text.contains("Own"), "{text}");
    let (no_element, body) = run(own(1e6, Some("mine")), OwnTriangle(None));
    let source = ModelRecordError::UnnamedElement("OwnTriangle");
    assert_eq!(
        taken(&no_element).err(),
        Some(SnapshotError::Body { body, source })
    );
}

#[test]
fn laws_of_the_users_own_are_found_by_name_and_resume_bit_for_bit() {
    let (mut straight, _) = run(own(1e6, Some("mine")), OwnTriangle(Some("triangle")));
    let laws = KnownLaws::new()
        .material("mine", own(1e6, Some("mine")))
        .element("triangle", OwnTriangle(Some("triangle")));
    let snapshot: Snapshot = postcard::from_bytes(&straight.bytes()).expect("a snapshot is read");
    let (world, flex_bodies, flex) = snapshot.restore_with(&laws).expect("all laws are known");
    let mut resumed = Run {
        world,
        flex_bodies,
        flex,
        n_steps: straight.n_steps,
        held: None,
    };
    compare(&mut straight, &mut resumed, 100);
}

#[test]
fn unknown_or_changed_laws_are_refused_when_they_are_restored() {
    let (straight, body) = run(own(1e6, Some("mine")), OwnTriangle(Some("triangle")));
    let refused = |laws: KnownLaws| {
        let snapshot = taken(&straight).expect("all have names");
        let error = snapshot.restore_with(&laws).err().expect("it is refused");
        match error {
            SnapshotError::Body {
                body: named,
                source,
            } => {
                assert_eq!(named, body);
                source
            }
            other => panic!("{other}"),
        }
    };
    let name = MaterialRecord::Named("mine".to_owned());
    assert_eq!(
        refused(KnownLaws::new()),
        ModelRecordError::UnknownMaterial(name)
    );
    let material = || KnownLaws::new().material("mine", own(1e6, Some("mine")));
    let name = ElementRecord::Named("triangle".to_owned());
    assert_eq!(refused(material()), ModelRecordError::UnknownElement(name));
    let softer = KnownLaws::new().material("mine", own(9e5, Some("mine")));
    let changed = softer.element("triangle", OwnTriangle(Some("triangle")));
    assert_eq!(refused(changed), ModelRecordError::Differs);
}

#[test]
fn regions_with_their_names_and_materials_resume_bit_for_bit() {
    for is_large in [true, false] {
        let mesh = foil2d::fe::mesh::generate::rectangle([0.5, 0.5], [4, 4], CellKind::Tri3)
            .expect("a square")
            .with_regions_by(|[x, _]| 2 * u32::from(x > 0.2))
            .with_region_name(2, "heavy")
            .expect("it has cells");
        let body = FlexBodyBuilder::mesh(mesh)
            .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
            .region_material(
                "heavy",
                LinearElastic::plane_stress(2e6, 0.3).density(2000.0),
            )
            .translation([0.0, 0.01]);
        let mut straight = Run::new();
        let handle = straight.flexible(match is_large {
            true => body.large_strain(),
            false => body.small_strain(),
        });
        (0..20).for_each(|_| straight.step(&Recorder::default()));
        let mut resumed = straight.resumed();
        let restored = &resumed.flex_bodies[handle];
        assert_eq!(restored.mesh(), straight.flex_bodies[handle].mesh());
        assert_eq!(restored.mesh().region_named("heavy"), Some(2));
        compare(&mut straight, &mut resumed, 60);
    }
}

#[test]
fn laws_of_rubber_and_sheets_are_saved_with_their_parameters() {
    let solid = |law: Arc<dyn Hyperelastic>| HyperelasticSolid::of(law).with_density(1000.0);
    let laws: [Arc<dyn Hyperelastic>; 4] = [
        Arc::new(NeoHookeanSheet::plane_stress(1e5, 0.5)),
        Arc::new(MooneyRivlin::plane_strain(2e4, 3e3, 0.45)),
        Arc::new(MooneyRivlinSheet::plane_stress(2e4, 3e3)),
        Arc::new(Gent::plane_strain(1e5, 0.45, 30.0)),
    ];
    for law in laws {
        let mut straight = Run::new();
        let body = FlexBodyBuilder::rectangle_of([0.5, 0.5], [2, 2], CellKind::Quad8)
            .material(solid(Arc::clone(&law)))
            .translation([0.0, 0.01]);
        straight.flexible(body);
        (0..10).for_each(|_| straight.step(&Recorder::default()));
        let mut resumed = straight.resumed();
        compare(&mut straight, &mut resumed, 30);
        let energy = straight
            .flex_bodies
            .iter()
            .next()
            .map(|(_, body)| body.energy().elastic);
        assert!(energy.is_some_and(|energy| energy > 0.0), "{}", law.name());
    }
}
