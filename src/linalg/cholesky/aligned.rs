//! Memory that begins with a cache line.

/// Bytes of a cache line.
const LINE: usize = 64;

/// Columns of four numbers, none of which crosses a cache line.
///
/// Large allocations begin 16 bytes into a page: every other column would be fetched from two lines.
#[derive(Debug, Clone)]
pub(super) struct AlignedColumns {
    numbers: Vec<f64>,
    /// Where the first column begins. A clone keeps it, and may so be slower, but not wrong.
    offset: usize,
    n_columns: usize,
}

impl AlignedColumns {
    /// Columns of zeros.
    pub fn zeros(n_columns: usize) -> Self {
        let n_spare = LINE / size_of::<f64>();
        let numbers = vec![0.0; 4 * n_columns + n_spare];
        Self {
            offset: numbers.as_ptr().align_offset(LINE).min(n_spare),
            numbers,
            n_columns,
        }
    }

    pub fn get(&self) -> &[[f64; 4]] {
        self.numbers[self.offset..][..4 * self.n_columns]
            .as_chunks()
            .0
    }

    pub fn get_mut(&mut self) -> &mut [[f64; 4]] {
        self.numbers[self.offset..][..4 * self.n_columns]
            .as_chunks_mut()
            .0
    }
}
