//! Nodes that a scene chooses.

use super::super::names::no_such;
use super::super::problem::Problem;
use super::super::scene::Nodes;
use super::super::shape::Shaped;
use super::super::source::Source;
use super::checks::{are_finite, check_pair};
use foil2d::math::hypot;
use foil2d::prelude::*;

/// The nodes chosen, one at least.
pub fn nodes(source: &Source, shaped: &Shaped, chosen: &Nodes) -> Result<Vec<usize>, Problem> {
    match chosen {
        Nodes::Group(name) => {
            let found = shaped.groups.iter().find(|(own, _)| own == name.get());
            let known = shaped.groups.iter().map(|(own, _)| own);
            let found = found.map(|(_, nodes)| nodes.clone());
            found.ok_or_else(|| source.problem(name, no_such("group of nodes", name.get(), known)))
        }
        Nodes::Box(corners) => {
            let [low, high] = corners.get().0.map(|corner| corner.0);
            let within = |at: &[f64; 2]| (0..2).all(|i| low[i] <= at[i] && at[i] <= high[i]);
            let all = shaped.mesh.nodes().iter().enumerate();
            let found: Vec<usize> = all
                .filter(|(_, at)| within(at))
                .map(|(node, _)| node)
                .collect();
            match found.is_empty() {
                true => Err(source.problem(corners, empty_box(shaped, low, high))),
                false => Ok(found),
            }
        }
        Nodes::Near(point) => {
            check_pair(source, "near", point)?;
            Ok(vec![nearest(&shaped.mesh, point.get().0)])
        }
    }
}

/// Why a box has no node.
fn empty_box(shaped: &Shaped, low: [f64; 2], high: [f64; 2]) -> String {
    // Not a number is no bound either.
    if !(0..2).all(|i| low[i] <= high[i]) {
        return "the box has no inside: give its lower left corner first".to_owned();
    }
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let [[left, right], [bottom, top]] = [0, 1].map(|axis| {
        let places = shaped.mesh.nodes().iter().map(|at| at[axis]);
        places.fold(start, |[low, high], x| [low.min(x), high.max(x)])
    });
    let far = are_finite(&[left, right, bottom, top]);
    let extent = match far {
        true => format!(", from [{left}, {bottom}] to [{right}, {top}]"),
        false => String::new(),
    };
    format!(
        "no node is in the box: it is in coordinates of the shape{extent}, before `rotation` and `translation`"
    )
}

/// The node of a mesh that is nearest to a point.
pub fn nearest(mesh: &Mesh, [x, y]: [f64; 2]) -> usize {
    let distance = |at: &[f64; 2]| hypot(at[0] - x, at[1] - y);
    let all = mesh.nodes().iter().enumerate();
    all.min_by(|(_, one), (_, other)| distance(one).total_cmp(&distance(other)))
        .map_or(0, |(node, _)| node)
}
