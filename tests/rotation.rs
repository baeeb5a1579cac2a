//! Invariances: the answer does not depend on where the axes point, on units, on numbering, or on who is contactor.

mod common;

use common::*;
use foil2d::fe::mesh::CellKind;

/// How a scene is described: lengths, times and masses in other units, seen from other axes, mirrored or renumbered.
#[derive(Clone, Copy, Debug)]
struct View {
    angle: f64,
    shift: [f64; 2],
    mirrored: bool,
    renumbered: bool,
    /// Units of length, time and mass.
    units: [f64; 3],
}

const PLAIN: View = View {
    angle: 0.0,
    shift: [0.0, 0.0],
    mirrored: false,
    renumbered: false,
    units: [1.0, 1.0, 1.0],
};

impl View {
    fn sign(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    /// A direction as seen in this view.
    fn direction(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        let x = self.sign() * x;
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn point(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.direction(at);
        let length = self.units[0];
        [length * (x + self.shift[0]), length * (y + self.shift[1])]
    }

    fn velocity(&self, v: [f64; 2]) -> [f64; 2] {
        let [length, time, _] = self.units;
        self.direction(v).map(|v| v * length / time)
    }

    fn spin(&self, spin: f64) -> f64 {
        self.sign() * spin / self.units[1]
    }

    /// Undoes the view on a point.
    fn undo(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let length = self.units[0];
        let (x, y) = (x / length - self.shift[0], y / length - self.shift[1]);
        let (sin, cos) = self.angle.sin_cos();
        [self.sign() * (cos * x + sin * y), cos * y - sin * x]
    }
}

/// A block that lands on a rigid box and on the ground, with friction, as seen in `view`: end positions of the block's
/// four corners and of the box.
fn fall(view: View, seconds: f64) -> Vec<[f64; 2]> {
    let [length, time, mass] = view.units;
    let [gx, gy] = view.direction([0.0, -G]).map(|g| g * length / time / time);
    let dt = time / 256.0;
    let mut scene = Scene::new(dt).with_gravity(gx, gy);
    scene.world.integration_parameters.length_unit = real(length);
    let [x, y] = view.point([0.0, -0.5]);
    scene.fixed(
        ColliderBuilder::cuboid(real(8.0 * length), real(0.5 * length))
            .translation(vec2(x, y))
            .rotation(real(view.angle)),
    );
    let density = 1000.0 * mass / length.powi(3);
    let [x, y] = view.point([0.25, 0.25]);
    let (rigid, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(x, y))
            .rotation(real(view.angle)),
        ColliderBuilder::cuboid(real(0.5 * length), real(0.25 * length))
            .density(real(density * length)),
    );
    let mesh =
        foil2d::fe::mesh::generate::rectangle([1.0, 1.0], [8, 8], CellKind::Quad4).expect("a mesh");
    let n = mesh.n_nodes();
    let number = |node: usize| {
        if view.renumbered {
            (node * 37 + 11) % n
        } else {
            node
        }
    };
    let mut nodes = vec![[0.0; 2]; n];
    let (sin, cos) = 0.3f64.sin_cos();
    for (node, &[x, y]) in mesh.nodes().iter().enumerate() {
        nodes[number(node)] = view.point([cos * x - sin * y + 0.5, sin * x + cos * y + 0.55]);
    }
    let cells: Vec<Vec<usize>> = mesh
        .cells()
        .map(|cell| {
            let mut cell: Vec<usize> = cell.nodes.iter().map(|&node| number(node)).collect();
            if view.mirrored {
                cell.reverse();
            }
            if view.renumbered {
                cell.rotate_left(1);
            }
            cell
        })
        .collect();
    let block = scene.flexible(
        FlexBodyBuilder::cells(nodes, CellKind::Quad4, &cells)
            .material(elastic(
                1e6 * mass / length / time / time,
                density,
                1e-3 * time,
            ))
            .thickness(length)
            .linvel(view.velocity([0.5, -1.0]))
            .angvel(view.spin(-0.5)),
    );
    scene.steps((256.0 * seconds) as usize);
    let at = scene.world.bodies[rigid].translation();
    let mut ends = vec![view.undo([f64::from(at.x), f64::from(at.y)])];
    for node in [0, 8, n - 9, n - 1] {
        ends.push(view.undo(scene.body(block).position(number(node))));
    }
    ends
}

fn distance(one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    one.iter()
        .zip(other)
        .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
        .fold(0.0, f64::max)
}

/// The box and the block stay in contact for half a second; later impacts would amplify rounding.
fn assert_same(name: &str, view: View, tolerance: f64) {
    let (plain, seen) = (fall(PLAIN, 0.5), fall(view, 0.5));
    let error = distance(&plain, &seen);
    assert!(error < tolerance, "{name}: off by {error:e} m");
}

#[test]
#[cfg_attr(
    feature = "f64",
    ignore = "open: off by 3.7e-9 m, as a step of the path ends within its tolerance, not at it"
)]
fn the_answer_does_not_depend_on_where_the_origin_is() {
    // 4 m and 2 m are exact in any precision, sums with them are rounded: 2e-7 m per pose in f32.
    let view = View {
        shift: [4.0, -2.0],
        ..PLAIN
    };
    assert_same("translated", view, by_precision(1e-5, 1e-9));
}

