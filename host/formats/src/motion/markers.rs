//! Named points in space over time, some of them missing: marker files (TRC, C3D), and motions seen
//! as such.

use super::recording::Motion;
use super::shortfall::Shortfall;
use sinew_core::math::{Vec3, abs, ln};

/// Positions of named points over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MarkerMotion {
    /// Frames in a second.
    pub frames_per_second: f32,
    /// Frames in a second that the file gives, where [`Self::frames_per_second`] replaces them.
    pub replaced_rate_hz: Option<f32>,
    /// Names, in the file's order.
    pub names: Vec<String>,
    /// Place of each point's parent among them, `None` of a root; empty where the file has no
    /// skeleton.
    pub parents: Vec<Option<usize>>,
    /// Positions in metres, one row of `names.len()` a frame; `None` where the point was not seen.
    pub positions_m: Vec<Vec<Option<Vec3>>>,
    /// How many frames its header promises, where these are more than there are.
    pub shortfall: Option<Shortfall>,
    /// Whether lengths are assumed, since the file gives no unit of length.
    pub is_scale_assumed: bool,
    /// What a user should know of the file, one sentence each.
    pub notes: Vec<String>,
}

impl From<&Motion> for MarkerMotion {
    fn from(motion: &Motion) -> Self {
        Self {
            frames_per_second: motion.frames_per_second,
            names: motion.joints.clone(),
            parents: motion.parents.clone(),
            positions_m: (0..motion.len())
                .map(|frame| motion.frame(frame).iter().copied().map(Some).collect())
                .collect(),
            shortfall: motion.shortfall,
            ..Self::default()
        }
    }
}

/// Size of a person whose scale is not known, metres: the largest extent of their points. Chosen:
/// people are 1 to 2.3 m tall, and markers leave out the crown.
const PERSON_M: f32 = 1.6;
/// Extents that a person's points may have, metres. They reach from a child without head and feet
/// to arms that are spread, or a few objects beside them.
const PERSON_RANGE_M: [f32; 2] = [0.5, 5.0];

impl MarkerMotion {
    /// Multiplies all places.
    pub(super) fn scale(&mut self, factor: f32) {
        self.positions_m.iter_mut().flatten().flatten().for_each(|place| *place *= factor);
    }

    /// Takes the unit of length in which the points have the size of a person; `reason` begins the
    /// note.
    ///
    /// # Errors
    /// In none of m, cm and mm they have.
    pub(super) fn scale_to_a_person(&mut self, reason: &str) -> Result<(), String> {
        let extent = self.median_extent().ok_or_else(|| format!("{reason}, and no frame shows two points"))?;
        let misfit = |metres_per_unit: f32| abs(ln(extent * metres_per_unit / PERSON_M));
        let units = [("m", 1.0), ("cm", 0.01), ("mm", 0.001)];
        let (unit, metres_per_unit) =
            units.into_iter().fold(units[0], |best, one| if misfit(one.1) < misfit(best.1) { one } else { best });
        let extent_m = extent * metres_per_unit;
        if !(PERSON_RANGE_M[0]..=PERSON_RANGE_M[1]).contains(&extent_m) {
            return Err(format!("{reason}, and the points have the size of no person: {extent} units"));
        }
        self.scale(metres_per_unit);
        self.notes.push(format!("{reason}: {unit} is assumed, in which the points extend over {extent_m:.2} m"));
        Ok(())
    }

    /// Scales the points to the size of a person, for a unit that is no length; `reason` begins
    /// the note.
    pub(super) fn assume_a_person(&mut self, reason: &str) {
        self.is_scale_assumed = true;
        if let Some(extent) = self.median_extent() {
            self.scale(PERSON_M / extent);
        }
        self.notes.push(format!(
            "{reason}: lengths are scaled to a person whose points extend over {PERSON_M} m; angles do not depend on it"
        ));
    }

    /// Median over frames of the longest side of the box around all points, in the file's unit;
    /// `None` where there is none above zero.
    fn median_extent(&self) -> Option<f32> {
        let extent = |points: &Vec<Option<Vec3>>| {
            let seen = || points.iter().flatten();
            let first = *seen().next()?;
            let (low, high) = seen().fold((first, first), |(low, high), point| (low.inf(point), high.sup(point)));
            Some((high - low).max())
        };
        let mut extents: Vec<f32> = self.positions_m.iter().filter_map(extent).collect();
        extents.sort_by(f32::total_cmp);
        extents.get(extents.len() / 2).copied().filter(|extent| *extent > 0.0)
    }
}

/// Metres per length unit of this name; `None` for a unit that is not known.
#[must_use]
pub fn metres_per_unit(unit: &str) -> Option<f32> {
    match unit.trim().to_ascii_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => Some(0.01),
        "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => Some(0.001),
        "in" | "inch" | "inches" => Some(0.0254),
        _ => None,
    }
}

/// Middle of some points; `None` where one of them is missing.
pub fn middle(points: impl ExactSizeIterator<Item = Option<Vec3>>) -> Option<Vec3> {
    let count = points.len() as f32;
    let mut sum = Vec3::zeros();
    for point in points {
        sum += point?;
    }
    Some(sum / count)
}
