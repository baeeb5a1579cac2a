//! Mass redistribution: nodes in contact carry no inertia, `m_i' = p(x_i) (m_i + share_i)`, and the body moves as before.
//!
//! The mass of massless nodes goes to their nearest massive neighbours; then a quadratic polynomial p restores
//! `sum m`, `sum m x` and `sum m x x^T` (Khenous, Laborde, Renard 2008, who pose the same moments for the mass
//! matrix). In the plane a rigid body needs the total, the centre and the polar moment; the remaining two second
//! moments keep the inertia of uniform stretching and shearing.

mod consistent;
mod moments;

pub use consistent::redistribute_consistent;

use crate::fe::LEAST_LEFT;
use crate::math::{judged::Judged, rounding};
use moments::Frame;

/// Why the mass cannot be redistributed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MassError {
    /// No node may keep its mass.
    #[error(
        "all {n_nodes} nodes are massless: refine the mesh so that the body has nodes off its contact \
         boundary, or leave its mass where it is"
    )]
    NoMassiveNode {
        /// The number of nodes.
        n_nodes: usize,
    },
    /// A massless node is not connected to any massive one.
    #[error(
        "massless node {node} has no path to a massive node: connect the piece it belongs to, or let one of \
         that piece's nodes keep its mass"
    )]
    Unreachable {
        /// The node.
        node: usize,
    },
    /// A nodal mass is negative, zero on a massive node, or not finite.
    #[error("node {node} has a mass of {value} kg: lump the mass with positive values first")]
    NotPositive {
        /// The node.
        node: usize,
        /// Its mass (kg).
        value: f64,
    },
}

/// What a redistribution moved and kept; the total mass is always kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Redistribution {
    /// The mass taken from massless nodes (kg).
    pub moved: f64,
    /// Whether the centre of mass is where it was.
    pub keeps_centre: bool,
    /// Whether the polar moment of inertia is what it was.
    pub keeps_polar_moment: bool,
    /// Whether all second moments are what they were.
    pub keeps_second_moments: bool,
    /// The smallest value of p over the massive nodes (-).
    pub smallest_factor: f64,
    /// The largest value of p over the massive nodes (-).
    pub largest_factor: f64,
}

/// A massive node keeps at least this part of what it carries: one with less would set the step of explicit
/// integration (its frequency grows with the root of 1 / 0.1, a factor 3).
const SMALLEST_FACTOR: Judged = LEAST_LEFT;
/// A moment counts as kept within this part of `total x gyration radius^degree`: rounding over 1e5 nodes.
const KEPT: f64 = rounding::SOLVED;

/// Moves the mass of massless nodes inwards and restores the moments of the whole.
///
/// Conditions are kept in the order total, centre, polar moment, other second moments. Those the massive nodes'
/// places do not allow are left out; so are the last ones if a mass would fall below a tenth of its value. The
/// result says which were kept.
///
/// - `nodes`: positions (m), shape `(n, 2)`.
/// - `mass`: nodal masses (kg), shape `(n)`; massless nodes end at exactly zero.
/// - `massless`: true where inertia is to vanish, shape `(n)`.
/// - `neighbours`: the nodes that share a cell with a node, without itself.
///
/// # Errors
/// [`MassError`]; `mass` is then unchanged.
///
/// # Panics
/// If the slices differ in length.
pub fn redistribute<'a>(
    nodes: &[[f64; 2]],
    mass: &mut [f64],
    massless: &[bool],
    neighbours: impl Fn(usize) -> &'a [usize],
) -> Result<Redistribution, MassError> {
    redistribute_by(nodes, mass, massless, neighbours, &vec![1.0; nodes.len()])
}

