//! Rows of a table to frames: rows of one frame are put together, and times become frames.

use super::clock;
use super::columns::Columns;
use super::detections::Detections;
use super::orders::{PointFrame, Points};
use super::times::{evened, rate_of_numbers, timing};
use std::collections::BTreeMap;

/// A row of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its line in the file.
    pub line: u64,
    /// Number of its frame, where a column has it.
    pub frame: Option<u64>,
    /// Its time, in the column's unit.
    pub time: Option<f64>,
    /// Whose it is, where a column says so.
    pub person: Option<String>,
    /// Points of the people that it has columns for.
    pub people: Vec<Points>,
}

/// Frames of a table.
#[derive(Debug, Default)]
pub struct Grouped {
    /// The frames, rising in number.
    pub frames: Vec<PointFrame>,
    /// When they were taken.
    pub times: FrameTimes,
}

/// What the times of frames say.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FrameTimes {
    /// Frames per second, where times are known.
    pub rate_hz: Option<f64>,
    /// Times of the frames where they come at uneven steps.
    pub uneven_times_s: Option<Vec<f64>>,
    /// What a user should know.
    pub notes: Vec<String>,
    /// What is in doubt.
    pub doubts: Vec<String>,
}

impl FrameTimes {
    /// `found` with the rate; where frames come at uneven times, with frames at even ones.
    #[must_use]
    pub fn applied_to(self, mut found: Detections) -> Detections {
        found.rate_hz = self.rate_hz;
        if let Some(times_s) = self.uneven_times_s {
            found.frames = evened(&found.frames, &times_s, self.rate_hz.unwrap_or(1.0));
        }
        found.notes.extend(self.notes);
        found.doubts.extend(self.doubts);
        found
    }
}

/// A moment: a frame's number, or the bits of a time. Times are ordered by `total_cmp`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Moment {
    frame: Option<u64>,
    time: Option<f64>,
    line: u64,
}

/// A moment and everybody in it.
type Seen = (Moment, Vec<Points>);

/// A line and the rule that it broke.
type BrokenLine = (u64, String);

/// Puts the rows of each frame together.
///
/// # Errors
/// The line of a row whose frame or time does not rise, or is missing, with the rule.
pub fn grouped(rows: Vec<Row>, columns: &Columns) -> Result<Grouped, BrokenLine> {
    let has_frames = columns.frame.is_some();
    // A time that some rows lack is of no use where frames have numbers.
    let has_times = columns.time.is_some() && (!has_frames || rows.iter().all(|row| row.time.is_some()));
    let shares_frames = columns.person.is_some() || columns.point_name.is_some();
    let mut moments: Vec<Seen> = Vec::new();
    if shares_frames {
        moments = shared(rows, has_frames, columns)?;
    } else {
        for (index, row) in rows.into_iter().enumerate() {
            let frame = row.frame.or((!has_times).then_some(index as u64));
            moments.push((Moment { frame, time: row.time.filter(|_| has_times), line: row.line }, row.people));
        }
    }
    let moments_only: Vec<Moment> = moments.iter().map(|(moment, _)| *moment).collect();
    check_rising(&moments_only, columns)?;
    let mut times = FrameTimes::default();
    let numbers = numbered(&moments_only, columns, has_times, &mut times)?;
    let frame = |(frame, (_, people)): (u64, Seen)| PointFrame { frame, people };
    Ok(Grouped { frames: numbers.into_iter().zip(moments).map(frame).collect(), times })
}

