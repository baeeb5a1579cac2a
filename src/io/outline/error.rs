//! Why a file gives no outlines.

use thiserror::Error;

/// Why a file gives no outlines.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OutlineError {
    /// The text is no JSON.
    #[error("line {line}, column {column}: this is no JSON: {reason}")]
    NoJson {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        reason: String,
    },
    /// Something else stands where GeoJSON has a polygon or a part of one.
    #[error("{path}: expected {expected}")]
    Unexpected {
        /// Where, such as `features[2].geometry.coordinates[0][5]`.
        path: String,
        /// What should stand there.
        expected: &'static str,
    },
    /// The text is no SVG.
    #[error("this is no SVG: {reason}")]
    NoSvg {
        /// What is wrong.
        reason: String,
    },
    /// A number of the options is out of range.
    #[error("{name} is {value}, but must be positive and finite")]
    InvalidOption {
        /// Name of the option.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A coordinate or size is so large that nothing can be drawn with it.
    #[error("the number {value:e} of `{name}` is beyond {limit:e}: draw in larger units")]
    TooLarge {
        /// Name of the element, empty if it has none.
        name: String,
        /// The number.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// The curves need too many points.
    #[error("the curves of `{name}` need more than {limit} points: use a larger tolerance")]
    TooManyPoints {
        /// Name of the element, empty if it has none.
        name: String,
        /// The limit.
        limit: usize,
    },
    /// Closed curves of one path cross or touch, so that none of them is inside or outside of the other.
    #[error(
        "subpaths of `{name}` cross or touch near ({:.4e}, {:.4e}) m: unite them, or draw each as a path of its own", at[0], at[1]
    )]
    PartsMeet {
        /// Name of the element, empty if it has none.
        name: String,
        /// Near where (m).
        at: [f64; 2],
    },
    /// There is no element of a name.
    #[error("there is no element with the id `{name}`")]
    NoSuchElement {
        /// The name.
        name: String,
    },
    /// There is nothing that has an area.
    #[error("there are no filled shapes: convert text to paths, and strokes to outlines")]
    NoShapes,
}
