//! What is no pre-stretch is refused, by name and with the world as it was.

use crate::support::*;
use foil2d::body::BuildError;
use foil2d::fe::material::hyperelastic::{Gent, J2Plasticity};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

fn refused(body: FlexBodyBuilder) -> BuildError {
    let mut world = PhysicsWorld::new();
    let mut flex_bodies = FlexBodySet::new();
    world.insert_collider(ColliderBuilder::ball(1.0), None);
    let error = flex_bodies.insert(body, &mut world).expect_err("refused");
    assert!(flex_bodies.is_empty());
    assert_eq!((world.bodies.len(), world.colliders.len()), (0, 1));
    error
}

#[test]
fn numbers_that_are_no_stretches_are_refused() {
    for bad in [0.0, -1.05, f64::NAN, f64::INFINITY] {
        for stretch in [
            PreStretch::from([bad, 1.0]),
            PreStretch::from([1.0, bad]),
            PreStretch::along_x(bad),
            PreStretch::along_y(bad),
        ] {
            let error = refused(strip(hooke()).pre_stretch(stretch));
            assert!(
                matches!(
                    error,
                    BuildError::Number {
                        name: "pre_stretch",
                        ..
                    }
                ),
                "{error}"
            );
        }
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let error = refused(strip(hooke()).pre_stretch(PreStretch::by_stress([0.0, bad])));
        assert!(matches!(error, BuildError::Number { .. }), "{error}");
    }
}

#[test]
fn what_the_material_cannot_bear_is_refused() {
    // Gent's chains are straight at t + 1 - 3 = 1: at a stretch of about 1.6.
    let gent = || HyperelasticSolid::new(Gent::plane_strain(1e6, 0.45, 1.0)).with_density(1e3);
    let metal = J2Plasticity::plane_strain(2.1e11, 0.3, 2.5e8);
    let metal = HyperelasticSolid::new(metal).with_density(7800.0);
    let beyond = |error: BuildError| matches!(error, BuildError::PreStretchBeyond { .. });
    assert!(beyond(refused(strip(gent()).pre_stretch([2.0, 1.0]))));
    let along = PreStretch::along_x(2.0);
    assert!(beyond(refused(strip(gent()).pre_stretch(along))));
    // Crushed by more than any number of its modulus.
    let crushed = PreStretch::by_stress([1e-300, -1e300]);
    assert!(beyond(refused(strip(hooke()).pre_stretch(crushed))));
    // Pulled both ways, its stress per area as stretched is (μ (λ² - 1) + 2 L ln λ)/λ²: at most 0.845 MPa, at λ = 2.95.
    let pulled = PreStretch::by_stress([8.6e5, 8.6e5]);
    assert!(beyond(refused(strip(hooke()).pre_stretch(pulled))));
    let error = refused(strip(metal).pre_stretch(PreStretch::along_x(1.01)));
    assert!(
        matches!(error, BuildError::PreStretchFlows { .. }),
        "{error}"
    );
    for far in [1e-30, 1e30, 1e-200, 1e200, 1e308, 1e-320] {
        for stretch in [PreStretch::from([far, 1.0]), PreStretch::along_x(far)] {
            refused(strip(hooke()).pre_stretch(stretch));
        }
    }
}

#[test]
fn bodies_of_small_strain_and_regions_at_odds_are_refused() {
    let small = strip(hooke()).small_strain().pre_stretch([1.05, 1.0]);
    assert_eq!(refused(small), BuildError::PreStretchSmallStrain);
    let consistent = strip(hooke()).mass_kind(MassKind::Consistent);
    assert_eq!(
        refused(consistent.pre_stretch([1.05, 1.0])),
        BuildError::LargeConsistent
    );
    let regions = || {
        strip(hooke())
            .regions_by(|[_, y]| u32::from(y > 0.5 * HEIGHT))
            .region_material(1, LinearElastic::plane_stress(YOUNG, 0.0).density(DENSITY))
    };
    let error = refused(regions().pre_stretch(PreStretch::along_x(1.05)));
    assert!(
        matches!(error, BuildError::PreStretchRegion { region: 1, .. }),
        "{error}"
    );
    assert!(regions().pre_stretch([1.05, 1.0]).build().is_ok());
}
