//! Values that know where they stand.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use std::borrow::Cow;
use toml::Spanned;

/// A value that knows where it stands, so that what is wrong with it can be told there.
#[derive(Clone, Debug, Deserialize)]
#[serde(transparent)]
pub struct At<T>(Spanned<T>);

impl<T> At<T> {
    /// A value that no scene holds, as at the beginning of one.
    pub fn unsaid(value: T) -> Self {
        Self(Spanned::new(0..0, value))
    }

    pub fn get(&self) -> &T {
        self.0.get_ref()
    }

    /// Where it begins in the text.
    pub fn byte(&self) -> usize {
        self.0.span().start
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
