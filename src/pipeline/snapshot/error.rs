//! Why a snapshot cannot be taken or restored.

use super::{FORMAT, PRECISION};
use crate::body::FlexBodyHandle;
use crate::fe::record::ModelRecordError;
use thiserror::Error;

/// Why a snapshot cannot be taken or restored.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SnapshotError {
    /// The data was written by something else.
    #[error("this is no snapshot of foil2d: it begins with {0:#018x}")]
    Foreign(u64),
    /// The data was written by a version with another format.
    #[error(
        "the snapshot has format {0} and this version of foil2d reads format {FORMAT}: restore it with the version that wrote it"
    )]
    Format(u32),
    /// The data was written with rapier in another precision.
    #[error(
        "the snapshot holds rapier's world in {0} bits and this program has {PRECISION}: build it with the other one of the features `f32` and `f64`"
    )]
    Precision(u8),
    /// The data is not what was written.
    #[error(
        "the snapshot is damaged: its checksum is not that of its data. Use a format that keeps every bit of a float"
    )]
    Damaged,
    /// A flexible body cannot be saved or restored.
    #[error("flexible body {body:?}: {source}")]
    Body {
        /// The body.
        body: FlexBodyHandle,
        /// Why.
        source: ModelRecordError,
    },
    /// Parts of the data contradict each other.
    #[error("the snapshot is damaged: its {0} do not fit each other")]
    Inconsistent(&'static str),
}
