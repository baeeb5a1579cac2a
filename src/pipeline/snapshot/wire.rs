//! How a snapshot goes through a format: the header first, so that data of another version is never read, then the data, then its
//! checksum.

use super::checksum::checksum;
use super::{Data, FORMAT, PRECISION, Snapshot, SnapshotError};
use serde::de::{self, Deserialize, Deserializer, IgnoredAny, SeqAccess, Visitor};
use serde::ser::{self, Serialize, SerializeTuple, Serializer};
use std::fmt;

/// `foil2d` in ASCII, twice a zero byte before it.
const MAGIC: u64 = 0x0000_666f_696c_3264;

/// What is written: magic, format, precision, data, checksum.
const N_PARTS: usize = 5;

/// What the data says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Header {
    magic: u64,
    format: u32,
    precision: u8,
    is_sound: bool,
}

impl Header {
    /// The header of what this program writes.
    pub fn own() -> Self {
        Self {
            magic: MAGIC,
            format: FORMAT,
            precision: PRECISION,
            is_sound: true,
        }
    }

    /// # Errors
    /// If the data is not ours, of another version or precision, or damaged.
    pub fn check(&self) -> Result<(), SnapshotError> {
        if self.magic != MAGIC {
            Err(SnapshotError::Foreign(self.magic))
        } else if self.format != FORMAT {
            Err(SnapshotError::Format(self.format))
        } else if self.precision != PRECISION {
            Err(SnapshotError::Precision(self.precision))
        } else if !self.is_sound {
            Err(SnapshotError::Damaged)
        } else {
            Ok(())
        }
    }
}

impl Serialize for Snapshot {
    /// A snapshot that was read and could not be understood cannot be written.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Some(data) = &self.data else {
            let error = self.header.check().err().unwrap_or(SnapshotError::Damaged);
            return Err(ser::Error::custom(error));
        };
        let sum = checksum(data).map_err(ser::Error::custom)?;
        let mut parts = serializer.serialize_tuple(N_PARTS)?;
        parts.serialize_element(&self.header.magic)?;
        parts.serialize_element(&self.header.format)?;
        parts.serialize_element(&self.header.precision)?;
        parts.serialize_element(&**data)?;
        parts.serialize_element(&sum)?;
        parts.end()
    }
}

impl<'de> Deserialize<'de> for Snapshot {
    /// Reads the header, and goes on only if it is one of ours; [`Snapshot::restore`] tells what was wrong.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let is_text = deserializer.is_human_readable();
        deserializer.deserialize_tuple(N_PARTS, Parts { is_text })
    }
}

struct Parts {
    /// Texts have to be read to their end.
    is_text: bool,
}

impl<'de> Visitor<'de> for Parts {
    type Value = Snapshot;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a snapshot of foil2d")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Snapshot, A::Error> {
        let mut header = Header {
            magic: next(&mut parts, 0)?,
            format: 0,
            precision: 0,
            is_sound: true,
        };
        if header.magic == MAGIC {
            header.format = next(&mut parts, 1)?;
        }
        if header.format == FORMAT {
            header.precision = next(&mut parts, 2)?;
        }
        if header.check().is_err() {
            while self.is_text && parts.next_element::<IgnoredAny>()?.is_some() {}
            return Ok(Snapshot { header, data: None });
        }
        let data: Box<Data> = next(&mut parts, 3)?;
        let sum: u64 = next(&mut parts, 4)?;
        header.is_sound = checksum(&*data) == Ok(sum);
        Ok(Snapshot {
            header,
            data: Some(data),
        })
    }
}

fn next<'de, A: SeqAccess<'de>, T: Deserialize<'de>>(
    parts: &mut A,
    index: usize,
) -> Result<T, A::Error> {
    let part = parts.next_element()?;
    part.ok_or_else(|| de::Error::invalid_length(index, &"the five parts of a snapshot"))
}
