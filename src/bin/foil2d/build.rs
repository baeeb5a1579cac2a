//! From a scene to a world.

use super::at::At;
use super::problem::Problem;
use super::scene::{
    AttachKind, Flexible, Integrator, Joint, JointKind, Law, MaterialSpec, Nodes, Rigid, RigidKind,
    RigidShape,
};
use super::shape::{Shaped, collider, no_such, shaped, vector};
use super::source::Source;
use foil2d::fe::material::Rayleigh;
use foil2d::fe::material::hyperelastic::Hyperelastic;
use foil2d::math::hypot;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Numbers beyond this are refused, as the library does.
const LARGEST: f64 = 1e18;

/// Lengths of steps (s), as the library takes them.
const SHORTEST: f64 = 1e-8;
const LONGEST: f64 = 1e4;

/// Steps of a run.
const MOST_STEPS: f64 = 1e9;

/// A world that is ready to be stepped.
pub struct Built {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub flexible: BTreeMap<String, FlexBodyHandle>,
    rigid: BTreeMap<String, RigidBodyHandle>,
    shaped: BTreeMap<String, Shaped>,
}

/// Builds the world of a scene.
pub fn build(source: &Source) -> Result<Built, Problem> {
    let spec = source.scene.world.get();
    check_world(source)?;
    let integrator = match spec.integrator {
        Integrator::Damped => Beta2::damped(spec.decay).map_err(Problem::plain)?,
        Integrator::Trapezoidal => Beta2::trapezoidal(),
        Integrator::CentralDifference => Beta2::central_difference(),
    };
    let mut world = PhysicsWorld::new();
    world.gravity = vector(spec.gravity);
    world.integration_parameters.dt = spec.dt as Real;
    let flex = FlexPipeline::new().with_integrator(integrator);
    let mut built = Built {
        world,
        flex_bodies: FlexBodySet::new(),
        flex: match spec.refuse_unsolved {
            true => flex.refusing_unsolved(),
            false => flex,
        },
        flexible: BTreeMap::new(),
        rigid: BTreeMap::new(),
        shaped: BTreeMap::new(),
    };
    for rigid in &source.scene.rigid {
        built.insert_rigid(source, rigid)?;
    }
    for body in &source.scene.flexible {
        built.insert_flexible(source, body)?;
    }
    for joint in &source.scene.joint {
        built.insert_joint(source, joint)?;
    }
    built.attach(source)?;
    Ok(built)
}

impl Built {
    fn insert_rigid(&mut self, source: &Source, rigid: &Rigid) -> Result<(), Problem> {
        check_rigid(source, rigid)?;
        let body = match rigid.kind {
            RigidKind::Dynamic => RigidBodyBuilder::dynamic(),
            RigidKind::Fixed => RigidBodyBuilder::fixed(),
            RigidKind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
        };
        let body = body
            .translation(vector(rigid.translation))
            .rotation(rigid.rotation as Real)
            .linvel(vector(rigid.linvel))
            .angvel(rigid.angvel as Real);
        let shape = collider(source, rigid.shape.get())?
            .density(rigid.density as Real)
            .friction(rigid.friction as Real)
            .restitution(rigid.restitution as Real);
        let (body, _) = self.world.insert(body, shape);
        if let Some(name) = &rigid.name {
            self.refuse_taken(source, name)?;
            self.rigid.insert(name.get().clone(), body);
        }
        Ok(())
    }

