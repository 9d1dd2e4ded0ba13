//! Timestamps.

use foxglove::messages::Timestamp;

use super::timestamp;

#[test]
fn times_are_exact_to_the_nanosecond_and_never_before_the_epoch() {
    assert_eq!(timestamp(0.0), Timestamp::new(0, 0));
    assert_eq!(timestamp(0.07), Timestamp::new(0, 70_000_000));
    assert_eq!(timestamp(225.999_999_999_9), Timestamp::new(226, 0));
    assert_eq!(timestamp(-1.0), Timestamp::new(0, 0));
    assert_eq!(timestamp(f64::NAN), Timestamp::new(0, 0));
    assert_eq!(timestamp(f64::INFINITY), Timestamp::MAX);
}
