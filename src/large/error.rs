//! What can stop a step or an equilibrium of a large body.

use crate::fe::finite_strain::Inadmissible;
use crate::linalg::cholesky::CholeskyError;
use thiserror::Error;

/// Why a step or an equilibrium was not found. Motion and positions are as they were before.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LargeError {
    /// The step length is not a positive finite number.
    #[error("the step is {0} s: give a positive finite length")]
    StepLength(f64),
    /// A setting is out of its range.
    #[error("{name} is {value}: give a value in {range}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// The value given.
        value: f64,
        /// Where it may be.
        range: &'static str,
    },
    /// A list has the wrong length.
    #[error("{name} has {found} entries, {expected} are needed")]
    Length {
        /// Which list.
        name: &'static str,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
    },
    /// A number that was given is not finite.
    #[error("{name} is not finite at node {node}")]
    NotFinite {
        /// Which list.
        name: &'static str,
        /// The first such node.
        node: usize,
    },
    /// The iterations do not reach the tolerance.
    #[error(
        "{iterations} iterations left a residual of {residual:e} N at node {node}, where {limit:e} N was asked, also in smaller parts: \
         shorten the step or take more increments, allow more cutbacks, or look for crushed cells near that node"
    )]
    NotConverged {
        /// Iterations of the last attempt.
        iterations: usize,
        /// Node of the largest residual.
        node: usize,
        /// That residual (N).
        residual: f64,
        /// The residual that would do (N).
        limit: f64,
    },
    /// No cut of an increment leads to a state with a finite residual that does not grow.
    #[error(
        "no part of an increment keeps the residual of {residual:e} N from growing beyond bounds, also in smaller parts; it is largest \
         at node {node}: shorten the step, take more increments, or look for crushed cells near that node"
    )]
    Diverged {
        /// Node of the largest residual.
        node: usize,
        /// That residual (N), before the increment.
        residual: f64,
    },
    /// A cell is where its law has no energy.
    #[error(transparent)]
    Inadmissible(#[from] Inadmissible),
    /// The matrix has no factor, not even with its definite part.
    #[error(transparent)]
    Factor(#[from] CholeskyError),
    /// The iterations of all parts of a step have used up what was allowed.
    #[error(
        "a step took {iterations} iterations without an end: shorten it, or allow more in `LargeSettings::budget`; the last part failed at \
         node {node}"
    )]
    Budget {
        /// Iterations of all parts.
        iterations: usize,
        /// Node of the largest residual seen last.
        node: usize,
    },
    /// The tangent of a path, or of a body at rest, has no factor.
    #[error(
        "the tangent is singular at the load factor {factor}: hold the rigid motions of the body, let it begin where it touches what is to hold it, and \
         where two paths cross disturb its shape or its load a little"
    )]
    Singular {
        /// Where (-).
        factor: f64,
    },
    /// There is not enough memory for a factor.
    #[error("there is no memory for the factor of {n_dofs} dofs")]
    Memory {
        /// Rows of the matrix.
        n_dofs: usize,
    },
    /// Nothing moves with the load factor.
    #[error(
        "no node moves with the load factor: give loads at free dofs, or other places to held ones"
    )]
    Still,
    /// A path turns sharply, also in short increments.
    #[error(
        "the path turns at the load factor {factor}, with a cosine of {cosine} to its way before, also in short increments: there is a kink, or \
         another path near by; allow more cutbacks, or disturb the shape or the load a little"
    )]
    Turn {
        /// Where (-).
        factor: f64,
        /// Between the tangents before and after the increment (-).
        cosine: f64,
    },
    /// The end of a path was not reached.
    #[error(
        "the end was not reached in {n_increments} increments, the last at the load factor {factor}: look whether the path leads there"
    )]
    Unreached {
        /// Increments taken.
        n_increments: usize,
        /// Where the path is (-).
        factor: f64,
    },
    /// An obstacle is none.
    #[error(
        "obstacle {index}: {what} is {value}: give finite numbers, a radius above zero and friction from zero on"
    )]
    Obstacle {
        /// Which one.
        index: usize,
        /// What is wrong with it.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// A node that touches one obstacle is in another.
    #[error(
        "node {node} touches obstacle {} and is {depth:e} m in obstacle {}: a node is kept out of one obstacle, so round the corner between both, or let one node less stand there", obstacles[0], obstacles[1]
    )]
    Wedged {
        /// The node.
        node: usize,
        /// The obstacle it touches, and the one it is in.
        obstacles: [usize; 2],
        /// How deep (m).
        depth: f64,
    },
    /// An obstacle that is met goes on through the body.
    #[error(
        "obstacle {obstacle} goes through the surface beside node {node} within an increment, also in smaller parts: take more increments, allow more \
         cutbacks, or let it move less"
    )]
    Passed {
        /// The node.
        node: usize,
        /// The obstacle, by its place in the list.
        obstacle: usize,
    },
    /// A follower force cannot act.
    #[error(
        "follower force {index} has a node that does not exist, a line from a node to itself, or a force that is not finite"
    )]
    Follower {
        /// Which one.
        index: usize,
    },
}
