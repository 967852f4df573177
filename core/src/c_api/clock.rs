//! Time from a counter of 32 bits.

use super::object::room;
use super::status::{SinewStatus, status};

/// A time of 64 bits that follows a counter of 32 bits; one of zeros begins with the counter's
/// value. One clock serves all objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct SinewClock {
    /// The latest time, microseconds. After a restart that of the last frame before it, so that
    /// time goes on: a restored state refuses frames that lie before its own.
    pub time_us: u64,
    /// The counter at that time.
    pub counter_us: u32,
    /// 1 if both are set; 0 begins anew with the next counter.
    pub has_begun: u32,
}

impl SinewClock {
    /// The time of a counter's value: forward by less than half of the counter's range, or back.
    const fn time_us(&mut self, counter_us: u32) -> u64 {
        if self.has_begun == 0 {
            *self = Self { time_us: counter_us as u64, counter_us, has_begun: 1 };
            return self.time_us;
        }
        let forward_us = counter_us.wrapping_sub(self.counter_us);
        if forward_us > u32::MAX / 2 {
            return self.time_us.saturating_sub(forward_us.wrapping_neg() as u64);
        }
        self.time_us = self.time_us.saturating_add(forward_us as u64);
        self.counter_us = counter_us;
        self.time_us
    }
}

/// Writes the time of 64 bits for a counter of microseconds that wraps after 2^32, 71.6 minutes.
///
/// Call it at least every half hour, also while no frames come: wraps that it does not see are
/// lost. A counter that lies before the latest one, as that of a frame that was taken before
/// another call, gives its own time and does not turn the clock back.
///
/// # Safety
/// No other task uses `clock` at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_clock_us(
    clock: *mut SinewClock,
    counter_us: u32,
    timestamp_us: *mut u64,
) -> SinewStatus {
    // SAFETY: the caller's duty; any bits make a clock.
    status(unsafe {
        (|| {
            let (clock, timestamp_us) = (room(clock)?.assume_init_mut(), room(timestamp_us)?);
            timestamp_us.write(clock.time_us(counter_us));
            Ok(())
        })()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ptr::null_mut;

    const MINUTE_US: u32 = 60_000_000;

    fn time_us(clock: &mut SinewClock, counter_us: u32) -> u64 {
        super::super::every_object::written(|time| {
            // SAFETY: both are there.
            unsafe { sinew_clock_us(clock, counter_us, time) }
        })
    }

    #[test]
    fn time_goes_on_where_the_counter_wraps() {
        let mut clock = SinewClock::default();
        let mut counter_us = u32::MAX - 5;
        let first_us = time_us(&mut clock, counter_us);
        assert_eq!(first_us, u64::from(u32::MAX) - 5);
        // Four days, a look at the clock every half hour.
        for half_hours in 1..=192 {
            counter_us = counter_us.wrapping_add(30 * MINUTE_US);
            assert_eq!(time_us(&mut clock, counter_us) - first_us, half_hours * 30 * u64::from(MINUTE_US));
        }
    }

    #[test]
    fn a_counter_from_before_gives_its_own_time() {
        let mut clock = SinewClock::default();
        assert_eq!(time_us(&mut clock, 7), 7);
        assert_eq!(time_us(&mut clock, 3), 3);
        assert_eq!(time_us(&mut clock, 5_u32.wrapping_neg()), 0, "none lies before zero");
        assert_eq!(time_us(&mut clock, 8), 8);
        assert_eq!(clock, SinewClock { time_us: 8, counter_us: 8, has_begun: 1 });
    }

    #[test]
    fn a_clock_goes_on_after_a_restart() {
        let mut clock = SinewClock { time_us: 10_000_000_000, counter_us: 40, has_begun: 1 };
        assert_eq!(time_us(&mut clock, 1040), 10_000_001_000);
    }

    #[test]
    fn null_is_refused() {
        let (mut clock, mut time_us) = (SinewClock::default(), 0);
        // SAFETY: null is refused.
        let statuses =
            unsafe { [sinew_clock_us(null_mut(), 1, &raw mut time_us), sinew_clock_us(&raw mut clock, 1, null_mut())] };
        assert_eq!((statuses, clock), ([SinewStatus::NullPointer; 2], SinewClock::default()));
    }
}
