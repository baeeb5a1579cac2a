use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

fn block(e: f64, beta: f64, integ: Beta2, h: f64, dt: f64, t: f64, n: usize, rot: f64) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = dt as _;
    world.insert_collider(
        ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5)),
        None,
    );
    let mut set = FlexBodySet::new();
    let b = set
        .insert(
            FlexBodyBuilder::rectangle([1.0, 1.0], [n, n])
                .material(
                    LinearElastic::plane_stress(e, 0.3)
                        .density(1000.0)
                        .rayleigh(beta),
                )
                .rotation(rot)
                .translation([0.0, h]),
            &mut world,
        )
        .unwrap();
    let mut flex = FlexPipeline::new().with_integrator(integ);
    let w = 9.81 * set[b].mass();
    let mut e0 = 0.0;
    let mut emax = f64::MIN;
    let mut pen = 0.0f64;
    let mut fs = vec![];
    let mut nn = 0;
    let mut np = 0;
    let mut lim = 0.0;
    let steps = (t / dt) as usize;
    for k in 0..steps {
        let r = match flex.step(&mut world, &mut set) {
            Ok(r) => r,
            Err(e) => {
                println!("ERR {e}");
                return;
            }
        };
        let en = r.energy().total();
        if k == 0 {
            e0 = en;
        }
        emax = emax.max(en);
        lim += r.energy_limited();
        pen = pen.max(r.gap_violation());
        nn = nn.max(r.n_newton());
        np = np.max(r.n_pivots());
        if k + (1.0 / dt) as usize > steps {
            fs.push(set[b].total_contact_force()[1] / w);
        }
    }
    let mean = fs.iter().sum::<f64>() / fs.len() as f64;
    let sd = (fs.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / fs.len() as f64).sqrt();
    let r = flex.report();
    println!(
        "E={e:.0e} beta={beta:.0e} dt=1/{:.0} rot {rot}: F/W {mean:.6} sd {sd:.1e} v {:.1e} E0 {e0:.1} Emax-E0 {:.2e} Eend {:.1} lim {lim:.2e} pen {pen:.1e} newton {nn} pivots {np} res {:.1e} contacts {} com {:?} ang {:.4}",
        1.0 / dt,
        set[b].linvel()[1],
        emax - e0,
        r.energy().total(),
        r.solver_residual(),
        r.contacts().len(),
        set[b].centre_of_mass(),
        set[b].angle()
    );
}

fn main() {
    let d = Beta2::damped(0.9).unwrap();
    for rot in [0.0, 0.3] {
        for e in [1e5, 1e7, 2e11] {
            for beta in [0.0, 1e-3] {
                for (i, n) in [(Beta2::trapezoidal(), "TR"), (d, "d.9")] {
                    print!("{n} ");
                    block(e, beta, i, 0.1, 1.0 / 60.0, 6.0, 8, rot);
                }
            }
        }
    }
}
