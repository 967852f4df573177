//! One training cycle as a smooth curve over the cycle position.

use crate::cyclic::angle_table::{ANGLES, AngleTable, angle_columns, sides_exchanged};
use crate::cyclic::cuts::Cut;
use crate::cyclic::spline::CubicSpline;
use crate::cyclic::turns::unwrap_along_time;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Frames on each side of the cut that the curve goes through, where the recording has them. What
/// lies farther off changes a cubic spline inside the cut by less than a millionth.
const MARGIN_FRAMES: u64 = 10;
/// Longest cycle, frames; more is taken for a mistake.
const LONGEST_CYCLE_FRAMES: u64 = 1_000_000;
/// Longest gap that is bridged, as a fraction of the cycle.
const LONGEST_GAP: f64 = 0.1;

/// One cycle: each angle as a curve over the position, 0 at the cut's first frame and 1 at the
/// first frame after it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingCycle {
    start_frame: f64,
    duration_frames: f64,
    rate_hz: Option<f64>,
    curves: Vec<CubicSpline>,
    person: Option<String>,
    weight: f64,
}

impl TrainingCycle {
    /// The cycle of `table` between the frames of `cut`.
    ///
    /// Angles are unwrapped along time. The frames beyond the cut belong to the curve, since a real
    /// cycle does not close. Where the recording ends at the cut, it is continued by the cycle's
    /// own other end.
    ///
    /// # Errors
    /// The cut lies outside of the table, or is shorter than four frames or longer than a million.
    /// Or an angle is missing for more than a tenth of it.
    pub fn new(table: &AngleTable, cut: &Cut) -> Result<Self, String> {
        let (start, end) = (cut.start_frame, cut.end_frame);
        if start < table.first_frame() || end > table.end_frame() {
            let (first, last) = (table.first_frame(), table.end_frame() - 1);
            return Err(format!(
                "the cut {start} to {end} (end excluded) lies outside of the table, which has frames {first} to {last}"
            ));
        }
        if cut.duration_frames() < 4 {
            return Err(format!("the cut {start} to {end} is shorter than four frames"));
        }
        if cut.duration_frames() > LONGEST_CYCLE_FRAMES {
            return Err(format!("the cut {start} to {end} is longer than {LONGEST_CYCLE_FRAMES} frames"));
        }
        let curves = (0..table.angle_count()).map(|angle| curve(table, angle, start, end)).collect::<Result<_, _>>()?;
        Ok(Self {
            start_frame: start as f64,
            duration_frames: (end - start) as f64,
            rate_hz: table.rate_hz(),
            curves,
            person: cut.person.clone(),
            weight: 1.0,
        })
    }

    /// Length of the cycle, frames of the recording.
    #[must_use]
    pub fn duration_frames(&self) -> f64 {
        self.duration_frames
    }

    /// Frames per second of the recording, where its table says.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        self.rate_hz
    }

    /// Whose cycle it is, where the list says.
    #[must_use]
    pub fn person(&self) -> Option<&str> {
        self.person.as_deref()
    }

    /// The same of this person.
    #[must_use]
    pub fn of_person(mut self, person: &str) -> Self {
        self.person = Some(person.to_owned());
        self
    }

    /// The same with left and right exchanged, as of a person who moves as the mirror image does
    /// and is seen from the other side. `None` for a motion in space.
    #[must_use]
    pub fn sides_exchanged(mut self) -> Option<Self> {
        let curves: &[CubicSpline; ANGLES] = self.curves.as_slice().try_into().ok()?;
        self.curves = sides_exchanged(curves).into();
        Some(self)
    }

    /// Weight of the cycle in means: 1, or the inverse of the number of its person's cycles.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// Number of angles: 13, or 26 of a motion in space.
    #[must_use]
    pub fn angle_count(&self) -> usize {
        self.curves.len()
    }

    /// Angle `angle` at `position`, radians, unwrapped; positions a few frames outside of 0 to 1
    /// are known too.
    #[must_use]
    pub fn angle_at(&self, angle: usize, position: f64) -> f64 {
        self.curves[angle].at(self.start_frame + position * self.duration_frames)
    }

    /// Whole turns that the angle makes from the beginning of the cycle to its end.
    #[must_use]
    pub fn turns(&self, angle: usize) -> i32 {
        ((self.angle_at(angle, 1.0) - self.angle_at(angle, 0.0)) / TAU).round() as i32
    }
}

