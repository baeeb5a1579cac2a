//! Regions, a gas that is shut in and plastic flow in one body.

use foil2d::body::BuildError;
use foil2d::fe::finite_strain::ATMOSPHERE;
use foil2d::fe::material::hyperelastic::{HyperelasticSolid, J2Plasticity, NeoHookean};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

fn metal(yield_stress: f64) -> HyperelasticSolid {
    let law = J2Plasticity::plane_strain(2e5, 0.3, yield_stress).with_hardening(4e4);
    HyperelasticSolid::new(law).with_density(2000.0)
}

/// A ring whose outer half is of metal, with a gas in its hole, that spins so fast that the metal flows.
fn ring() -> FlexBodyBuilder {
    let rubber = HyperelasticSolid::new(NeoHookean::plane_strain(1e5, 0.4)).with_density(1000.0);
    FlexBodyBuilder::annulus(0.3, 0.5, 0.1)
        .material(rubber)
        .regions_by(|[x, y]| u32::from(x.hypot(y) > 0.4))
        .region_material(1, metal(500.0))
        .inner_pressure(InnerPressure::isothermal(500.0))
        .angvel(3.0)
}

#[test]
fn a_ring_of_metal_and_rubber_with_a_gas_accounts_for_its_energy_and_keeps_its_momenta() {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 1.0 / 240.0;
    let mut flex_bodies = FlexBodySet::new();
    let ring = flex_bodies.insert(ring(), &mut world).expect("a ring");
    let mut flex = FlexPipeline::new().with_integrator(Beta2::trapezoidal());
    let body = &flex_bodies[ring];
    let energy = |body: &FlexBody| body.energy().kinetic + body.energy().elastic;
    let (before, spin) = (energy(body), body.angular_momentum([0.0; 2]));
    // Pressure and area of the gas, the outside counted.
    let gas = |body: &FlexBody| {
        let pressure = ATMOSPHERE + body.gas_pressure(0).expect("a hole");
        [pressure, body.inner_area(0).expect("a hole")]
    };
    let [pressure, area] = gas(body);
    assert!(
        (pressure - ATMOSPHERE - 500.0).abs() < 1e-6,
        "{pressure} Pa"
    );
    for step in 0..200 {
        flex.step(&mut world, &mut flex_bodies).expect("a step");
        let body = &flex_bodies[ring];
        let account = energy(body) + body.plastic_dissipation();
        assert!(
            (account / before - 1.0).abs() < 1e-6,
            "step {step}: {account} of {before} J"
        );
        let turned = body.angular_momentum([0.0; 2]);
        assert!(
            (turned / spin - 1.0).abs() < 1e-8,
            "step {step}: {turned} of {spin}"
        );
    }
    let body = &flex_bodies[ring];
    assert!(
        body.max_plastic_strain() > 1e-3,
        "{}",
        body.max_plastic_strain()
    );
    // The rubber does not flow.
    for (index, cell) in body.mesh().cells().enumerate() {
        let largest = body.plastic_strains(index).into_iter().fold(0.0, f64::max);
        assert!(cell.region == 1 || largest == 0.0, "cell {index}");
    }
    let [now, grown] = gas(body);
    assert!(
        (grown / area - 1.0).abs() > 1e-3,
        "the hole has another size"
    );
    assert!(
        (now * grown / (pressure * area) - 1.0).abs() < 1e-12,
        "{now} Pa"
    );
}

#[test]
fn what_has_flowed_keeps_its_law_and_the_others_may_change() {
    let mut ring = ring().build().expect("a ring");
    let other = HyperelasticSolid::new(NeoHookean::plane_strain(2e5, 0.4)).with_density(1500.0);
    let before = ring.mass();
    ring.set_region_material(0, other.clone())
        .expect("the rubber may be another");
    assert!(ring.mass() > before);
    let refused = ring.set_region_material(1, other);
    assert_eq!(refused.err(), Some(BuildError::FlowChanged));
    let refused = ring.set_region_material(1, metal(600.0));
    assert_eq!(refused.err(), Some(BuildError::FlowChanged));
    let small = self::ring().small_strain().build();
    assert!(matches!(
        small.err(),
        Some(BuildError::FlowSmallStrain { .. })
    ));
}
