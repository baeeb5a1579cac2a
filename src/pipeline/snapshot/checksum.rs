//! A checksum of anything that serde can write, in no format: a snapshot's data must be what was written, whatever the format that
//! carried it. Rapier's own structures hold indices that nothing else would check.
//!
//! Elements of sequences and maps count without their order, for sets have none.

use crate::math::mix;
use serde::ser::{self, Serialize};
use std::fmt;

/// The checksum of a value.
///
/// # Errors
/// If the value cannot be written.
pub fn checksum(value: &impl Serialize) -> Result<u64, Unwritable> {
    value.serialize(Sum)
}

/// A value that refused to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct Unwritable(String);

impl fmt::Display for Unwritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unwritable {}

impl ser::Error for Unwritable {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

/// Writes nothing and sums up.
#[derive(Clone, Copy)]
struct Sum;

/// The sum of a value with parts.
struct Parts {
    ordered: u64,
    unordered: u64,
    key: u64,
}

impl Parts {
    fn new(seed: u64) -> Self {
        Self {
            ordered: mix(0, seed),
            unordered: 0,
            key: 0,
        }
    }

    fn add<T: Serialize + ?Sized>(&mut self, part: &T) -> Result<(), Unwritable> {
        self.ordered = mix(self.ordered, part.serialize(Sum)?);
        Ok(())
    }

    fn scatter(&mut self, part: u64) {
        self.unordered = self.unordered.wrapping_add(mix(part, 1));
        self.ordered = mix(self.ordered, 1);
    }

    fn end(self) -> u64 {
        mix(self.ordered, self.unordered)
    }
}

fn sum_bytes(bytes: &[u8]) -> u64 {
    let start = mix(0, bytes.len() as u64);
    bytes
        .iter()
        .fold(start, |sum, byte| mix(sum, u64::from(*byte)))
}

/// Numbers by their bits.
macro_rules! words {
    ($($method:ident($type:ty) => $word:expr;)*) => {
        $(fn $method(self, value: $type) -> Result<u64, Unwritable> {
            let word: fn($type) -> u64 = $word;
            Ok(mix(0, word(value)))
        })*
    };
}

impl ser::Serializer for Sum {
    type Ok = u64;
    type Error = Unwritable;
    type SerializeSeq = Parts;
    type SerializeTuple = Parts;
    type SerializeTupleStruct = Parts;
    type SerializeTupleVariant = Parts;
    type SerializeMap = Parts;
    type SerializeStruct = Parts;
    type SerializeStructVariant = Parts;

    words! {
        serialize_bool(bool) => u64::from;
        serialize_i8(i8) => |value| value as u64;
        serialize_i16(i16) => |value| value as u64;
        serialize_i32(i32) => |value| value as u64;
        serialize_i64(i64) => |value| value as u64;
        serialize_u8(u8) => u64::from;
        serialize_u16(u16) => u64::from;
        serialize_u32(u32) => u64::from;
        serialize_u64(u64) => |value| value;
        serialize_i128(i128) => |value| mix(value as u64, (value >> 64) as u64);
        serialize_u128(u128) => |value| mix(value as u64, (value >> 64) as u64);
        serialize_f32(f32) => |value| u64::from(value.to_bits());
        serialize_f64(f64) => f64::to_bits;
        serialize_char(char) => |value| u64::from(u32::from(value));
        serialize_str(&str) => |value| sum_bytes(value.as_bytes());
        serialize_bytes(&[u8]) => sum_bytes;
        serialize_unit_struct(&'static str) => |_| 0;
    }

    fn serialize_none(self) -> Result<u64, Unwritable> {
        Ok(mix(0, 2))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<u64, Unwritable> {
        Ok(mix(3, value.serialize(Sum)?))
    }

    fn serialize_unit(self) -> Result<u64, Unwritable> {
        Ok(mix(0, 0))
    }

    fn serialize_unit_variant(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
    ) -> Result<u64, Unwritable> {
        Ok(mix(4, u64::from(index)))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _name: &'static str,
        value: &T,
    ) -> Result<u64, Unwritable> {
        value.serialize(Sum)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
        value: &T,
    ) -> Result<u64, Unwritable> {
        Ok(mix(mix(5, u64::from(index)), value.serialize(Sum)?))
    }

    fn serialize_seq(self, _length: Option<usize>) -> Result<Parts, Unwritable> {
        Ok(Parts::new(6))
    }

    fn serialize_tuple(self, _length: usize) -> Result<Parts, Unwritable> {
        Ok(Parts::new(7))
    }

    fn serialize_tuple_struct(
        self,
        _name: &'static str,
        _length: usize,
    ) -> Result<Parts, Unwritable> {
        Ok(Parts::new(7))
    }

    fn serialize_tuple_variant(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
        _length: usize,
    ) -> Result<Parts, Unwritable> {
        Ok(Parts::new(mix(7, u64::from(index))))
    }

    fn serialize_map(self, _length: Option<usize>) -> Result<Parts, Unwritable> {
        Ok(Parts::new(8))
    }

    fn serialize_struct(self, _name: &'static str, _length: usize) -> Result<Parts, Unwritable> {
        Ok(Parts::new(9))
    }

    fn serialize_struct_variant(
        self,
        _name: &'static str,
        index: u32,
        _variant: &'static str,
        _length: usize,
    ) -> Result<Parts, Unwritable> {
        Ok(Parts::new(mix(9, u64::from(index))))
    }

    /// As the binary formats, which need not write names.
    fn is_human_readable(&self) -> bool {
        false
    }
}

impl ser::SerializeSeq for Parts {
    type Ok = u64;
    type Error = Unwritable;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unwritable> {
        self.scatter(value.serialize(Sum)?);
        Ok(())
    }

    fn end(self) -> Result<u64, Unwritable> {
        Ok(Parts::end(self))
    }
}

impl ser::SerializeMap for Parts {
    type Ok = u64;
    type Error = Unwritable;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Unwritable> {
        self.key = key.serialize(Sum)?;
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unwritable> {
        let entry = mix(self.key, value.serialize(Sum)?);
        self.scatter(entry);
        Ok(())
    }

    fn end(self) -> Result<u64, Unwritable> {
        Ok(Parts::end(self))
    }
}

/// What keeps the order of its parts.
macro_rules! ordered {
    ($($trait:ident::$method:ident;)*) => {
        $(impl ser::$trait for Parts {
            type Ok = u64;
            type Error = Unwritable;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unwritable> {
                self.add(value)
            }

            fn end(self) -> Result<u64, Unwritable> {
                Ok(Parts::end(self))
            }
        })*
    };
}

ordered! {
    SerializeTuple::serialize_element;
    SerializeTupleStruct::serialize_field;
    SerializeTupleVariant::serialize_field;
}

/// The same with names, which do not count.
macro_rules! named {
    ($($trait:ident;)*) => {
        $(impl ser::$trait for Parts {
            type Ok = u64;
            type Error = Unwritable;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                _name: &'static str,
                value: &T,
            ) -> Result<(), Unwritable> {
                self.add(value)
            }

            fn end(self) -> Result<u64, Unwritable> {
                Ok(Parts::end(self))
            }
        })*
    };
}

named! {
    SerializeStruct;
    SerializeStructVariant;
}
