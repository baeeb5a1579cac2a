//! The time that stages take.

/// Laps of a stop-watch, if the feature `timing` is on.
#[derive(Debug)]
pub(super) struct Clock {
    #[cfg(feature = "timing")]
    last: std::time::Instant,
}

impl Clock {
    pub fn start() -> Self {
        Self {
            #[cfg(feature = "timing")]
            last: std::time::Instant::now(),
        }
    }

    pub fn lap(&mut self, _sum: &mut f64) {
        #[cfg(feature = "timing")]
        {
            let now = std::time::Instant::now();
            *_sum += (now - self.last).as_secs_f64();
            self.last = now;
        }
    }
}
