//! Pictures of steps as PNG: as large as asked for, with every body in its colour, and with words.

use foil2d::io::{OutputError, Scene, still_png};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use resvg::tiny_skia::Pixmap;

/// Colours of no stress and of the largest, and of rigid bodies.
const SLACK: [u8; 3] = [48, 60, 130];
const LOADED: [u8; 3] = [190, 30, 45];
const RIGID: [u8; 3] = [0xd5, 0xd9, 0xe0];

/// Two blocks of 1 m that do not touch, the right one stretched by a hundredth, and a rigid box between them; no gravity.
struct Blocks {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
}

impl Blocks {
    fn new() -> Self {
        let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
        world.gravity = Vector::ZERO;
        let rubber = || LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
        let block = || FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber());
        flex_bodies.insert(block(), &mut world).expect("a block");
        // Every node is held, and moved to where a uniform stretch takes it.
        let stretched = block()
            .translation([3.0, 0.0])
            .pin_where(|_| true, Pin::both());
        let stretched = flex_bodies.insert(stretched, &mut world).expect("a block");
        let body = &mut flex_bodies[stretched];
        for node in 0..body.n_nodes() {
            let x = body.position(node)[0] - 3.0;
            body.set_pin_displacement(node, [0.01 * x, 0.0])
                .expect("a pinned node");
        }
        let rigid =
            world.insert_body(RigidBodyBuilder::dynamic().translation(Vector::new(2.0, 0.5)));
        world.insert_collider(ColliderBuilder::cuboid(0.4, 0.4), Some(rigid));
        let mut flex = FlexPipeline::new();
        flex.step(&mut world, &mut flex_bodies).expect("a step");
        Self {
            world,
            flex_bodies,
            flex,
        }
    }

    fn png(&self, width: u32) -> Result<Vec<u8>, OutputError> {
        let report = self.flex.report();
        still_png(&Scene::of(&self.world, &self.flex_bodies, report), width)
    }
}

/// Red, green and blue at a point (px) of an opaque picture.
fn colour(picture: &Pixmap, [x, y]: [f64; 2]) -> [u8; 3] {
    let pixel = picture
        .pixel(x as u32, y as u32)
        .expect("a pixel of the picture");
    assert_eq!(pixel.alpha(), 255);
    [pixel.red(), pixel.green(), pixel.blue()]
}

#[test]
fn every_body_has_its_colour_where_it_is() {
    let blocks = Blocks::new();
    for width in [960_u32, 1920] {
        let picture = blocks.png(width).expect("a picture");
        let picture = Pixmap::decode_png(&picture).expect("a picture as PNG");
        // All of the bodies, from (0, 0) to (4.01, 1), with .15 of the longer side around, below a line of 34 px of 960.
        let (across, up) = (1.3 * 4.01, 1.0 + 0.3 * 4.01);
        let pixels = f64::from(width) / across;
        let head = f64::from(width) * 34.0 / 960.0;
        assert_eq!(picture.width(), width);
        let height = head + up * pixels;
        assert!(
            (f64::from(picture.height()) - height).abs() < 2.0,
            "{height}"
        );
        let place = |[x, y]: [f64; 2]| {
            let (left, top) = (-0.15 * 4.01, 1.0 + 0.15 * 4.01);
            [(x - left) * pixels, head + (top - y) * pixels]
        };
        // In the middle of cells, and so aside of the lines between.
        for (at, expected) in [
            ([0.375, 0.375], SLACK),
            ([3.125, 0.875], LOADED),
            ([3.875, 0.125], LOADED),
            ([2.0, 0.5], RIGID),
            ([2.0, -0.3], [255; 3]),
        ] {
            assert_eq!(colour(&picture, place(at)), expected, "at {at:?}");
        }
        // Just inside and outside of the left block's left edge.
        assert_eq!(colour(&picture, place([0.02, 0.4])), SLACK);
        assert_eq!(colour(&picture, place([-0.02, 0.4])), [255; 3]);
    }
}

#[test]
fn the_scale_is_labelled_whatever_fonts_the_system_has() {
    let picture = Blocks::new().png(960).expect("a picture");
    let picture = Pixmap::decode_png(&picture).expect("a picture as PNG");
    // Left of the scale the words, right of it the largest stress.
    for columns in [8..140, 380..460] {
        let points = columns.flat_map(|x| (8..26).map(move |y| [f64::from(x), f64::from(y)]));
        let dark = points.filter(|&at| colour(&picture, at)[0] < 128).count();
        assert!(dark > 60, "{dark} dark pixels");
    }
}

#[test]
fn a_width_no_picture_can_have_is_refused_by_name() {
    let blocks = Blocks::new();
    for width in [0, u32::MAX] {
        let error = blocks.png(width).expect_err("no such picture");
        assert!(matches!(error, OutputError::Unpaintable { width: w, .. } if w == width));
        assert!(
            error.to_string().contains("ask for another width"),
            "{error}"
        );
    }
}
