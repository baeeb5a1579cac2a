//! What is not ours, of another version or damaged is refused, and never panics.

use super::support::*;
use foil2d::pipeline::{Snapshot, SnapshotError};

const MAGIC: u64 = 0x0000_666f_696c_3264;
const FORMAT: u32 = 22;

fn small() -> Run {
    let log = Recorder::default();
    let mut run = Run::new();
    let block = FlexBodyBuilder::rectangle([0.5, 0.25], [4, 2]).translation([0.0, 0.001]);
    run.flexible(block.material(rubber()));
    run.rigid([0.25, 0.46], ColliderBuilder::cuboid(0.2, 0.2));
    (0..30).for_each(|_| run.step(&log));
    run
}

fn refusal(bytes: &[u8]) -> Option<SnapshotError> {
    let snapshot: Snapshot = postcard::from_bytes(bytes).ok()?;
    snapshot.restore().err()
}

#[test]
fn data_of_something_else_is_refused_by_name() {
    let bytes = postcard::to_stdvec(&(0x1234_u64, "something else")).expect("is written");
    assert_eq!(refusal(&bytes), Some(SnapshotError::Foreign(0x1234)));
}

#[test]
fn another_format_is_refused_before_its_data_is_read() {
    let bytes =
        postcard::to_stdvec(&(MAGIC, FORMAT + 1, 32_u8, "data of tomorrow")).expect("is written");
    let error = refusal(&bytes).expect("it is refused");
    assert_eq!(error, SnapshotError::Format(FORMAT + 1));
    let own = format!("format {FORMAT}");
    assert!(error.to_string().contains(&own), "{error}");
}

#[test]
fn another_precision_is_refused() {
    let other = if size_of::<foil2d::rapier::math::Real>() == 4 {
        64_u8
    } else {
        32
    };
    let bytes = postcard::to_stdvec(&(MAGIC, FORMAT, other, "data")).expect("is written");
    assert_eq!(refusal(&bytes), Some(SnapshotError::Precision(other)));
}

#[test]
fn a_text_of_another_format_is_refused_too() {
    let other = FORMAT + 1;
    let text = format!("[{MAGIC}, {other}, 32, {{\"world\": null}}, 0]");
    let snapshot: Snapshot = serde_json::from_str(&text).expect("its header is read");
    assert_eq!(snapshot.restore().err(), Some(SnapshotError::Format(other)));
}

#[test]
fn truncated_data_is_an_error_of_the_format_at_every_length() {
    let bytes = small().bytes();
    let step = (bytes.len() / 400).max(1);
    for length in (0..bytes.len()).step_by(step).chain([bytes.len() - 1]) {
        let read = postcard::from_bytes::<Snapshot>(&bytes[..length]);
        let refused = read.map_or(true, |snapshot| snapshot.restore().is_err());
        assert!(
            refused,
            "{length} of {} bytes were taken for a world",
            bytes.len()
        );
    }
}

#[test]
fn a_flipped_bit_is_found_wherever_it_is() {
    let bytes = small().bytes();
    let mut seed = 1_u64;
    for _ in 0..2000 {
        seed = seed
            .wrapping_mul(0x5851_f42d_4c95_7f2d)
            .wrapping_add(0x1405_7b7e_f767_814f);
        let mut damaged = bytes.clone();
        let place = (seed >> 33) as usize % bytes.len();
        damaged[place] ^= 1 << (seed >> 29 & 7);
        let read = postcard::from_bytes::<Snapshot>(&damaged);
        let refused = read.map_or(true, |snapshot| snapshot.restore().is_err());
        assert!(refused, "a flipped bit in byte {place} was not found");
    }
}