    fn insert_flexible(&mut self, source: &Source, spec: &Flexible) -> Result<(), Problem> {
        self.refuse_taken(source, &spec.name)?;
        let shaped =
            shaped(source, &spec.shape).map_err(|problem| source.problem(&spec.name, problem))?;
        let mut body = FlexBodyBuilder::mesh(shaped.mesh.clone())
            .translation(spec.translation)
            .rotation(spec.rotation)
            .linvel(spec.linvel)
            .angvel(spec.angvel)
            .thickness(spec.thickness)
            .friction(spec.friction)
            .restitution(spec.restitution);
        body = match material(source, &spec.material)? {
            Made::Linear(linear) => body.material(linear),
            Made::Hyperelastic(solid) => body.material(solid),
        };
        for (region, name) in &spec.regions {
            body = match material(source, name)? {
                Made::Linear(linear) => body.region_material(region.as_str(), linear),
                Made::Hyperelastic(solid) => body.region_material(region.as_str(), solid),
            };
        }
        if spec.small_strain {
            body = body.small_strain();
        }
        for pin in &spec.pin {
            let held = Pin { x: pin.x, y: pin.y };
            for node in nodes(source, &shaped, &pin.nodes)? {
                body = body.pin(node, held);
            }
        }
        for force in &spec.force {
            let chosen = nodes(source, &shaped, &force.nodes)?;
            let share = force.force.map(|all| all / chosen.len() as f64);
            for node in chosen {
                body = body.nodal_force(node, share);
            }
        }
        let handle = self
            .flex_bodies
            .insert(body, &mut self.world)
            .map_err(|error| source.problem(&spec.name, error))?;
        self.flexible.insert(spec.name.get().clone(), handle);
        self.shaped.insert(spec.name.get().clone(), shaped);
        Ok(())
    }

    fn refuse_taken(&self, source: &Source, name: &At<String>) -> Result<(), Problem> {
        let is_taken =
            self.rigid.contains_key(name.get()) || self.flexible.contains_key(name.get());
        match is_taken {
            true => Err(source.problem(
                name,
                format!(
                    "there is a body `{}` already: give each its own name",
                    name.get()
                ),
            )),
            false => Ok(()),
        }
    }

    fn insert_joint(&mut self, source: &Source, joint: &Joint) -> Result<(), Problem> {
        let ends = [0, 1].map(|end| self.rigid_named(source, &joint.between[end]));
        let [first, second] = ends;
        let (first, second) = (first?, second?);
        if first == second {
            return Err(source.problem(
                &joint.between[1],
                "a joint is between two bodies: name another one",
            ));
        }
        let place = *joint.at.get();
        let axis = match joint.kind {
            JointKind::Prismatic { axis } => axis,
            _ => [1.0, 0.0],
        };
        let is_sound = are_finite(&place) && are_finite(&axis) && hypot(axis[0], axis[1]) > 0.0;
        if !is_sound {
            return Err(source.problem(&joint.at, "a joint has a place, and a prismatic one an axis, of finite numbers, the axis not zero"));
        }
        let local = |handle: RigidBodyHandle, at: Vector| {
            let pose = self.world.bodies.get(handle).map(|body| *body.position());
            pose.unwrap_or(Pose::IDENTITY).inverse_transform_point(at)
        };
        let anchors = [first, second].map(|body| local(body, vector(place)));
        let turned = |handle: RigidBodyHandle, axis: [f64; 2]| {
            let body = self.world.bodies.get(handle);
            body.map_or(vector(axis), |body| {
                body.rotation().inverse() * vector(axis)
            })
        };
        let mut built: GenericJoint = match joint.kind {
            JointKind::Revolute => RevoluteJointBuilder::new()
                .local_anchor1(anchors[0])
                .local_anchor2(anchors[1])
                .into(),
            JointKind::Fixed => {
                let frames = [first, second].map(|handle| {
                    let pose = self.world.bodies.get(handle).map(|body| *body.position());
                    let world = Pose::from_translation(vector(place));
                    pose.unwrap_or(Pose::IDENTITY).inverse() * world
                });
                FixedJointBuilder::new()
                    .local_frame1(frames[0])
                    .local_frame2(frames[1])
                    .into()
            }
            JointKind::Prismatic { axis } => PrismaticJointBuilder::new(turned(first, axis))
                .local_axis2(turned(second, axis))
                .local_anchor1(anchors[0])
                .local_anchor2(anchors[1])
                .into(),
        };
        built.contacts_enabled = joint.contacts;
        self.world.impulse_joints.insert(first, second, built, true);
        Ok(())
    }

