//! Chosen numbers over time, as a table.

use super::output::{OutputError, write};
use std::fmt::Write as _;
use std::path::Path;
use thiserror::Error;

/// Columns with names, and a row for every recorded time.
///
/// ```
/// use foil2d::io::History;
///
/// let mut history = History::new(["tip (m)", "force (N)"]);
/// history.record(0.0, [0.0, 10.0])?;
/// history.record(0.5, [-0.125, 9.5])?;
/// assert_eq!(history.to_csv(), "time (s),tip (m),force (N)\n0.0,0.0,10.0\n0.5,-0.125,9.5\n");
/// assert_eq!(history.column("tip (m)"), Some(vec![0.0, -0.125]));
/// assert!(history.record(1.0, [1.0]).is_err());
/// # Ok::<(), foil2d::io::HistoryError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    names: Vec<String>,
    times: Vec<f64>,
    /// Row by row.
    values: Vec<f64>,
}

/// Why a row was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum HistoryError {
    /// A row has too few or too many numbers.
    #[error(
        "the row at {time} s has {found} numbers, the table {expected} columns beside the time"
    )]
    WrongLength {
        /// Time of the row (s).
        time: f64,
        /// Columns beside the time.
        expected: usize,
        /// Numbers of the row.
        found: usize,
    },
}

impl History {
    /// An empty table with these columns beside the time; put units into their names.
    pub fn new<N: Into<String>>(names: impl IntoIterator<Item = N>) -> Self {
        Self {
            names: names.into_iter().map(Into::into).collect(),
            times: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Appends a row.
    ///
    /// # Errors
    /// If it has not one number for each column; the table stays as it was.
    pub fn record(&mut self, time: f64, row: impl AsRef<[f64]>) -> Result<(), HistoryError> {
        let row = row.as_ref();
        if row.len() != self.names.len() {
            return Err(HistoryError::WrongLength {
                time,
                expected: self.names.len(),
                found: row.len(),
            });
        }
        self.times.push(time);
        self.values.extend_from_slice(row);
        Ok(())
    }

    /// Names of the columns beside the time.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Times of the rows (s).
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The numbers of the first column of a name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let column = self.names.iter().position(|one| one == name)?;
        let rows = self.values.chunks_exact(self.names.len());
        Some(rows.map(|row| row[column]).collect())
    }

    /// The table as comma-separated values (RFC 4180): names first, numbers with all their digits.
    pub fn to_csv(&self) -> String {
        let mut csv = String::from("time (s)");
        for name in &self.names {
            csv.push(',');
            if name.contains([',', '"', '\n', '\r']) {
                let _ = write!(csv, "\"{}\"", name.replace('"', "\"\""));
            } else {
                csv.push_str(name);
            }
        }
        csv.push('\n');
        let n = self.names.len();
        for (row, time) in self.times.iter().enumerate() {
            let _ = write!(csv, "{time:?}");
            for value in &self.values[row * n..(row + 1) * n] {
                let _ = write!(csv, ",{value:?}");
            }
            csv.push('\n');
        }
        csv
    }

    /// Writes the table to a file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), OutputError> {
        write(path.as_ref().to_owned(), self.to_csv().as_bytes())
    }
}
