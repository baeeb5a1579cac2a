use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

fn spin(e: f64, beta: f64, w0: f64, dt: f64, t: f64, inertia: ContactInertia, vib: f64, integ: Beta2) {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = dt as _;
    let mut set = FlexBodySet::new();
    let nodes = Mesh::clone(FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4]).material(LinearElastic::plane_stress(e, 0.3).density(1000.0)).build().unwrap().mesh()).nodes().to_vec();
    let vel: Vec<[f64;2]> = nodes.iter().map(|p| [vib * (p[0]-0.5), -vib*0.3 * (p[1]-0.25)]).collect();
    let b = set.insert(FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4])
        .material(LinearElastic::plane_stress(e, 0.3).density(1000.0).rayleigh(beta))
        .contact_inertia(inertia.clone())
        .velocities(vel)
        .translation([3.0, 0.0]).angvel(w0).linvel([0.3, 0.1]), &mut world).unwrap();
    let mut flex = FlexPipeline::new().with_integrator(integ);
    let mut e0 = 0.0; let (mut emin, mut emax) = (f64::MAX, f64::MIN); let mut l0 = 0.0; let mut lerr = 0.0f64; let mut nn = 0; let mut p0 = [0.0; 2]; let mut perr = 0.0f64;
    let steps = (t / dt) as usize;
    for k in 0..steps {
        let r = match flex.step(&mut world, &mut set) { Ok(r) => r, Err(e) => { println!("ERR {e}"); return; } };
        let en = r.energy().kinetic + r.energy().elastic;
        if k == 0 { e0 = en; l0 = r.angular_momentum(); p0 = r.momentum(); }
        emax = emax.max(en); emin = emin.min(en);
        lerr = lerr.max((r.angular_momentum() / l0 - 1.0).abs());
        perr = perr.max(((r.momentum()[0] - p0[0]) / p0[0]).abs());
        nn = nn.max(r.n_newton());
        if std::env::var("DBG").is_ok() && k < 40 { println!("k {k} L {:.6} p {:?} E {:.4} newton {} contacts {} angle {:.5}", r.angular_momentum(), r.momentum(), en, r.n_newton(), r.contacts().len(), 0.0); }
    }
    println!("{inertia:?} E={e:.0e} beta={beta:.0e} w={w0} vib={vib} dt=1/{:.0} steps {steps}: E/E0 in [{:.3e}, {:.3e}] dL {lerr:.1e} dp {perr:.1e} newton {nn} angle {}", 1.0 / dt, emin / e0 - 1.0, emax / e0 - 1.0, set[b].angle());
}

fn main() {
    for rho in [1.0, 0.9] {
    println!("rho {rho}");
    for (w, v) in [(1.0, 0.1), (5.0, 1.0), (30.0, 0.1), (30.0, 1.0)] {
    for e in [1e6, 1e9, 2e11] { for dt in [1.0/60.0, 1.0/240.0] {
        spin(e, 0.0, w, dt, 20.0, ContactInertia::Redistributed, v, Beta2::damped(rho).unwrap());
    } } } }
}