    fn rigid_named(&self, source: &Source, name: &At<String>) -> Result<RigidBodyHandle, Problem> {
        let known: Vec<&str> = self.rigid.keys().map(String::as_str).collect();
        let found = self.rigid.get(name.get()).copied();
        found.ok_or_else(|| source.problem(name, no_such("rigid body", name.get(), &known)))
    }

    /// The flexible body of a name.
    pub fn flexible_named(
        &self,
        source: &Source,
        name: &At<String>,
    ) -> Result<FlexBodyHandle, Problem> {
        let known: Vec<&str> = self.flexible.keys().map(String::as_str).collect();
        let found = self.flexible.get(name.get()).copied();
        found.ok_or_else(|| source.problem(name, no_such("flexible body", name.get(), &known)))
    }

    fn attach(&mut self, source: &Source) -> Result<(), Problem> {
        for spec in &source.scene.attachment {
            let body = self.flexible_named(source, &spec.body)?;
            let chosen = match self.shaped.get(spec.body.get()) {
                Some(shaped) => nodes(source, shaped, &spec.nodes)?,
                None => Vec::new(),
            };
            let attachment = match spec.kind {
                AttachKind::Pin => AttachmentBuilder::pin(body),
                AttachKind::Weld => AttachmentBuilder::weld(body),
                AttachKind::Spring { stiffness, damping } => {
                    AttachmentBuilder::spring_damper(body, stiffness, damping)
                }
            };
            let attachment = attachment.nodes(chosen);
            let attachment = match &spec.to {
                None => attachment.to_world(),
                Some(name) => match self.flexible.get(name.get()) {
                    Some(&other) => attachment.to_flexible(other),
                    None => attachment.to_rigid_body(self.rigid_named(source, name)?),
                },
            };
            self.flex_bodies
                .attach(attachment, &self.world.bodies)
                .map_err(|error| source.problem(&spec.body, error))?;
        }
        Ok(())
    }
}

fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.abs() <= LARGEST)
}

/// Refuses a world that has no steps, or no end.
fn check_world(source: &Source) -> Result<(), Problem> {
    let at = &source.scene.world;
    let world = at.get();
    let refuse = |what: &str| Err(source.problem(at, what));
    if !(SHORTEST..=LONGEST).contains(&world.dt) {
        return refuse("`dt` is the length of a step: give seconds from 1e-8 to 1e4");
    }
    let n_steps = world.duration / world.dt;
    if !(0.5..=MOST_STEPS).contains(&n_steps) {
        return refuse("`duration` is to hold a step of `dt`, and a billion at most");
    }
    if !are_finite(&world.gravity) {
        return refuse("`gravity` is to hold finite numbers");
    }
    if !(0.0..=1.0).contains(&world.decay) {
        return refuse("`decay` is to be from 0 to 1");
    }
    match source.scene.output.every {
        0 => refuse("`every` of the output counts steps: give 1 or more"),
        _ => Ok(()),
    }
}

/// Refuses a rigid body that rapier cannot hold.
fn check_rigid(source: &Source, rigid: &Rigid) -> Result<(), Problem> {
    let at = &rigid.shape;
    let refuse = |what: &str| Err(source.problem(at, what));
    let [x, y] = rigid.translation;
    let [vx, vy] = rigid.linvel;
    if !are_finite(&[x, y, vx, vy, rigid.rotation, rigid.angvel]) {
        return refuse(
            "`translation`, `rotation`, `linvel` and `angvel` of a rigid body are to be finite numbers up to 1e18",
        );
    }
    let coefficients = [rigid.friction, rigid.restitution];
    if !coefficients.iter().all(|one| (0.0..=LARGEST).contains(one)) {
        return refuse("`friction` and `restitution` are not to be negative");
    }
    let is_dynamic = rigid.kind == RigidKind::Dynamic;
    if is_dynamic && !(rigid.density > 0.0 && rigid.density <= LARGEST) {
        return refuse("the density of a rigid body that moves is to be positive");
    }
    let is_open = matches!(
        at.get(),
        RigidShape::Polyline { .. } | RigidShape::Halfspace { .. }
    );
    if is_dynamic && is_open {
        return refuse(
            "polylines and half-spaces have no mass: give `kind = \"fixed\"` or `\"kinematic\"`",
        );
    }
    let is_size = |size: f64| size > 0.0 && size <= LARGEST;
    let is_sound = match at.get() {
        RigidShape::Ball { radius } => is_size(*radius),
        RigidShape::Cuboid { size } => size.iter().all(|&one| is_size(one)),
        RigidShape::Capsule { from, to, radius } => {
            is_size(*radius) && are_finite(from) && are_finite(to)
        }
        RigidShape::Hull { points } | RigidShape::Polyline { points } => {
            points.get().iter().all(|point| are_finite(point))
        }
        RigidShape::Halfspace { normal } => are_finite(normal.get()),
    };
    match is_sound {
        true => Ok(()),
        false => refuse("a radius or size is to be positive, and points are to be finite"),
    }
}

