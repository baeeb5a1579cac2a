//! Bytes as text (RFC 4648, with padding).

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Appends bytes to a text, four characters for three bytes.
pub(super) fn push_base64(text: &mut String, bytes: &[u8]) {
    text.reserve(4 * bytes.len().div_ceil(3));
    for three in bytes.chunks(3) {
        let byte = |index: usize| u32::from(three.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for index in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * index)) as usize % 64];
            let is_padding = index > three.len();
            text.push(if is_padding { '=' } else { char::from(digit) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::push_base64;

    /// The test vectors of RFC 4648, section 10, and both characters that are neither letters nor digits.
    #[test]
    fn bytes_become_the_text_of_the_standard() {
        let vectors: [(&[u8], &str); 8] = [
            (b"", ""),
            (b"f", "Zg=="),
            (b"fo", "Zm8="),
            (b"foo", "Zm9v"),
            (b"foob", "Zm9vYg=="),
            (b"fooba", "Zm9vYmE="),
            (b"foobar", "Zm9vYmFy"),
            (&[0xfb, 0xef, 0xff], "++//"),
        ];
        for (bytes, expected) in vectors {
            let mut text = String::new();
            push_base64(&mut text, bytes);
            assert_eq!(text, expected);
        }
    }
}
