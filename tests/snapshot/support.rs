//! How runs are saved, and how they are compared: by the checksums of their snapshots and by what the user's handler heard.

pub use super::scenes::*;
use foil2d::pipeline::Snapshot;

impl Run {
    pub fn snapshot(&self) -> Snapshot {
        Snapshot::take(&self.world, &self.flex_bodies, &self.flex).expect("all laws are built in")
    }

    pub fn bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.snapshot()).expect("a snapshot is written")
    }

    /// Of every bit; bytes hold hash maps of rapier's, whose order says nothing.
    pub fn checksum(&self) -> u64 {
        self.snapshot().checksum().expect("a snapshot is written")
    }

    /// The run saved to bytes and read again.
    pub fn resumed(&self) -> Self {
        let snapshot: Snapshot = postcard::from_bytes(&self.bytes()).expect("a snapshot is read");
        let (world, flex_bodies, flex) = snapshot.restore().expect("a sound one");
        Self {
            world,
            flex_bodies,
            flex,
            n_steps: self.n_steps,
            held: self.held,
        }
    }
}

/// Fails where two runs differ, with the surroundings of the first difference.
#[track_caller]
pub fn assert_same(one: &Run, other: &Run, when: &str) {
    if one.checksum() == other.checksum() {
        return;
    }
    let text = |run: &Run| serde_json::to_string(&run.snapshot()).expect("a snapshot has a text");
    let [one, other] = [text(one), text(other)];
    let pairs = one.bytes().zip(other.bytes());
    let place = pairs.take_while(|(a, b)| a == b).count();
    let around =
        |text: &str| text[place.saturating_sub(300)..text.len().min(place + 60)].to_owned();
    panic!(
        "the runs differ {when}:\n{}\n{}",
        around(&one),
        around(&other)
    );
}

/// Steps both and compares them: every bit that is saved, and what was heard.
#[track_caller]
pub fn compare(straight: &mut Run, resumed: &mut Run, n_steps: usize) {
    let (one, other) = (Recorder::default(), Recorder::default());
    for step in 0..n_steps {
        straight.step(&one);
        resumed.step(&other);
        assert_eq!(one.take(), other.take(), "events of step {step}");
    }
    assert_same(straight, resumed, &format!("after {n_steps} steps"));
}