/// [`redistribute`], where masses are changed the more readily the greater their node's weight: `p = 1 + w q`.
///
/// With [`nearness`] for weights the change stays where the mass was taken, and the density of the rest is what it was.
///
/// - `weight`: shape `(n)` (-).
///
/// # Errors
/// As [`redistribute`].
///
/// # Panics
/// If the slices differ in length.
pub fn redistribute_by<'a>(
    nodes: &[[f64; 2]],
    mass: &mut [f64],
    massless: &[bool],
    neighbours: impl Fn(usize) -> &'a [usize],
    weight: &[f64],
) -> Result<Redistribution, MassError> {
    assert_eq!(nodes.len(), mass.len(), "one mass per node");
    assert_eq!(nodes.len(), weight.len(), "one weight per node");
    let original = mass.to_vec();
    let moved = move_inwards(mass, massless, neighbours)?;
    let frame = Frame::new(nodes, &original);
    let target = frame.moments(nodes, &original);
    let basis = frame.basis(nodes, mass, weight);
    let mut change = target;
    for (change, now) in change.iter_mut().zip(frame.moments(nodes, mass)) {
        *change -= now;
    }
    // q may use the first 6, 4, 3 or 1 terms: each drop gives up the least important conditions.
    let mut factor = vec![1.0; nodes.len()];
    for n_terms in [6, 4, 3, 1] {
        basis.fit(&mut factor, mass, &change, n_terms);
        if extremes(&factor, massless).0 >= SMALLEST_FACTOR {
            break;
        }
    }
    for (mass, factor) in mass.iter_mut().zip(&factor) {
        *mass *= factor;
    }
    let found = frame.moments(nodes, mass);
    let kept = |term: usize| (found[term] - target[term]).abs() <= KEPT * target[0];
    let (smallest_factor, largest_factor) = extremes(&factor, massless);
    Ok(Redistribution {
        moved,
        keeps_centre: kept(1) && kept(2),
        keeps_polar_moment: kept(3),
        keeps_second_moments: kept(3) && kept(4) && kept(5),
        smallest_factor,
        largest_factor,
    })
}

/// Moves the mass of massless nodes to their nearest massive neighbours, and returns how much (kg).
///
/// Rings are counted from the massive nodes; a node hands what it has in equal shares to its neighbours one ring
/// nearer, farthest rings first. Only the total is kept: this is the first half of [`redistribute`].
///
/// # Errors
/// [`MassError`]; `mass` is then unchanged.
///
/// # Panics
/// If the slices differ in length.
pub fn move_inwards<'a>(
    mass: &mut [f64],
    massless: &[bool],
    neighbours: impl Fn(usize) -> &'a [usize],
) -> Result<f64, MassError> {
    assert_eq!(mass.len(), massless.len(), "one flag per node");
    for (node, (&value, &massless)) in mass.iter().zip(massless).enumerate() {
        let positive = value > 0.0 || (massless && value == 0.0);
        if !(positive && value.is_finite()) {
            return Err(MassError::NotPositive { node, value });
        }
    }
    let (ring, order) = rings(massless, &neighbours)?;
    let mut moved = 0.0;
    for &node in order.iter().rev().take_while(|&&node| massless[node]) {
        let nearer = |other: &&usize| ring[**other] + 1 == ring[node];
        let receivers = neighbours(node).iter().filter(nearer);
        let share = mass[node] / receivers.clone().count() as f64;
        for &receiver in receivers {
            mass[receiver] += share;
            if !massless[receiver] {
                moved += share;
            }
        }
        mass[node] = 0.0;
    }
    Ok(moved)
}

/// `1/k²` for a node `k` cells away from the nearest massless one, 1 on massless ones (-). A steeper fall keeps the change nearer, but
/// waves scatter at it.
pub fn nearness<'a>(massless: &[bool], neighbours: impl Fn(usize) -> &'a [usize]) -> Vec<f64> {
    let others: Vec<bool> = massless.iter().map(|massless| !massless).collect();
    match rings(&others, &neighbours) {
        Ok((ring, _)) => ring
            .iter()
            .map(|&ring| 1.0 / (ring.max(1) as f64).powi(2))
            .collect(),
        // No massless node, or a piece without one: nothing changes there.
        Err(_) => vec![1.0; massless.len()],
    }
}

/// The ring of every node, 0 for massive ones, and the nodes in order of their rings.
fn rings<'a>(
    massless: &[bool],
    neighbours: impl Fn(usize) -> &'a [usize],
) -> Result<(Vec<usize>, Vec<usize>), MassError> {
    let n_nodes = massless.len();
    let mut ring: Vec<usize> = massless
        .iter()
        .map(|&m| if m { usize::MAX } else { 0 })
        .collect();
    let mut order: Vec<usize> = (0..n_nodes).filter(|&node| !massless[node]).collect();
    if order.is_empty() {
        return Err(MassError::NoMassiveNode { n_nodes });
    }
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        for &other in neighbours(node) {
            if ring[other] == usize::MAX {
                ring[other] = ring[node] + 1;
                order.push(other);
            }
        }
        next += 1;
    }
    match ring.iter().position(|&ring| ring == usize::MAX) {
        Some(node) => Err(MassError::Unreachable { node }),
        None => Ok((ring, order)),
    }
}

/// The smallest and the largest factor over the massive nodes.
fn extremes(factor: &[f64], massless: &[bool]) -> (f64, f64) {
    let massive = factor.iter().zip(massless).filter(|(_, m)| !**m);
    massive.fold((f64::INFINITY, 0.0), |(least, most), (&factor, _)| {
        (f64::min(least, factor), f64::max(most, factor))
    })
}
