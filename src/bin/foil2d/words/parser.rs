//! What is no scene: the phrases of the parser.

/// Phrases that tell of Rust's types, and what they mean.
const PHRASES: [(&str, &str); 8] = [
    (
        "wanted exactly 1 element, more than 1 element",
        "there is more than one kind here: choose one",
    ),
    (
        "wanted exactly 1 element, found 0 elements",
        "there is no kind here: choose one",
    ),
    (
        "unit variant, expected struct variant",
        "a kind without its numbers, expected a table of them",
    ),
    (
        "unit variant, expected newtype variant",
        "a kind without its value, expected it behind a dot, as in `kind.value = ...`",
    ),
    (
        "map, expected a sequence",
        "one table, expected a list of them, as by `[[...]]`",
    ),
    (
        "expected usize",
        "expected a whole number that is not negative",
    ),
    ("expected f64", "expected a number"),
    ("invalid type: map", "invalid type: a table"),
];

/// What the parser says, in the words of TOML.
pub fn of_parser(message: &str) -> String {
    let all = PHRASES.iter();
    all.fold(message.to_owned(), |told, (phrase, meaning)| {
        told.replace(phrase, meaning)
    })
}
