//! Flexible and rigid bodies to drag with the mouse, coloured by stress.
//!
//! ```text
//! cargo run --release            # in demos/drag
//! ```
//!
//! Left button: drag a body. Space: stop and go on. `R`: begin anew.

mod draw;
mod mouse;
mod playground;

use draw::{camera, draw};
use macroquad::prelude::*;
use playground::Playground;

/// Most steps of one frame: a slow machine shows slow motion.
const MOST_STEPS: usize = 2;

fn settings() -> Conf {
    Conf {
        window_title: "foil2d".to_owned(),
        window_width: 1280,
        window_height: 720,
        sample_count: 4,
        ..Conf::default()
    }
}

#[macroquad::main(settings)]
async fn main() {
    let mut playground = match Playground::new() {
        Ok(playground) => playground,
        Err(error) => return error!("{}", error),
    };
    let (mut behind, mut is_running) = (0.0, true);
    loop {
        let camera = camera();
        let cursor = camera.screen_to_world(mouse_position().into());
        let cursor = [cursor.x, cursor.y].map(f64::from);
        if is_key_pressed(KeyCode::Space) {
            is_running = !is_running;
        }
        if is_key_pressed(KeyCode::R) {
            match Playground::new() {
                Ok(anew) => playground = anew,
                Err(error) => error!("{}", error),
            }
        }
        let mouse = match (
            is_mouse_button_pressed(MouseButton::Left),
            is_mouse_button_down(MouseButton::Left),
        ) {
            (true, _) => playground.take_hold(cursor),
            (_, true) => playground.lead(cursor),
            (_, false) => playground.let_go(),
        };
        if let Err(error) = mouse {
            error!("{}", error);
        }
        behind += f64::from(get_frame_time());
        let mut n_steps = 0;
        while behind >= playground.dt() && n_steps < MOST_STEPS {
            behind -= playground.dt();
            n_steps += 1;
            if is_running && let Err(error) = playground.step() {
                error!("{}", error);
                is_running = false;
            }
        }
        behind = behind.min(playground.dt());
        set_camera(&camera);
        draw(&playground);
        set_default_camera();
        let words = format!("{} fps, {}", get_fps(), playground.summary());
        draw_text(&words, 12.0, 24.0, 22.0, DARKGRAY);
        next_frame().await;
    }
}
