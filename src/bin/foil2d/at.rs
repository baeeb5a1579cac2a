//! Values that know where they stand, and lists of a length that is asked for.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// A value that knows where it stands, so that what is wrong with it can be told there.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(transparent)]
pub struct At<T>(Spanned<T>);

impl<T> At<T> {
    /// A value that no scene holds: a default.
    pub fn unsaid(value: T) -> Self {
        Self(Spanned::new(0..0, value))
    }

    pub fn get(&self) -> &T {
        self.0.get_ref()
    }

    /// Where it begins in the text, if it stands there.
    pub fn byte(&self) -> Option<usize> {
        let span = self.0.span();
        (!span.is_empty()).then_some(span.start)
    }
}

impl<T: Default> Default for At<T> {
    fn default() -> Self {
        Self::unsaid(T::default())
    }
}

impl<T: JsonSchema> JsonSchema for At<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }

    fn inline_schema() -> bool {
        T::inline_schema()
    }
}

/// Two values. Serde's own arrays take the first two of any list.
#[derive(Clone, Copy, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Pair<T>(pub [T; 2]);

impl<T: fmt::Debug> fmt::Debug for Pair<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

struct OfTwo<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OfTwo<T> {
    type Value = Pair<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of two")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Pair<T>, A::Error> {
        let mut next = |length| {
            let found = list.next_element()?;
            found.ok_or_else(|| A::Error::invalid_length(length, &"a list of two"))
        };
        let pair = [next(0)?, next(1)?];
        let mut length = 2;
        while list.next_element::<IgnoredAny>()?.is_some() {
            length += 1;
        }
        match length {
            2 => Ok(Pair(pair)),
            _ => Err(A::Error::invalid_length(length, &"a list of two")),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Pair<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(OfTwo(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Pair<T> {
    fn schema_name() -> Cow<'static, str> {
        <[T; 2]>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <[T; 2]>::json_schema(generator)
    }

    fn inline_schema() -> bool {
        <[T; 2]>::inline_schema()
    }
}
