//! A flexible beam in an app of Bevy, without a window.

use bevy::prelude::*;
use bevy::time::{TimePlugin, TimeUpdateStrategy};
use bevy_rapier2d::prelude::*;
use foil2d::prelude::*;
use foil2d_bevy::{
    FlexBodies, FlexPhysics, FlexPhysicsPlugin, FlexibleBody, NodePositions,
    rapier_without_its_step,
};
use std::time::Duration;

const DT: f32 = 1.0 / 60.0;
const LENGTH: f64 = 2.0;
const HEIGHT: f64 = 0.1;
const WIDTH: f64 = 0.1;
const YOUNG: f64 = 1e9;
const DENSITY: f64 = 1000.0;
/// Of the ball (kg), and its radius (m).
const MASS: f32 = 10.0;
const RADIUS: f32 = 0.1;

#[derive(Component)]
struct Ball;

/// Events since the start.
#[derive(Resource, Default)]
struct Heard(Vec<CollisionEvent>);

/// A beam on two supports 2 m apart, and a ball over its middle.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, TimePlugin))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
            DT,
        )))
        .insert_resource(TimestepMode::Fixed {
            dt: DT,
            substeps: 1,
        })
        .init_resource::<Heard>()
        .add_plugins((rapier_without_its_step(), FlexPhysicsPlugin))
        .add_systems(Startup, set_up)
        .add_systems(Last, hear);
    app.finish();
    app
}

fn set_up(mut flex_bodies: FlexBodies, mut commands: Commands) -> Result {
    let wood = LinearElastic::plane_stress(YOUNG, 0.3)
        .density(DENSITY)
        .rayleigh(6e-3);
    let middle = |y: f64| (y - 0.5 * HEIGHT).abs() < 1e-9;
    let beam = FlexBodyBuilder::rectangle([LENGTH, HEIGHT], [40, 2])
        .material(wood)
        .thickness(WIDTH)
        .pin_where(|[x, y]| x < 1e-9 && middle(y), Pin::both())
        .pin_where(|[x, y]| x > LENGTH - 1e-9 && middle(y), Pin::y());
    flex_bodies.spawn(beam)?;
    commands.spawn((
        Ball,
        RigidBody::Dynamic,
        Collider::ball(RADIUS),
        ColliderMassProperties::Mass(MASS),
        ActiveEvents::COLLISION_EVENTS,
        Transform::from_xyz(1.0, 0.3, 0.0),
    ));
    Ok(())
}

fn hear(mut messages: MessageReader<CollisionEvent>, mut heard: ResMut<Heard>) {
    heard.0.extend(messages.read().copied());
}

fn the_beam(app: &mut App) -> (Entity, FlexBodyHandle) {
    let mut beams = app.world_mut().query::<(Entity, &FlexibleBody)>();
    let (entity, beam) = beams.single(app.world()).expect("one beam");
    (entity, beam.0)
}

fn the_ball(app: &mut App) -> (Entity, Vec3) {
    let mut balls = app
        .world_mut()
        .query_filtered::<(Entity, &Transform), With<Ball>>();
    let (entity, transform) = balls.single(app.world()).expect("one ball");
    (entity, transform.translation)
}

/// `P L³ / 48 E I + 5 q L⁴ / 384 E I`, and what shear adds with 5/6 of the section.
#[test]
fn a_beam_sags_under_a_ball_of_bevy_as_beams_do() {
    let mut app = app();
    for _ in 0..400 {
        app.update();
    }
    let (load, spread) = (9.81 * f64::from(MASS), 9.81 * DENSITY * HEIGHT * WIDTH);
    let bending = YOUNG * WIDTH * HEIGHT.powi(3) / 12.0;
    let shear = 5.0 / 6.0 * YOUNG / 2.6 * WIDTH * HEIGHT;
    let expected = load * LENGTH.powi(3) / (48.0 * bending)
        + 5.0 * spread * LENGTH.powi(4) / (384.0 * bending)
        + load * LENGTH / (4.0 * shear)
        + spread * LENGTH.powi(2) / (8.0 * shear);
    let (entity, handle) = the_beam(&mut app);
    let middle = 20 + 41;
    let places = app.world().get::<NodePositions>(entity).expect("places");
    let sag = 0.5 * HEIGHT - f64::from(places.0[middle].y);
    assert!(
        (sag / expected - 1.0).abs() < 0.02,
        "{sag} m against {expected} m"
    );
    // The ball presses with its weight, and its transform is where the beam carries it.
    let physics = app.world().resource::<FlexPhysics>();
    let force = physics.bodies[handle].total_contact_force()[1];
    assert!((force / load + 1.0).abs() < 1e-2, "{force} N");
    let top = HEIGHT - sag + f64::from(RADIUS);
    let (_, ball) = the_ball(&mut app);
    assert!((f64::from(ball.y) - top).abs() < 1e-3, "{ball} over {top}");
}

#[test]
fn the_collision_is_a_message_that_names_both_entities() {
    let mut app = app();
    for _ in 0..60 {
        app.update();
    }
    let ((beam, _), (ball, _)) = (the_beam(&mut app), the_ball(&mut app));
    let heard = &app.world().resource::<Heard>().0;
    let is_theirs = |a: Entity, b: Entity| [(beam, ball), (ball, beam)].contains(&(a, b));
    let started = |event: &CollisionEvent| matches!(event, CollisionEvent::Started(a, b, _) if is_theirs(*a, *b));
    assert!(heard.iter().any(started), "{heard:?}");
}

#[test]
fn a_despawned_beam_is_gone_and_the_ball_falls() {
    let mut app = app();
    for _ in 0..60 {
        app.update();
    }
    let (beam, _) = the_beam(&mut app);
    app.world_mut().despawn(beam);
    for _ in 0..60 {
        app.update();
    }
    assert!(app.world().resource::<FlexPhysics>().bodies.is_empty());
    let (_, ball) = the_ball(&mut app);
    assert!(ball.y < -2.0, "it falls: {ball}");
    let mut bodies = app.world_mut().query::<&RapierRigidBodySet>();
    let left = bodies.single(app.world()).expect("a context").bodies.len();
    assert_eq!(left, 1, "the carrier is gone");
}

/// Frames of one and a half steps: rapier is ahead of the app by less than a step, and a falling body has the speed of that time.
#[test]
fn interpolated_steps_keep_up_with_frames_of_another_length() {
    let mut app = app();
    let frame = Duration::from_secs_f32(1.5 * DT);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame))
        .insert_resource(TimestepMode::Interpolated {
            dt: DT,
            time_scale: 1.0,
            substeps: 2,
        });
    app.update();
    let (beam, _) = the_beam(&mut app);
    app.world_mut().despawn(beam);
    for _ in 0..40 {
        app.update();
    }
    let elapsed = app.world().resource::<Time>().elapsed_secs();
    let mut balls = app
        .world_mut()
        .query_filtered::<&RapierRigidBodyHandle, With<Ball>>();
    let ball = balls.single(app.world()).expect("one ball").0;
    let mut contexts = app.world_mut().query::<&RapierRigidBodySet>();
    let bodies = &contexts.single(app.world()).expect("a context").bodies;
    let fallen = -bodies[ball].linvel().y / 9.81;
    let ahead = fallen - elapsed;
    assert!(
        (-1e-4..DT + 1e-4).contains(&ahead),
        "{fallen} s against {elapsed} s"
    );
}
