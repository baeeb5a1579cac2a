//! Once warm, the flexible stage allocates nothing: a counting allocator tells its allocations from rapier's by their
//! call stack.

use foil2d::body::BuildError;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::backtrace::Backtrace;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// Most call stacks kept; they are slow to resolve.
const MOST_STACKS: usize = 2000;

thread_local! {
    static IS_COUNTING: Cell<bool> = const { Cell::new(false) };
    static COUNT: Cell<usize> = const { Cell::new(0) };
    static STACKS: RefCell<Vec<Backtrace>> = const { RefCell::new(Vec::new()) };
}

struct Counting;

/// Counts this thread's allocations while it is asked to; what it allocates itself is not counted.
fn count() {
    let is_counting = IS_COUNTING
        .try_with(|on| on.replace(false))
        .unwrap_or(false);
    if !is_counting {
        return;
    }
    COUNT.with(|count| count.set(count.get() + 1));
    STACKS.with(|stacks| {
        let mut stacks = stacks.borrow_mut();
        if stacks.len() < MOST_STACKS {
            stacks.push(Backtrace::force_capture());
        }
    });
    IS_COUNTING.with(|on| on.set(true));
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of some work: all of them, and the call stacks of the first.
fn allocations(work: impl FnOnce()) -> (usize, Vec<String>) {
    COUNT.set(0);
    IS_COUNTING.set(true);
    work();
    IS_COUNTING.set(false);
    let stacks = STACKS.take();
    (
        COUNT.get(),
        stacks.iter().map(ToString::to_string).collect(),
    )
}

/// Who allocates in a call stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Who {
    /// Rapier, within one of its two steps.
    RapiersStep,
    /// Rapier's list of changed bodies and colliders, as it hands one out to be written: it drops the list every step.
    RapiersChangeList,
    /// The flexible stage.
    Ours,
}

fn who(stack: &str) -> Who {
    // A frame is two lines, "12: function" and "at file:line", innermost first; some have no second line.
    let is_own_file = |line: &str| line.trim_start().starts_with("at ./src/");
    let inner: String = stack
        .lines()
        .take_while(|line| !is_own_file(line))
        .collect();
    if stack.contains("physics_pipeline") {
        Who::RapiersStep
    } else if inner.contains("rapier2d") && inner.contains("get_mut") {
        Who::RapiersChangeList
    } else {
        Who::Ours
    }
}

/// The innermost line of this crate's sources in a call stack, and the function there.
fn place(stack: &str) -> String {
    let lines: Vec<&str> = stack.lines().collect();
    let own = lines
        .iter()
        .position(|line| line.trim_start().starts_with("at ./src/"));
    own.map_or_else(
        || stack.to_owned(),
        |at| format!("{} ({})", lines[at].trim(), lines[at - 1].trim()),
    )
}

/// A world that has been stepped until its contacts are steady.
struct Warm {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
}

impl Warm {
    fn new() -> Self {
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(20.0, 0.5).translation(Vector::new(0.0, -0.5));
        world.insert_collider(floor, None);
        Self {
            world,
            flex_bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
        }
    }

    fn with(mut self, builder: FlexBodyBuilder) -> Result<Self, BuildError> {
        self.flex_bodies.insert(builder, &mut self.world)?;
        Ok(self)
    }

    fn with_box(mut self, half: [f64; 2], at: [f64; 2]) -> Self {
        let real = |x: f64| x as foil2d::rapier::math::Real;
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(real(at[0]), real(at[1])));
        let shape = ColliderBuilder::cuboid(real(half[0]), real(half[1])).density(300.0);
        self.world.insert(body, shape);
        self
    }

    fn step(&mut self) {
        self.flex
            .step(&mut self.world, &mut self.flex_bodies)
            .expect("a steady scene");
    }

    /// Holds that ten steps allocate nothing outside rapier; `n_contacts` is what the scene must show.
    #[track_caller]
    fn assert_quiet(mut self, name: &str, warm_up: usize, n_contacts: usize) {
        (0..warm_up).for_each(|_| self.step());
        let found = self.flex.report().contacts().len();
        assert!(found >= n_contacts, "{name}: {found} contacts");
        let (total, stacks) = allocations(|| (0..10).for_each(|_| self.step()));
        let (mut counts, mut own) = (BTreeMap::new(), BTreeMap::new());
        for stack in &stacks {
            let who = who(stack);
            *counts.entry(who).or_insert(0) += 1;
            if who == Who::Ours {
                *own.entry(place(stack)).or_insert(0) += 1;
            }
        }
        println!("{name}: {total} allocations in 10 steps, {counts:?}");
        assert_eq!(total, stacks.len(), "{name}: more than can be told apart");
        assert!(own.is_empty(), "{name}: {own:#?}");
    }
}