/// Gives every person the same weight, however many cycles each has.
pub fn weigh_people(cycles: &mut [TrainingCycle]) {
    let mut counts: BTreeMap<Option<String>, f64> = BTreeMap::new();
    for cycle in &*cycles {
        *counts.entry(cycle.person.clone()).or_default() += 1.0;
    }
    for cycle in cycles.iter_mut().filter(|cycle| cycle.person.is_some()) {
        cycle.weight = 1.0 / counts[&cycle.person];
    }
}

fn curve(table: &AngleTable, angle: usize, start: u64, end: u64) -> Result<CubicSpline, String> {
    let first = start.saturating_sub(MARGIN_FRAMES);
    let mut series: Vec<Option<f64>> =
        (first..end + MARGIN_FRAMES).map(|frame| table.angle_rad(frame, angle)).collect();
    unwrap_along_time(&mut series);
    let margin = (start - first) as usize;
    let mut knots: Vec<(f64, f64)> = Vec::with_capacity(series.len() + margin);
    if start == table.first_frame() {
        let before = continued_before(&series[margin..], (end - start) as usize);
        knots.extend(before.into_iter().rev().map(|(back, value)| (start as f64 - back, value)));
    }
    knots.extend((first..).zip(&series).filter_map(|(frame, value)| Some((frame as f64, (*value)?))));
    if end == table.end_frame() {
        let after = continued_after(&series[..(end - first) as usize], (end - start) as usize);
        knots.extend(after.into_iter().map(|(ahead, value)| (end as f64 + ahead, value)));
    }
    check_gaps(&knots, start as f64, end as f64).map_err(|(from, to)| {
        format!(
            "`{}` is missing between the frames {from} and {to}; a training cycle may lack an angle for a tenth of its length at most",
            angle_columns().nth(angle).unwrap_or_default()
        )
    })?;
    let (places, values) = knots.into_iter().unzip();
    CubicSpline::natural(places, values)
        .ok_or_else(|| format!("`{}` has less than two values", angle_columns().nth(angle).unwrap_or_default()))
}

/// Knots before the first frame of `series`, as (frames back, value), from the end of the cycle of
/// `duration` frames that begins there.
fn continued_before(series: &[Option<f64>], duration: usize) -> Vec<(f64, f64)> {
    let known = |index: usize| series.get(index).copied().flatten();
    let Some(first) = known(0) else { return Vec::new() };
    // Value one cycle later: measured if the recording goes on, else the first one plus the cycle's
    // whole turns.
    let closing = known(duration).or_else(|| Some(first + whole_turns(known(duration - 1)? - first)));
    let Some(closing) = closing else { return Vec::new() };
    let back = 1..=(MARGIN_FRAMES as usize).min(duration - 1);
    back.filter_map(|back| Some((back as f64, first + known(duration - back)? - closing))).collect()
}

/// Knots from the frame after `series` on, as (frames ahead, value), from the beginning of the
/// cycle of `duration` frames that ends there.
fn continued_after(series: &[Option<f64>], duration: usize) -> Vec<(f64, f64)> {
    let start = series.len() - duration;
    let known = |index: usize| series.get(index).copied().flatten();
    let (Some(last), Some(first)) = (known(series.len() - 1), known(start)) else { return Vec::new() };
    let shift = match start.checked_sub(1).and_then(known) {
        Some(before) => last - before,
        None => whole_turns(last - first),
    };
    let ahead = 0..(MARGIN_FRAMES as usize).min(duration);
    ahead.filter_map(|ahead| Some((ahead as f64, known(start + ahead)? + shift))).collect()
}

