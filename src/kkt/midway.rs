//! Forces wholly within their step act as the contact is midway through it.
//!
//! Positions are found with forces along the normals of the step's end. Where these turn within the step, `F·Δx` is then no work of a contact
//! that stays closed: what slides around something convex at `v` is pushed along by `N v² dt / 2r`, friction or not, and in a bowl it is
//! braked. Along the normal halfway, at the levers halfway, the work of a step by energy and momentum is that of the gap, `N (g' - g)`, to the
//! third order of the turn: of two points exactly (Gonzalez 1996; Laursen, Chawla 1997). The difference is an impulse of the velocity stage.

use super::active_contact::ActiveContact;
use super::feasible::{points_of, turn};
use super::gathered;
use super::island::{Island, SolveSettings};
use super::joints::add_wrench;
use crate::constraint::contact::ContactKey;
use crate::math::{Mat2, Vec2, angle_between, cross, rotation, rounding};
use crate::path::NearPair;
use crate::system::{Block, Grip, Point, Response};
use std::f64::consts::FRAC_PI_2;

/// Turns the forces of contacts to where they are midway, by impulses on top of what they have done.
///
/// Forces between rigid bodies only move positions, and the law of impacts finds what they give to velocities, along the row of the end. What presses them
/// on each other, as a clamp does, would turn them at the levers of the end by `N h dt/2` times their spin: they rocked on each other ever
/// faster (two wedges of 80 kN from 8e-4 to 359 J within 3 s). Its part midway is known before the law is solved.
pub(super) fn act_midway(island: &mut Island, settings: &SolveSettings) {
    for contact in &mut island.contacts {
        (contact.midway, contact.since_midway) = ([0.0; 2], Vec2::zeros());
    }
    if !settings.is_within || island.path.is_empty() {
        return;
    }
    gathered::clear_wrenches(island);
    gathered::clear_impulses(island);
    let mut acts = false;
    for index in 0..island.contacts.len() {
        let Some(midway) = midway_of(island, index) else {
            continue;
        };
        acts = true;
        let contact = &mut island.contacts[index];
        let change = settings.dt * (midway.force - midway.acting);
        if !contact.is_hard {
            let [normal, tangent] = [contact.kinematics.normal, contact.kinematics.tangent()];
            contact.midway = [normal.dot(&change), tangent.dot(&change)];
            contact.since_midway = midway.since[1];
        }
        for (side, grip) in contact.kinematics.attachments().iter().enumerate() {
            let share = grip.weight * change;
            let Grip { point, lever } = grip.grip;
            match (&mut island.blocks[grip.block], point) {
                (Block::Flex(block), Point::Node(node)) => {
                    block.gather_impulse(Response::Velocity, node, share, lever);
                }
                (Block::Rigid(_), _) => {
                    let turned = cross(lever - midway.since[side.min(1)], midway.force);
                    let couple = settings.dt * (turned - cross(lever, midway.acting));
                    let wrench = [share.x, share.y, grip.weight * couple];
                    add_wrench(&mut island.wrenches[grip.block], 1.0, wrench);
                }
                _ => {}
            }
        }
    }
    if acts {
        gathered::respond(island);
        gathered::add_to_flexible(island, Response::Velocity, 1.0);
        gathered::add_to_rigid(island, Response::Velocity, 1.0);
        gathered::clear_impulses(island);
    }
}

/// A force on a point midway through the step.
struct Midway {
    /// The force along the row (N).
    acting: Vec2,
    /// The same as it is midway (N).
    force: Vec2,
    /// By how much the levers of rigid bodies differ from those midway, at the point and at what it meets (m).
    since: [Vec2; 2],
}

