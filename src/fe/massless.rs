//! Massless contact surfaces of a model: whose mass moves inwards, and who carries it.

use super::mass::{self, MassError};
use super::mass_matrix::MassMatrix;
use super::model::ModelDescription;
use crate::linalg::block_matrix::BlockMatrix;

/// Moves the mass of massless nodes inwards, unless the body would balance or, where it may turn, turn differently by it: the nodes inside
/// of a coarse mesh may be too few to carry its centre and polar moment. Then all mass stays where it is.
///
/// Where at most half of the boundary is massless, the moments are restored near it: a wave that comes from afar must not meet
/// another density there.
pub(super) fn redistribute(
    description: &mut ModelDescription,
    mass: &mut MassMatrix,
    pattern: &BlockMatrix,
) -> Result<(), MassError> {
    let nodes: Vec<[f64; 2]> = description
        .rest_positions
        .chunks_exact(2)
        .map(|p| [p[0], p[1]])
        .collect();
    let is_held = |node: usize| description.held.get(node).copied().unwrap_or(false);
    let neighbours: Vec<Vec<usize>> = (0..nodes.len())
        .map(|node| {
            let all = pattern.neighbours(node).iter().map(|&n| n as usize);
            all.filter(|&n| n != node && !is_held(n)).collect()
        })
        .collect();
    // Held at one node it is a pendulum.
    let may_turn = (0..nodes.len()).filter(|&node| is_held(node)).count() <= 1;
    let neighbours = |node: usize| &neighbours[node][..];
    let massless = &description.massless;
    let is_part =
        2 * massless.iter().filter(|&&m| m).count() <= description.mesh.boundary().nodes().len();
    let near = is_part.then(|| mass::nearness(massless, neighbours));
    for weight in near.into_iter().chain([vec![1.0; nodes.len()]]) {
        let mut changed = mass.clone();
        let found = match &mut changed {
            MassMatrix::Lumped(lumped) => {
                mass::redistribute_by(&nodes, lumped, massless, neighbours, &weight)
            }
            MassMatrix::Consistent(matrix) => {
                mass::redistribute_consistent(&nodes, matrix, massless, neighbours, &weight)
            }
        }?;
        if found.keeps_centre && (found.keeps_polar_moment || !may_turn) {
            *mass = changed;
            return Ok(());
        }
    }
    description.massless.fill(false);
    Ok(())
}

/// The nearest massive nodes of every massless one, ring by ring over the mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct MassiveSupport {
    massless: Vec<usize>,
    /// Of the massless nodes in turn, all in one.
    massive: Vec<usize>,
    /// Where the massive nodes of each begin, and the end.
    starts: Vec<usize>,
    /// Which of the massless a node is, `u32::MAX` for a node with mass.
    slot: Vec<u32>,
}

impl MassiveSupport {
    pub fn new(massless: &[bool], pattern: &BlockMatrix) -> Self {
        let mut support = Self {
            starts: vec![0],
            slot: vec![u32::MAX; massless.len()],
            ..Self::default()
        };
        for node in (0..massless.len()).filter(|&node| massless[node]) {
            support.slot[node] = support.massless.len() as u32;
            support.massless.push(node);
            support
                .massive
                .extend(nearest_massive(node, massless, pattern));
            support.starts.push(support.massive.len());
        }
        support
    }

    /// The massless nodes, ascending, each with its support.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[usize])> {
        let ranges = self.starts.windows(2);
        let supports = ranges.map(|ends| &self.massive[ends[0]..ends[1]]);
        self.massless.iter().copied().zip(supports)
    }

    /// The support of a node; none for a node with mass.
    pub fn of(&self, node: usize) -> &[usize] {
        let slot = self.slot[node] as usize;
        match self.starts.get(slot..slot.saturating_add(2)) {
            Some(ends) => &self.massive[ends[0]..ends[1]],
            None => &[],
        }
    }
}

fn nearest_massive(node: usize, massless: &[bool], pattern: &BlockMatrix) -> Vec<usize> {
    let mut ring = vec![node];
    let mut seen = ring.clone();
    loop {
        let mut next: Vec<usize> = ring
            .iter()
            .flat_map(|&node| pattern.neighbours(node).iter().map(|&n| n as usize))
            .filter(|node| !seen.contains(node))
            .collect();
        next.sort_unstable();
        next.dedup();
        let massive: Vec<usize> = next.iter().copied().filter(|&n| !massless[n]).collect();
        if !massive.is_empty() || next.is_empty() {
            return massive;
        }
        seen.extend_from_slice(&next);
        ring = next;
    }
}