fn rubber() -> LinearElastic {
    LinearElastic::plane_stress(1e7, 0.3)
        .density(1000.0)
        .rayleigh(5e-3)
}

fn beam() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([4.0, 0.3], [24, 3])
        .material(rubber())
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
        .translation([-2.0, 1.0])
}

fn block() -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [6, 6])
        .material(rubber())
        .friction(0.6)
        .translation([0.0, 0.001])
}

#[test]
fn the_counter_counts() {
    let (total, stacks) = allocations(|| drop(std::hint::black_box(vec![1u8; 100])));
    assert_eq!((total, stacks.len()), (1, 1));
    assert_eq!(who(&stacks[0]), Who::Ours);
    // A first step makes rapier's buffers: its allocations are told apart.
    let mut world = PhysicsWorld::new();
    let (body, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.5));
    let (total, stacks) = allocations(|| world.step());
    assert!(total > 0);
    for stack in &stacks {
        assert_eq!(who(stack), Who::RapiersStep, "{stack}");
    }
    let (total, stacks) = allocations(|| {
        world.bodies[body].set_linvel(Vector::ZERO, true);
    });
    assert!(total <= 1 && stacks.iter().all(|stack| who(stack) != Who::RapiersStep));
}

#[test]
fn a_block_that_rests_on_the_floor_with_friction_allocates_nothing() -> Result<(), BuildError> {
    Warm::new()
        .with(block())?
        .assert_quiet("block on floor", 300, 5);
    Ok(())
}

/// Its factor is made anew in every step, in the room it has.
#[test]
fn a_block_of_large_strain_on_the_floor_allocates_nothing() -> Result<(), BuildError> {
    let solid = HyperelasticSolid::new(NeoHookean::plane_strain(1e6, 0.3)).with_density(1000.0);
    let block = FlexBodyBuilder::rectangle_of([1.0, 1.0], [3, 3], CellKind::Tri6)
        .material(solid)
        .friction(0.6)
        .can_sleep(false)
        .translation([0.0, 0.001]);
    let warm = Warm::new().with(block)?;
    warm.assert_quiet("block of large strain on floor", 300, 4);
    Ok(())
}

#[test]
fn events_and_hooks_of_resting_bodies_allocate_nothing() -> Result<(), BuildError> {
    let listening = block()
        .active_events(ActiveEvents::all())
        .active_hooks(ActiveHooks::all());
    Warm::new()
        .with(listening)?
        .with_box([0.2, 0.2], [0.5, 1.202])
        .assert_quiet("events and hooks", 300, 7);
    Ok(())
}

#[test]
fn a_rigid_box_on_a_flexible_beam_allocates_nothing() -> Result<(), BuildError> {
    Warm::new()
        .with(beam())?
        .with_box([0.2, 0.2], [0.0, 1.501])
        .assert_quiet("box on beam", 300, 2);
    Ok(())
}

#[test]
fn a_stack_of_rigid_boxes_on_a_flexible_beam_allocates_nothing() -> Result<(), BuildError> {
    Warm::new()
        .with(beam())?
        .with_box([0.2, 0.2], [0.0, 1.501])
        .with_box([0.2, 0.2], [0.0, 1.902])
        .with_box([0.2, 0.2], [0.0, 2.303])
        .assert_quiet("stack on beam", 300, 6);
    Ok(())
}

#[test]
fn a_flexible_block_on_a_flexible_beam_allocates_nothing() -> Result<(), BuildError> {
    let small = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4])
        .material(rubber())
        .translation([-0.23, 1.301]);
    Warm::new()
        .with(beam())?
        .with(small)?
        .assert_quiet("block on beam", 300, 2);
    Ok(())
}

#[test]
fn joints_and_attachments_allocate_nothing() -> Result<(), BuildError> {
    let mut warm = Warm::new().with(beam())?;
    let small = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4])
        .material(rubber())
        .translation([-0.23, 2.5]);
    let small = warm.flex_bodies.insert(small, &mut warm.world)?;
    // A box on the beam, two more on hinges and a motor from it, and a block welded to the last.
    let bodies: Vec<RigidBodyHandle> = [[0.0, 1.501], [0.6, 1.9], [0.02, 2.3]]
        .into_iter()
        .map(|[x, y]| {
            let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, y));
            let shape = ColliderBuilder::cuboid(0.2, 0.2).density(300.0);
            warm.world.insert(body, shape).0
        })
        .collect();
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(Vector::new(0.3, 0.2))
        .local_anchor2(Vector::new(-0.3, -0.2))
        .motor_position(0.0, 500.0, 50.0);
    warm.world
        .impulse_joints
        .insert(bodies[0], bodies[1], hinge, true);
    let weld = FixedJointBuilder::new()
        .local_anchor1(Vector::new(-0.3, 0.2))
        .local_anchor2(Vector::new(0.28, -0.2));
    warm.world
        .impulse_joints
        .insert(bodies[1], bodies[2], weld, true);
    let weld = AttachmentBuilder::weld(small)
        .where_(|[_, y]| y == 0.0)
        .to_rigid_body(bodies[2]);
    warm.flex_bodies
        .attach(weld, &warm.world.bodies)
        .expect("the description is right");
    warm.assert_quiet("joints", 600, 1);
    Ok(())
}

