//! Frames in which the person stands, of a motion that repeats.

use super::seen::Seen;
use crate::cyclic::stops::{LONGEST_BRIDGE_CYCLES, usual};
use crate::cyclic::tracking::cycle_times::CycleTimes;

/// Share of the usual way, and of the angles' usual standard deviation, below which a person
/// stands. Chosen: from half of the way on it is a slow cycle.
const STANDING_SHARE: f64 = 0.5;

/// Whether the person stands in each frame. By `phases`, those of a filter in cycles, less than
/// half of the usual way is passed in the time of a usual cycle around it, for a cycle or longer.
/// By what was seen, the angles have less than half of their standard deviation elsewhere: a filter
/// that is lost stands, too. The first and the last half cycle are no stop.
#[must_use]
pub fn standing<const N: usize>(seen: &Seen<N>, phases: &[f64]) -> Vec<bool> {
    let mut stands = vec![false; phases.len()];
    let Some(cycle_frames) = usual_cycle(phases) else { return stands };
    let half = (0.5 * cycle_frames).round().max(1.0) as usize;
    let Some(last) = phases.len().checked_sub(half + 1).filter(|last| *last >= half) else { return stands };
    let usual_way = (2 * half) as f64 / cycle_frames;
    for frame in half..=last {
        stands[frame] = phases[frame + half] - phases[frame - half] < STANDING_SHARE * usual_way;
    }
    let moving_rad2 = variance_rad2(seen, &(0..stands.len()).filter(|frame| !stands[*frame]));
    let mut from = 0;
    while from < stands.len() {
        let to = from + stands[from..].iter().take_while(|stands| **stands).count();
        let is_short = ((to - from) as f64) < LONGEST_BRIDGE_CYCLES * cycle_frames;
        if is_short || variance_rad2(seen, &(from..to)) >= STANDING_SHARE.powi(2) * moving_rad2 {
            stands[from..to].fill(false);
        }
        from = to + 1;
    }
    stands
}

/// Frames of the usual cycle by these phases.
fn usual_cycle(phases: &[f64]) -> Option<f64> {
    let mut times = CycleTimes::new(*phases.first()?);
    for (frame, pair) in phases.windows(2).enumerate() {
        times.pass([pair[0], pair[1]], [frame as f64, frame as f64 + 1.0]);
    }
    usual(&times.followed_s().map(|[start, end]| end - start).collect::<Vec<f64>>())
}

/// Sum of the variances of all angles over these frames.
fn variance_rad2<const N: usize>(seen: &Seen<N>, frames: &(impl Iterator<Item = usize> + Clone)) -> f64 {
    let of_angle = |angle: usize| {
        let values = || frames.clone().filter_map(|frame| seen.angles_rad[frame][angle]);
        let count = (values().count() as f64).max(1.0);
        let mean = values().sum::<f64>() / count;
        values().map(|value| (value - mean).powi(2)).sum::<f64>() / count
    };
    (0..N).map(of_angle).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Phases of a walker with 40 frames a cycle, at these speeds over so many frames each.
    fn phases(parts: &[(usize, f64)]) -> Vec<f64> {
        let mut phase = 0.3;
        let steps = parts.iter().flat_map(|(frames, speed)| std::iter::repeat_n(speed / 40.0, *frames));
        steps
            .map(|step| {
                phase += step;
                phase
            })
            .collect()
    }

    /// An angle that goes with the phase.
    fn seen(phases: &[f64]) -> Seen<1> {
        Seen { first_frame: 0, angles_rad: phases.iter().map(|phase| [Some((TAU * phase).sin())]).collect() }
    }

    #[test]
    fn who_stands_for_more_than_a_cycle_is_found_also_for_most_of_the_time() {
        for frames in [60, 300, 3000] {
            let phases = phases(&[(200, 1.0), (frames, 0.001), (200, 1.1)]);
            let found = standing(&seen(&phases), &phases);
            let count = found.iter().filter(|stands| **stands).count();
            assert!(count >= frames - 40 && count <= frames, "{count} of {frames}");
            assert!(!found[..200].contains(&true) && !found[200 + frames..].contains(&true));
        }
    }

    #[test]
    fn a_slow_part_and_short_rests_are_no_stops() {
        for parts in [&[(400, 1.0), (400, 0.4)][..], &[(400, 1.0), (400, 0.7)], &[(7, 1.0)]] {
            let phases = phases(parts);
            assert!(!standing(&seen(&phases), &phases).contains(&true), "{parts:?}");
        }
        let with_rests: Vec<(usize, f64)> = (0..10).flat_map(|_| [(40, 1.0), (60, 0.0)]).collect();
        let phases = phases(&with_rests);
        assert!(!standing(&seen(&phases), &phases).contains(&true));
        assert_eq!(standing(&seen(&[]), &[]), [false; 0]);
    }

    #[test]
    fn a_filter_that_is_lost_while_the_person_moves_is_no_stop() {
        let filtered = phases(&[(200, 1.0), (200, 0.005), (200, 1.1)]);
        assert!(!standing(&seen(&phases(&[(600, 1.0)])), &filtered).contains(&true));
    }
}