/// The force of a contact midway, if that is another one.
fn midway_of(island: &Island, index: usize) -> Option<Midway> {
    let contact = &island.contacts[index];
    let base = contact.base.filter(|base| !base.is_meeting)?;
    if !contact.is_closed() || contact.kinematics.is_quasi_static() {
        return None;
    }
    let pressed = &island.passes.pressed;
    let has_pressed = pressed.binary_search(&contact.candidate).is_ok();
    // What presses bodies that a joint holds may be of any size, and moves nothing.
    let is_of_any_size = || contact.is_parting() || island.joints.joins(contact);
    if contact.is_hard && (!has_pressed || is_of_any_size()) {
        return None;
    }
    let [normal, tangent] = contact.multiplier;
    let acting = normal * contact.kinematics.normal + tangent * contact.kinematics.tangent();
    let angle = match has_pressed {
        true => turn(&island.path, &base.near, &island.blocks),
        false => turn_of_met(island, contact),
    };
    if angle.abs() >= FRAC_PI_2 {
        // What presses the other way is another contact.
        return None;
    }
    let back = rotation(-0.5 * angle);
    let since = match contact.is_hard {
        true => since_midway_of_rigid(island, contact, &base.near, &back),
        false => [since_midway(contact, &island.blocks, (&back, has_pressed)); 2],
    };
    let is_same = |since: &Vec2| since.norm() <= rounding::SHARE;
    let is_same = angle.abs() <= rounding::SHARE && since.iter().all(is_same);
    (!is_same).then_some(Midway {
        acting,
        force: back * acting,
        since,
    })
}

/// By how much the levers of two rigid bodies differ from those midway (m): they turn with their bodies, and with the normal from the middle of what is round.
///
/// Not by how far the contact slides: forces that are spread along a face go with what slides, from point to point.
fn since_midway_of_rigid(
    island: &Island,
    contact: &ActiveContact,
    near: &NearPair,
    back: &Mat2,
) -> [Vec2; 2] {
    let points = points_of(&island.path, near, &island.blocks);
    let mut since = [Vec2::zeros(); 2];
    let grips = contact.kinematics.attachments();
    for ((since, grip), point) in since.iter_mut().zip(grips).zip(points) {
        if let Block::Rigid(body) = &island.blocks[grip.block] {
            let [_, _, turn] = body.moved();
            let lever = grip.grip.lever;
            let own = point.map_or(lever, |point| point - body.current().centre);
            *since = lever - (rotation(-0.5 * turn) * own + back * (lever - own));
        }
    }
    since
}

fn key(island: &Island, contact: &ActiveContact) -> ContactKey {
    island.candidates[contact.candidate].key
}

/// By how much the normal of a contact that is met within the step has turned against the contacts of the same bodies that pressed before (rad).
/// Bodies that meet have no normal before.
///
/// Their mean counts, weighted by the inverse square of their distance: where two give way to one between them, rounding would
/// choose the nearest, and push to its side.
fn turn_of_met(island: &Island, contact: &ActiveContact) -> f64 {
    let own = key(island, contact);
    let [_, met @ ..] = contact.kinematics.attachments() else {
        return 0.0;
    };
    let moved = met
        .iter()
        .map(|grip| grip.weight * island.blocks[grip.block].displacement(grip.grip));
    let place = contact.kinematics.position + moved.sum::<Vec2>();
    let away = |before: &ActiveContact| (before.kinematics.position - place).norm_squared();
    let of_pair = || {
        let pressed = island.passes.parted.iter();
        pressed.filter(|before| key(island, before).owners() == own.owners())
    };
    let nearest = of_pair().map(away).fold(f64::INFINITY, f64::min);
    let normals = of_pair().map(|before| {
        let distance = away(before);
        let weight = match distance > nearest {
            true => nearest / distance,
            false => 1.0,
        };
        match key(island, before).contactor == own.contactor {
            true => weight * before.kinematics.normal,
            false => -weight * before.kinematics.normal,
        }
    });
    let (before, now) = (normals.sum::<Vec2>(), contact.kinematics.normal);
    angle_between(before, now)
}

/// By how much the lever at the rigid body of a contact differs from that midway (m): where a point of the flexible body slides along it, by half of that way;
/// elsewhere the lever turns with the normal, as what rolls is met by other points all the time.
fn since_midway(
    contact: &ActiveContact,
    blocks: &[Block],
    (back, has_pressed): (&Mat2, bool),
) -> Vec2 {
    let grips = contact.kinematics.attachments();
    let Some((grip, body)) = grips.iter().find_map(|grip| match &blocks[grip.block] {
        Block::Rigid(body) => Some((grip.grip, body)),
        Block::Flex(_) => None,
    }) else {
        return Vec2::zeros();
    };
    match &blocks[grips[0].block] {
        Block::Flex(_) if has_pressed => {
            let [x, y, _] = body.moved();
            let point = blocks[grips[0].block].displacement(grips[0].grip);
            0.5 * (point - Vec2::new(x, y))
        }
        _ => grip.lever - back * grip.lever,
    }
}
