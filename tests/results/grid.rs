//! A reader of `.vtu` files for tests: tags by search, arrays in all three encodings.

use std::collections::HashMap;

/// Arrays of one piece, by name.
pub type Arrays = HashMap<String, Vec<f64>>;

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let start = tag
        .find(&format!(" {name}=\""))
        .unwrap_or_else(|| panic!("{tag} has no {name}"));
    let value = &tag[start + name.len() + 3..];
    &value[..value.find('"').expect("the value ends")]
}

/// Bytes of base64 text (RFC 4648).
pub fn from_base64(text: &str) -> Vec<u8> {
    let digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bytes, mut bits, mut n_bits) = (Vec::new(), 0u32, 0);
    for digit in text.trim().trim_end_matches('=').chars() {
        let value = digits.find(digit).expect("a digit of base64") as u32;
        bits = (bits << 6 | value) & 0xffff;
        n_bits += 6;
        if n_bits >= 8 {
            n_bits -= 8;
            bytes.push((bits >> n_bits) as u8);
        }
    }
    bytes
}

fn numbers(kind: &str, bytes: &[u8]) -> Vec<f64> {
    let length = u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes")) as usize;
    let bytes = &bytes[8..8 + length];
    let eight = |chunk: &[u8]| chunk.try_into().expect("eight bytes");
    match kind {
        "Float64" => bytes
            .chunks(8)
            .map(|c| f64::from_le_bytes(eight(c)))
            .collect(),
        "Int64" => bytes
            .chunks(8)
            .map(|c| i64::from_le_bytes(eight(c)) as f64)
            .collect(),
        "UInt8" => bytes.iter().map(|&byte| f64::from(byte)).collect(),
        _ => panic!("{kind}"),
    }
}

/// The pieces of a file; every tag that is opened is closed, in the right order.
pub fn read(bytes: &[u8]) -> Vec<Arrays> {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let appended = bytes.windows(mark.len()).position(|window| window == mark);
    let end = appended.map_or(bytes.len(), |start| start + mark.len());
    let text = std::str::from_utf8(&bytes[..end]).expect("the XML is text");
    let (mut pieces, mut open): (Vec<Arrays>, Vec<&str>) = (Vec::new(), Vec::new());
    for (start, _) in text.match_indices('<') {
        let tag = &text[start + 1..];
        let tag = &tag[..tag.find('>').expect("the tag ends")];
        let name = tag.split([' ', '/']).next().expect("there is a name");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
            continue;
        }
        if tag.starts_with('?') {
            continue;
        }
        match name {
            "VTKFile" => {
                assert_eq!(attribute(tag, "type"), "UnstructuredGrid");
                assert_eq!(attribute(tag, "byte_order"), "LittleEndian");
                assert_eq!(attribute(tag, "header_type"), "UInt64");
            }
            "Piece" => {
                pieces.push(Arrays::new());
                let counts = ["NumberOfPoints", "NumberOfCells"].map(|name| {
                    let count = attribute(tag, name).parse().expect("a count");
                    (name.to_owned(), vec![count])
                });
                pieces.last_mut().expect("it was pushed").extend(counts);
            }
            "DataArray" => {
                let kind = attribute(tag, "type");
                let inner = &text[start + tag.len() + 2..];
                let inner = &inner[..inner.find('<').unwrap_or(inner.len())];
                let values = match attribute(tag, "format") {
                    "ascii" => inner
                        .split_ascii_whitespace()
                        .map(|word| word.parse().expect("a number"))
                        .collect(),
                    "binary" => numbers(kind, &from_base64(inner)),
                    "appended" => {
                        let offset: usize = attribute(tag, "offset").parse().expect("an offset");
                        numbers(kind, &bytes[end + offset..])
                    }
                    other => panic!("{other}"),
                };
                let name = attribute(tag, "Name").to_owned();
                let known = pieces
                    .last_mut()
                    .expect("within a piece")
                    .insert(name, values);
                assert!(known.is_none());
            }
            _ => {}
        }
        if !tag.ends_with('/') {
            open.push(name);
        }
    }
    let left: &[&str] = if appended.is_some() {
        &["VTKFile", "AppendedData"]
    } else {
        &[]
    };
    assert_eq!(open, left);
    pieces
}
