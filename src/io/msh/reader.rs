//! The bytes of a file, read as tokens or as binary numbers.

use super::error::{MshError, MshPlace};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As text, with white space between.
    Ascii,
    /// As `i32`, `f64` and unsigned integers of `size_bytes`.
    Binary {
        is_big_endian: bool,
        size_bytes: usize,
    },
}

/// A place in the bytes of a file.
#[derive(Clone, Debug)]
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) encoding: Encoding,
}

/// Longest piece of a file that an error repeats.
const SHOWN: usize = 40;

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            encoding: Encoding::Ascii,
        }
    }

    /// Bytes read so far.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// Where the next number begins, behind the white space of text.
    pub(super) fn start(&mut self) -> usize {
        if self.encoding == Encoding::Ascii {
            self.skip_space();
        }
        self.at
    }

    /// A byte as errors tell it.
    pub(super) fn place(&self, offset: usize) -> MshPlace {
        match self.encoding {
            Encoding::Ascii => {
                let before = &self.bytes[..offset.min(self.bytes.len())];
                MshPlace::Line(1 + before.iter().filter(|&&byte| byte == b'\n').count())
            }
            Encoding::Binary { .. } => MshPlace::Byte(offset),
        }
    }

    /// How many things of at least `bytes` each may still follow: what a file says of its size is not to be trusted.
    pub(super) fn room_for(&self, count: u64, bytes: usize) -> usize {
        let most = (self.bytes.len() - self.at) / bytes;
        usize::try_from(count).map_or(most, |count| count.min(most))
    }

    fn skip_space(&mut self) {
        let rest = &self.bytes[self.at..];
        let space = rest.iter().take_while(|byte| byte.is_ascii_whitespace());
        self.at += space.count();
    }

    /// The error of a file that ends here.
    fn cut(&self, expected: &'static str) -> MshError {
        MshError::Cut {
            place: self.place(self.at),
            expected,
        }
    }

    /// The error of something else standing at `offset`.
    pub(super) fn unexpected(
        &self,
        offset: usize,
        expected: &'static str,
        found: &[u8],
    ) -> MshError {
        let shown = &found[..found.len().min(SHOWN)];
        MshError::Unexpected {
            place: self.place(offset),
            expected,
            found: shown.escape_ascii().to_string(),
        }
    }

    /// The next word, if there is one.
    pub(super) fn word(&mut self) -> Option<(usize, &'a [u8])> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|byte| !byte.is_ascii_whitespace());
        let word = &rest[..length.count()];
        let start = self.at;
        self.at += word.len();
        (!word.is_empty()).then_some((start, word))
    }

    /// A number written as text.
    pub(super) fn text<T: std::str::FromStr>(
        &mut self,
        expected: &'static str,
    ) -> Result<T, MshError> {
        let (start, word) = self.word().ok_or_else(|| self.cut(expected))?;
        let parsed = std::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse().ok());
        parsed.ok_or_else(|| self.unexpected(start, expected, word))
    }

    fn raw<const N: usize>(&mut self, expected: &'static str) -> Result<[u8; N], MshError> {
        let found = self.bytes[self.at..].first_chunk::<N>();
        let Some(&raw) = found else {
            return Err(self.cut(expected));
        };
        self.at += N;
        Ok(raw)
    }

    /// A signed integer.
    pub(super) fn integer(&mut self, expected: &'static str) -> Result<i64, MshError> {
        match self.encoding {
            Encoding::Ascii => self.text(expected),
            Encoding::Binary { is_big_endian, .. } => {
                let raw = self.raw::<4>(expected)?;
                Ok(i64::from(if is_big_endian {
                    i32::from_be_bytes(raw)
                } else {
                    i32::from_le_bytes(raw)
                }))
            }
        }
    }

    /// A count or the number of a node or an element.
    pub(super) fn size(&mut self, expected: &'static str) -> Result<u64, MshError> {
        let Encoding::Binary {
            is_big_endian,
            size_bytes,
        } = self.encoding
        else {
            return self.text(expected);
        };
        if size_bytes == 4 {
            let raw = self.raw::<4>(expected)?;
            return Ok(u64::from(if is_big_endian {
                u32::from_be_bytes(raw)
            } else {
                u32::from_le_bytes(raw)
            }));
        }
        let raw = self.raw::<8>(expected)?;
        Ok(if is_big_endian {
            u64::from_be_bytes(raw)
        } else {
            u64::from_le_bytes(raw)
        })
    }

    /// A finite number.
    pub(super) fn real(&mut self, expected: &'static str) -> Result<f64, MshError> {
        let start = self.start();
        let value = match self.encoding {
            Encoding::Ascii => self.text(expected)?,
            Encoding::Binary { is_big_endian, .. } => {
                let raw = self.raw::<8>(expected)?;
                if is_big_endian {
                    f64::from_be_bytes(raw)
                } else {
                    f64::from_le_bytes(raw)
                }
            }
        };
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.unexpected(start, "a finite number", value.to_string().as_bytes()))
    }

    /// What is left of the line.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&byte| byte == b'\n');
        let line = &rest[..end.unwrap_or(rest.len())];
        self.at += end.map_or(rest.len(), |end| end + 1);
        line.strip_suffix(b"\r").unwrap_or(line)
    }

    /// Reads the mark that ends a section.
    pub(super) fn end_of(&mut self, mark: &'static str) -> Result<(), MshError> {
        match self.word() {
            Some((_, word)) if word == mark.as_bytes() => Ok(()),
            Some((start, word)) => Err(self.unexpected(start, mark, word)),
            None => Err(self.cut(mark)),
        }
    }

    /// Goes behind the end of a section that is not read.
    pub(super) fn skip_section(&mut self, name: &[u8]) -> Result<(), MshError> {
        let mark = [b"$End", &name[1.min(name.len())..]].concat();
        let rest = &self.bytes[self.at..];
        let found = rest.windows(mark.len()).position(|window| window == mark);
        match found {
            Some(start) => {
                self.at += start + mark.len();
                Ok(())
            }
            None => Err(self.cut("the end of a section")),
        }
    }
}
