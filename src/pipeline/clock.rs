//! The time that stages take.

/// Laps of a stop-watch, if the feature `timing` is on.
#[derive(Debug)]
pub(super) struct Clock {
    #[cfg(feature = "timing")]
    last: Option<std::time::Instant>,
}

impl Clock {
    pub fn start() -> Self {
        Self {
            #[cfg(feature = "timing")]
            last: now(),
        }
    }

    pub fn lap(&mut self, _sum: &mut f64) {
        #[cfg(feature = "timing")]
        if let (Some(last), Some(now)) = (self.last, now()) {
            *_sum += (now - last).as_secs_f64();
            self.last = Some(now);
        }
    }
}

/// `wasm32-unknown-unknown` has no clock, and to ask for one is a panic there.
#[cfg(feature = "timing")]
fn now() -> Option<std::time::Instant> {
    let has_clock = cfg!(not(all(target_family = "wasm", target_os = "unknown")));
    has_clock.then(std::time::Instant::now)
}
