//! What the world looks like.

use crate::playground::Playground;
use foil2d::body::FlexBody;
use foil2d::rapier::prelude::Vector;
use macroquad::models::Vertex;
use macroquad::prelude::*;

/// Middle of the view and half of its height (m).
const CENTRE: Vec2 = Vec2::new(0.0, 2.6);
const HALF_HEIGHT: f32 = 3.6;

/// Width of lines (m).
const LINE: f32 = 0.02;

/// The view, as wide as the window allows.
pub fn camera() -> Camera2D {
    let aspect = screen_width() / screen_height();
    Camera2D {
        target: CENTRE,
        // Up is up.
        zoom: Vec2::new(1.0 / (HALF_HEIGHT * aspect), -1.0 / HALF_HEIGHT),
        ..Camera2D::default()
    }
}

/// Draws all bodies.
pub fn draw(playground: &Playground) {
    clear_background(Color::from_rgba(246, 247, 249, 255));
    for (_, collider) in playground.world.colliders.iter() {
        let Some(cuboid) = collider.shape().as_cuboid() else {
            continue;
        };
        let half = cuboid.half_extents;
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = corners.map(|[x, y]| {
            let at = *collider.position() * Vector::new(x * half.x, y * half.y);
            Vec2::new(at.x, at.y)
        });
        let fill = match collider.parent() {
            Some(_) => Color::from_rgba(150, 163, 184, 255),
            None => Color::from_rgba(213, 217, 224, 255),
        };
        draw_triangle(corners[0], corners[1], corners[2], fill);
        draw_triangle(corners[0], corners[2], corners[3], fill);
    }
    for (_, body) in playground.flex_bodies.iter() {
        draw_body(body);
    }
}

/// Draws a flexible body, coloured by von Mises' stress over the largest in it.
fn draw_body(body: &FlexBody) {
    let stresses = body
        .von_mises()
        .unwrap_or_else(|_| vec![0.0; body.n_nodes()]);
    let largest = stresses.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let place = |node: usize| {
        let [x, y] = body.position(node).map(|x| x as f32);
        Vec2::new(x, y)
    };
    let vertices = stresses.iter().enumerate().map(|(node, stress)| {
        let colour = colour((stress / largest) as f32);
        Vertex::new2(place(node).extend(0.0), Vec2::ZERO, colour)
    });
    let triangles = body.mesh().cells().flat_map(|cell| {
        let corners = cell.corners();
        (1..corners.len() - 1)
            .flat_map(|k| [corners[0], corners[k], corners[k + 1]])
            .collect::<Vec<_>>()
    });
    draw_mesh(&Mesh {
        vertices: vertices.collect(),
        indices: triangles.map(|node| node as u16).collect(),
        texture: None,
    });
    for &[from, to] in body.mesh().boundary().segments() {
        let [from, to] = [from, to].map(place);
        draw_line(from.x, from.y, to.x, to.y, LINE, DARKGRAY);
    }
}

/// From blue without stress over yellow to red.
fn colour(share: f32) -> Color {
    let stops = [[0.17, 0.48, 0.71], [0.91, 0.87, 0.43], [0.75, 0.12, 0.18]];
    let at = 2.0 * share.clamp(0.0, 1.0);
    let below = (at as usize).min(1);
    let part = at - below as f32;
    let [r, g, b] =
        [0, 1, 2].map(|k| stops[below][k] + part * (stops[below + 1][k] - stops[below][k]));
    Color::new(r, g, b, 1.0)
}