#[test]
fn explicit_steps_allocate_nothing() -> Result<(), BuildError> {
    for inertia in [ContactInertia::Redistributed, ContactInertia::Kept] {
        let mut warm = Warm::new();
        warm.flex = warm.flex.with_integrator(Beta2::central_difference());
        warm.world.integration_parameters.dt = 2e-4;
        let soft = LinearElastic::plane_stress(1e6, 0.3)
            .density(1000.0)
            .rayleigh(1e-4)
            .rayleigh_mass(5.0);
        let body = block()
            .small_strain()
            .material(soft)
            .contact_inertia(inertia);
        warm.with(body)?
            .with_box([0.2, 0.1], [0.5, 1.101])
            .assert_quiet("explicit", 6000, 5);
    }
    Ok(())
}

#[test]
fn a_free_spinning_body_allocates_nothing() -> Result<(), BuildError> {
    let spinner = block()
        .translation([0.0, 50.0])
        .gravity_scale(0.0)
        .angvel(3.0);
    Warm::new()
        .with(spinner)?
        .assert_quiet("free spinning body", 60, 0);
    Ok(())
}

#[test]
fn a_non_linear_step_allocates_nothing_once_warm() {
    use foil2d::nonlinear::{CubicSpring, InternalForce, NewtonSettings, NonLinearStepper};

    /// Hides the tangent, so that differences are taken.
    struct Hidden(CubicSpring);
    impl InternalForce for Hidden {
        fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]) {
            self.0.force(position, velocity, force);
        }
    }
    let spring = CubicSpring {
        linear: 4.0,
        cubic: 30.0,
        damping: 0.1,
    };
    let laws: [&dyn InternalForce; 2] = [&spring, &Hidden(spring)];
    for law in laws {
        let method = Beta2::trapezoidal();
        let settings = NewtonSettings::default();
        let mut stepper = NonLinearStepper::lumped(&[1.0, 2.0], method, settings)
            .expect("sound masses and settings");
        let load = [0.0, 1.0];
        let mut motion = stepper
            .start(law, &load, vec![1.0, -0.5], vec![0.0; 2])
            .expect("every dof has mass");
        let mut step = |dt: f64| {
            let report = stepper.step(dt, law, &load, &mut motion);
            report.expect("it converges").n_iterations()
        };
        // A long step takes the most iterations, and their list is kept.
        step(0.3);
        let (count, stacks) = allocations(|| {
            for _ in 0..20 {
                step(0.02);
            }
        });
        assert_eq!(count, 0, "{stacks:?}");
    }
}

/// A large body is stepped without an allocation from its first step on: factors are renewed and steps halved in place.
#[test]
fn a_large_body_allocates_nothing() {
    use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
    use foil2d::fe::material::hyperelastic::StableNeoHookean;
    use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};

    let mesh = foil2d::fe::mesh::generate::rectangle([1.0, 1.0], [4, 4], CellKind::Tri6).unwrap();
    let law = StableNeoHookean::plane_strain(1e5, 0.3);
    let description = FiniteStrainDescription::new(mesh, law, 1000.0);
    let model = FiniteStrainModel::assemble(description).unwrap();
    let mut motion = WorldMotion::at_rest(&model);
    let rest = motion.position.clone();
    let load = vec![0.0; model.n_dofs()];
    let mut stepper = LargeStepper::new(model, LargeSettings::default()).unwrap();
    stepper.pin_where(|[_, y]| y == 0.0 || y == 1.0, Pin::both());
    let (mut n_cutbacks, mut n_factorizations) = (0, 0);
    let (count, stacks) = allocations(|| {
        for step in 0..30 {
            for node in 0..rest.len() / 2 {
                let is_upper = rest[2 * node + 1] == 1.0;
                motion.velocity[2 * node + 1] = match is_upper {
                    true if step < 2 => -20.0,
                    true => 0.0,
                    false => motion.velocity[2 * node + 1],
                };
            }
            let work = stepper.step(1.0 / 60.0, &load, &mut motion).unwrap();
            n_cutbacks += work.n_cutbacks;
            n_factorizations += work.n_factorizations;
        }
    });
    assert!(n_cutbacks > 0 && n_factorizations > 10);
    assert_eq!(count, 0, "{}", stacks.first().map_or("", String::as_str));
}