/// Rows of which several belong to a frame.
fn shared(rows: Vec<Row>, has_frames: bool, columns: &Columns) -> Result<Vec<Seen>, BrokenLine> {
    let mut names: Vec<String> = Vec::new();
    let mut by_moment: BTreeMap<(u64, u64), (Moment, BTreeMap<usize, Points>)> = BTreeMap::new();
    for row in rows {
        let key = match (row.frame, row.time) {
            (Some(frame), _) if has_frames => (frame, 0),
            (_, Some(time)) => (0, ordered_bits(time)),
            _ => return Err((row.line, "has neither a frame nor a time, which rows of one frame need".into())),
        };
        let name = row.person.unwrap_or_default();
        let person = names.iter().position(|other| *other == name).unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        });
        let moment = Moment { frame: row.frame, time: row.time, line: row.line };
        let (_, people) = by_moment.entry(key).or_insert_with(|| (moment, BTreeMap::new()));
        for (index, points) in row.people.into_iter().enumerate() {
            let known = people.entry(person * columns.people() + index).or_default();
            if known.len() < points.len() {
                known.resize(points.len(), [f64::NAN; 3]);
            }
            let found = points.into_iter().enumerate().filter(|(_, point)| point[0].is_finite());
            found.for_each(|(index, point)| known[index] = point);
        }
    }
    Ok(by_moment.into_values().map(|(moment, people)| (moment, people.into_values().collect())).collect())
}

/// Bits that sort as their times do.
fn ordered_bits(time: f64) -> u64 {
    let bits = time.to_bits();
    if time.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

fn check_rising(moments: &[Moment], columns: &Columns) -> Result<(), BrokenLine> {
    for pair in moments.windows(2) {
        if let (Some(before), Some(frame)) = (pair[0].frame, pair[1].frame)
            && before >= frame
        {
            let remedy =
                if columns.person.is_none() { "; where rows are people, name their column `person`" } else { "" };
            let rule = format!("frame {frame} follows frame {before}; frame numbers have to rise{remedy}");
            return Err((pair[1].line, rule));
        }
    }
    Ok(())
}

/// The number of each moment's frame.
fn numbered(
    moments: &[Moment],
    columns: &Columns,
    has_times: bool,
    found: &mut FrameTimes,
) -> Result<Vec<u64>, BrokenLine> {
    let frames: Option<Vec<u64>> = moments.iter().map(|moment| moment.frame).collect();
    let (Some((column, unit)), true) = (columns.time, has_times) else {
        return Ok(frames.unwrap_or_else(|| (0..moments.len() as u64).collect()));
    };
    let name = &columns.names[column];
    let mut times: Vec<f64> = Vec::new();
    for moment in moments {
        let time =
            moment.time.ok_or_else(|| (moment.line, format!("`{name}` is empty, and no column has the frame")))?;
        if let Some(before) = times.last().filter(|before| **before >= time && frames.is_none()) {
            return Err((moment.line, format!("`{name}` {time} follows {before}; times have to rise")));
        }
        times.push(time);
    }
    let unit_s = unit.unwrap_or_else(|| {
        let (seconds, words) = clock::unit(&times);
        if seconds != 1.0 {
            found.notes.push(format!("the column `{name}` is taken for {words}"));
        }
        seconds
    });
    let times_s: Vec<f64> = times.iter().map(|time| time * unit_s).collect();
    if let Some(frames) = &frames
        && let Some(rate_hz) = rate_of_numbers(frames, &times_s)
    {
        found.rate_hz = Some(rate_hz);
        return Ok(frames.clone());
    }
    let Some(timing) = timing(&times_s) else {
        if frames.is_none() && times.len() > 1 {
            return Err((moments[0].line, format!("`{name}` has steps from which no rate follows; remove the column")));
        }
        if times.len() > 1 {
            found.doubts.push(format!("the column `{name}` has no times that rise: it is not used; give --input-rate"));
        }
        return Ok(frames.unwrap_or_else(|| vec![0; moments.len()]));
    };
    found.rate_hz = Some(timing.rate_hz);
    if !timing.is_even {
        found.notes.push(format!(
            "frames come at uneven times (`{name}`): points lie on straight lines between them, at {:.2} frames a second",
            timing.rate_hz
        ));
        found.uneven_times_s = Some(times_s);
    } else if frames.is_some() {
        found.notes.push(format!("frames are numbered by the column `{name}`, with which their own numbers disagree"));
    }
    Ok(timing.frames)
}
