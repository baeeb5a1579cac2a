mod common;
#[path = "fast/crossing.rs"]
mod crossing;
#[path = "fast/range.rs"]
mod range;
use range::*;
#[test]
fn shot() {
    let seed: u64 = std::env::var("SEED").unwrap().parse().unwrap();
    let shot = Shot::random(seed);
    eprintln!("{shot:?}");
    let outcome = Range::new(shot).run();
    eprintln!("{:?}", outcome.tunnelled);
}