#[test]
fn the_answer_does_not_depend_on_where_the_axes_point() {
    // The direction of gravity is rapier's: 6e-8 of 9.81 m/s² over half a second in f32.
    for angle in [0.7, std::f64::consts::FRAC_PI_2, -2.5] {
        let view = View { angle, ..PLAIN };
        assert_same("turned", view, by_precision(1e-5, 1e-9));
    }
}

#[test]
fn the_answer_does_not_depend_on_the_hand() {
    let view = View {
        mirrored: true,
        ..PLAIN
    };
    assert_same("mirrored", view, 1e-9);
}

#[test]
fn the_answer_does_not_depend_on_how_nodes_are_numbered() {
    let view = View {
        renumbered: true,
        ..PLAIN
    };
    assert_same("renumbered", view, 1e-9);
}

#[test]
#[cfg_attr(
    feature = "f64",
    ignore = "open: off by 2.0e-7 m, as a step of the path ends within its tolerance, not at it"
)]
fn the_answer_does_not_depend_on_units() {
    // Two sets of odd units, and two of powers of two.
    for units in [
        [1000.0, 3.0, 0.01],
        [0.01, 3.0, 100.0],
        [4.0, 2.0, 8.0],
        [0.125, 0.5, 2.0],
    ] {
        let view = View { units, ..PLAIN };
        // Gaps are solved to 1e-11 of a length unit, whatever it is: 1e-9 m where the unit is a centimetre.
        assert_same(&format!("units {units:?}"), view, by_precision(1e-5, 1e-8));
    }
}

/// Two equal blocks that meet off their centres, inserted in one order or the other: velocities and spins, left first.
fn meet(is_swapped: bool, rate: f64) -> [[f64; 3]; 2] {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let block = |is_left: bool| {
        let builder = FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
            .friction(0.5)
            .material(elastic(1e6, 1000.0, 1e-4));
        if is_left {
            builder.linvel([1.0, 0.0])
        } else {
            builder.translation([1.1, 0.33]).linvel([-1.0, 0.0])
        }
    };
    let (first, second) = (
        scene.flexible(block(!is_swapped)),
        scene.flexible(block(is_swapped)),
    );
    scene.steps(rate as usize);
    let (left, right) = if is_swapped {
        (second, first)
    } else {
        (first, second)
    };
    [left, right].map(|body| {
        let body = scene.body(body);
        let spin = body.angular_momentum(body.centre_of_mass());
        let [x, y] = body.linvel();
        [x, y, spin]
    })
}

#[test]
fn the_answer_hardly_depends_on_who_is_the_contactor() {
    // The lower slot's nodes meet the other's segments. The scene is symmetric under half a turn, so both should end
    // alike; contact at nodes here and on segments there differs by the discretisation.
    let (one, other) = (meet(false, 240.0), meet(true, 240.0));
    for (a, b) in one.iter().zip(&other) {
        let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(apart < 1e-3, "velocities differ by {apart:e} m/s");
        assert!(
            (a[2] / b[2] - 1.0).abs() < 0.02,
            "spins are {} and {}",
            a[2],
            b[2]
        );
    }
}