/// The nodes chosen, one at least.
fn nodes(source: &Source, shaped: &Shaped, chosen: &Nodes) -> Result<Vec<usize>, Problem> {
    match chosen {
        Nodes::Group(name) => {
            let found = shaped.groups.iter().find(|(own, _)| own == name.get());
            let known: Vec<&str> = shaped.groups.iter().map(|(own, _)| own.as_str()).collect();
            let found = found.map(|(_, nodes)| nodes.clone());
            found.ok_or_else(|| source.problem(name, no_such("group of nodes", name.get(), &known)))
        }
        Nodes::Box(corners) => {
            let [low, high] = *corners.get();
            let within = |at: &[f64; 2]| (0..2).all(|i| low[i] <= at[i] && at[i] <= high[i]);
            let all = shaped.mesh.nodes().iter().enumerate();
            let found: Vec<usize> = all
                .filter(|(_, at)| within(at))
                .map(|(node, _)| node)
                .collect();
            match found.is_empty() {
                true => Err(source.problem(
                    corners,
                    "no node is in the box: it is in coordinates of the shape, before `rotation` and `translation`",
                )),
                false => Ok(found),
            }
        }
        Nodes::Near(point) => match are_finite(point.get()) {
            true => Ok(vec![nearest(&shaped.mesh, *point.get())]),
            false => Err(source.problem(point, "the place of a node is to be of finite numbers")),
        },
    }
}

/// The node of a mesh that is nearest to a point.
pub fn nearest(mesh: &Mesh, [x, y]: [f64; 2]) -> usize {
    let distance = |at: &[f64; 2]| hypot(at[0] - x, at[1] - y);
    let all = mesh.nodes().iter().enumerate();
    all.min_by(|(_, one), (_, other)| distance(one).total_cmp(&distance(other)))
        .map_or(0, |(node, _)| node)
}

/// A material of either kind.
enum Made {
    Linear(LinearElastic),
    Hyperelastic(HyperelasticSolid),
}

fn material(source: &Source, name: &At<String>) -> Result<Made, Problem> {
    let materials = &source.scene.materials;
    let known: Vec<&str> = materials.keys().map(String::as_str).collect();
    let spec = materials
        .get(name.get())
        .ok_or_else(|| source.problem(name, no_such("material", name.get(), &known)))?;
    let made = made_of(spec.get());
    let valid = match &made {
        Made::Linear(linear) => linear.validate(),
        Made::Hyperelastic(solid) => solid.validate(),
    };
    valid.map_err(|error| source.problem(spec, error))?;
    Ok(made)
}

fn made_of(spec: &MaterialSpec) -> Made {
    let rayleigh = Rayleigh {
        mass: spec.drag,
        stiffness: spec.rayleigh,
    };
    let (young, poisson) = (spec.young, spec.poisson);
    let linear =
        |material: LinearElastic| Made::Linear(material.density(spec.density).damping(rayleigh));
    let solid = |law: Arc<dyn Hyperelastic>| {
        let solid = HyperelasticSolid::of(law).with_density(spec.density);
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
