//! What a stop is in the middle of a motion that repeats: no part of its cycles.

/// Longest time without any measurement that is bridged, cycles. Beyond it the person may have
/// stopped: nothing is said, and the cycles on both sides are counted apart. Who is seen to stand
/// for longer has stopped.
pub const LONGEST_BRIDGE_CYCLES: f64 = 1.0;

/// The longest that one cycle takes without a stop, of the times of a recording's cycles: beyond
/// it, the person stood for more than [`LONGEST_BRIDGE_CYCLES`] of the usual cycle. Infinite for no
/// times.
#[must_use]
pub fn longest_without_stop(times: &[f64]) -> f64 {
    // Of an even number the lower middle: of two cycles the one without a stop.
    usual(times).map_or(f64::INFINITY, |usual| (1.0 + LONGEST_BRIDGE_CYCLES) * usual)
}

/// The usual time of a cycle: the middle one, of an even number the lower.
#[must_use]
pub fn usual(times: &[f64]) -> Option<f64> {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len().checked_sub(1)? / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_with_a_stop_is_longer_than_two() {
        assert_eq!(longest_without_stop(&[1.0, 5.0]), 2.0);
        assert_eq!(longest_without_stop(&[1.1, 1.0, 5.0, 1.2, 1.1]), 2.2);
        assert_eq!(longest_without_stop(&[]), f64::INFINITY);
    }
}
