//! The clock.

use std::fs::File;
use std::hint::black_box;
use std::io::{Read, Seek};
use std::time::Instant;

/// A clock that stands still while the thread waits for a processor.
///
/// A median of short steps does not see other programs, that of long ones does, in favour of whoever is faster. Where
/// the system does not tell how long a thread waited (other than Linux), this is the time on the wall.
#[derive(Debug)]
pub struct Clock {
    waits: Option<File>,
}

impl Clock {
    /// Shortest step that is worth asking the system about (µs).
    const LONG: f64 = 100.0;

    /// The time on the wall.
    #[allow(dead_code, reason = "shared by two programs")]
    pub fn plain() -> Self {
        Self { waits: None }
    }

    /// For steps of any length.
    #[allow(dead_code, reason = "shared by two programs")]
    pub fn exact() -> Self {
        Self::for_steps_of(f64::MAX)
    }

    /// For steps of about this length (µs).
    pub fn for_steps_of(step: f64) -> Self {
        let waits = (step > Self::LONG).then(|| File::open("/proc/thread-self/schedstat").ok());
        Self {
            waits: waits.flatten(),
        }
    }

    /// Runs `work` and returns how long it took (µs).
    pub fn time<T>(&self, work: impl FnOnce() -> T) -> (f64, T) {
        let waited = self.waited();
        let start = Instant::now();
        let result = black_box(work());
        let wall = 1e6 * start.elapsed().as_secs_f64();
        (wall - (self.waited() - waited), result)
    }

    /// How long this thread has waited so far (µs).
    fn waited(&self) -> f64 {
        let read = |mut file: &File| {
            let mut numbers = String::new();
            file.rewind().ok()?;
            file.read_to_string(&mut numbers).ok()?;
            // Nanoseconds on a processor, nanoseconds waiting for one, turns.
            numbers.split_whitespace().nth(1)?.parse::<f64>().ok()
        };
        1e-3 * self.waits.as_ref().and_then(read).unwrap_or(0.0)
    }
}

/// The middle value, `None` of none; sorts.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