fn whole_turns(angle_rad: f64) -> f64 {
    (angle_rad / TAU).round() * TAU
}

/// The two ends of a gap that is too long and touches the cut, if there is one.
fn check_gaps(knots: &[(f64, f64)], start: f64, end: f64) -> Result<(), (f64, f64)> {
    let longest = 1.0 + LONGEST_GAP * (end - start);
    let mut ends: Vec<f64> = knots.iter().map(|knot| knot.0).collect();
    // Where no knot lies beyond the cut, its own ends bound the gap.
    if ends.first().is_none_or(|first| *first > start) {
        ends.insert(0, start);
    }
    if ends.last().is_none_or(|last| *last < end) {
        ends.push(end);
    }
    let gap = ends.windows(2).find(|gap| gap[1] > start && gap[0] < end && gap[1] - gap[0] > longest);
    gap.map_or(Ok(()), |gap| Err((gap[0], gap[1])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cut(start_frame: u64, end_frame: u64) -> Cut {
        Cut { file: "t.csv".into(), start_frame, end_frame, person: None, line: 2 }
    }

    /// All angles swing with a period of 60 frames; the last winds once a period.
    fn table(frames: u64) -> AngleTable {
        let row = |frame: u64| {
            let phase = TAU * frame as f64 / 60.0;
            let mut angles = [Some(0.4 * phase.sin()); ANGLES];
            angles[12] = Some(crate::cyclic::turns::wrapped(phase + 0.1 * phase.cos()));
            angles
        };
        AngleTable::from_angles(0, &(0..frames).map(row).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn the_curve_is_that_of_the_recording_whether_it_goes_on_or_not() {
        for (frames, start) in [(200, 70), (130, 70), (60, 0), (100, 0)] {
            let cycle = TrainingCycle::new(&table(frames), &cut(start, start + 60)).unwrap();
            for i in -1..=101 {
                let position = f64::from(i) / 100.0;
                let phase = TAU * (start as f64 / 60.0 + position);
                let swing = cycle.angle_at(0, position);
                assert!((swing - 0.4 * phase.sin()).abs() < 1.0e-5, "{frames} {i}: {swing}");
                let wind = cycle.angle_at(12, position) - cycle.angle_at(12, 0.0);
                let wanted = TAU * position + 0.1 * (phase.cos() - (TAU * start as f64 / 60.0).cos());
                assert!((wind - wanted).abs() < 1.0e-5, "{frames} {i}: {wind} is not {wanted}");
            }
        }
    }

    #[test]
    fn cuts_that_cannot_be_used_say_why() {
        let full = table(100);
        assert!(TrainingCycle::new(&full, &cut(50, 101)).unwrap_err().contains("which has frames 0 to 99"));
        assert!(TrainingCycle::new(&full, &cut(50, 53)).unwrap_err().contains("four frames"));
        let mut rows = full.rows().to_vec();
        for row in &mut rows[40..48] {
            row.angles_rad[7] = None;
        }
        let gaps = AngleTable::new(rows, Vec::new()).unwrap();
        let message = TrainingCycle::new(&gaps, &cut(10, 70)).unwrap_err();
        assert!(message.starts_with("`l_hip_rad` is missing between the frames 39 and 48"), "{message}");
        assert!(TrainingCycle::new(&gaps, &cut(10, 99)).is_ok(), "a short gap is bridged");
    }

    proptest! {
        /// A gap at either end of the cut is found as well as one inside.
        #[test]
        fn no_long_gap_passes(from in 0_u64..60) {
            let mut rows = table(200).rows().to_vec();
            rows.retain(|row| row.frame < 70 + from || row.frame >= 78 + from);
            prop_assert!(TrainingCycle::new(&AngleTable::new(rows, Vec::new()).unwrap(), &cut(70, 130)).is_err());
        }
    }
}
