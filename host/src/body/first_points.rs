//! Whether the first clouds can be those of a person, in metres and in the camera's axes.

use crate::cloud::{MAX_DISTANCE_M, PointCloud};
use crate::error::{Result, ensure};
use sinew_core::math::Vec3;

/// Clouds with points that are looked at.
///
/// Chosen: one may be odd, and five are read in no time.
const CLOUDS: usize = 5;
/// What to do about points in other units.
pub const UNIT_REMEDY: &str = "multiply them by the metres of their unit (0.001 for millimetres, 0.01 for centimetres)";
/// Share of the points that may be nearer or farther than the bounds, as false matches are.
///
/// Chosen: a person at 8 m fills 1.4 % of a picture of 640 x 480 pixels.
const STRAY_SHARE: f64 = 0.01;
/// Some points are nearer than this to the camera, metres.
///
/// Chosen: what a camera sees is 0.3 m away or more, which is 30 in centimetres, and from 30 m on
/// no camera resolves limbs. Backgrounds may be farther away.
const MAX_NEAREST_M: f32 = 30.0;
/// Some points are farther than this from the camera, metres.
///
/// Chosen: no depth camera measures below. A person at 10 m is there in units of 100 m.
const MIN_FARTHEST_M: f32 = 0.1;

/// Share of the points that is left out at each end of an axis where extents are compared.
///
/// Chosen: outliers and a hand held out are no more.
const END_SHARE: f64 = 0.1;

/// Points of the first clouds that have some.
#[derive(Debug, Default)]
pub struct FirstPoints {
    points_m: Vec<Vec3>,
    /// Points beyond [`MAX_DISTANCE_M`].
    beyond: usize,
    /// Clouds with points, and clouds all of whose points are beyond.
    clouds: usize,
    clouds_beyond: usize,
}

impl FirstPoints {
    /// Adds those of the next cloud.
    pub fn add(&mut self, cloud: PointCloud) {
        self.clouds += usize::from(!cloud.points_m.is_empty());
        self.clouds_beyond += usize::from(cloud.points_m.is_empty() && cloud.far > 0);
        self.beyond += cloud.far;
        self.points_m.extend(cloud.points_m);
    }

    /// Whether there are as many clouds as are looked at.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.clouds == CLOUDS
    }

    /// Whether there are enough to check, where clouds come one by one. A first cloud all of whose
    /// points are beyond may be of a dark picture.
    #[must_use]
    pub const fn can_be_checked(&self) -> bool {
        self.clouds > 0 || self.clouds_beyond >= CLOUDS
    }

    /// Refuses points in other units or axes. `of` says whose they are, such as " of `folder`", and
    /// `remedy` what to do about units.
    ///
    /// # Errors
    /// Names the rule and the remedy.
    pub fn check(&self, of: &str, remedy: &str) -> Result<()> {
        let count = self.points_m.len();
        ensure!(
            count > 0 || self.beyond == 0,
            "the points{of} are farther than {MAX_DISTANCE_M} m, {} of them, and none is nearer; they have to \
             be in metres from the camera: {remedy}",
            self.beyond
        );
        if count == 0 {
            return Ok(());
        }
        let behind = self.points_m.iter().filter(|point_m| point_m.z <= 0.0).count();
        ensure!(
            2 * behind <= count,
            "{} % of the first points{of} are behind the camera (z is not above zero); axes have to be x to \
             the right, y down, z forward: from x right, y up, z backward, change the signs of y and z",
            100 * behind / count
        );
        let (nearest_m, farthest_m) = self.range_m();
        ensure!(
            nearest_m <= MAX_NEAREST_M,
            "the first points{of} begin {nearest_m:.0} m from the camera, and {MAX_NEAREST_M} m is the most; \
             they have to be in metres from the camera: {remedy}"
        );
        ensure!(
            farthest_m >= MIN_FARTHEST_M,
            "the first points{of} end {farthest_m:.3} m from the camera, and {MIN_FARTHEST_M} m is the least; \
             they have to be in metres from the camera: {remedy}"
        );
        Ok(())
    }

    /// A warning where the points reach farther along the line of sight than from top to bottom.
    #[must_use]
    pub fn lies_along_sight(&self, of: &str) -> Option<String> {
        let [height_m, depth_m] = [1, 2].map(|axis| {
            let (low_m, high_m) = between(self.points_m.iter().map(|point_m| point_m[axis]), END_SHARE)?;
            Some(high_m - low_m)
        });
        let (height_m, depth_m) = (height_m?, depth_m?);
        (depth_m > height_m).then(|| {
            format!(
                "most of the first points{of} lie within {height_m:.1} m from top to bottom and {depth_m:.1} m \
                 along the line of sight, and someone upright is looked for; axes have to be x to the right, y down, z \
                 forward (from x right, y forward, z up, take x, -z, y); cut off what is behind (--inside), or give the \
                 first pose (--init)"
            )
        })
    }

    /// Distances between which all points but strays are, metres.
    fn range_m(&self) -> (f32, f32) {
        between(self.points_m.iter().map(Vec3::norm), STRAY_SHARE).unwrap_or_default()
    }
}

/// The numbers between which all are but a share at each end; `None` without any.
fn between(numbers: impl Iterator<Item = f32>, end_share: f64) -> Option<(f32, f32)> {
    let mut numbers: Vec<f32> = numbers.collect();
    let last = numbers.len().checked_sub(1)?;
    let left_out = (end_share * last as f64) as usize;
    let mut at = |index: usize| *numbers.select_nth_unstable_by(index, f32::total_cmp).1;
    Some((at(left_out), at(last - left_out)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of a person `distance_m` away, each point as `change` makes it.
    fn said(distance_m: f32, change: impl Fn(Vec3) -> Vec3) -> Option<String> {
        let grid = (0..400).map(|index| [(index % 20) as f32 / 19.0, (index / 20) as f32 / 19.0]);
        let person = grid.map(|[x, y]| Vec3::new(0.5 * x - 0.25, 1.7 * y - 0.8, distance_m));
        let first = FirstPoints { points_m: person.map(change).collect(), ..FirstPoints::default() };
        first.check(" of `points`", "multiply").err().map(|error| error.to_string())
    }

    #[test]
    fn a_person_in_metres_is_taken_near_and_far() {
        for distance_m in [0.4, 3.0, 8.0, 25.0] {
            assert_eq!(said(distance_m, |point| point), None);
        }
        assert_eq!(said(3.0, |point| if point.x > -0.2 { point * 100.0 } else { point }), None, "a far background");
    }

    #[test]
    fn someone_who_lies_along_the_line_of_sight_is_warned_of() {
        let warning = |change: fn(Vec3) -> Vec3| {
            let grid = (0..400).map(|index| [(index % 20) as f32 / 19.0, (index / 20) as f32 / 19.0]);
            let person = grid.map(|[x, y]| Vec3::new(0.5 * x - 0.25, 1.7 * y - 0.8, 3.0 + 0.3 * x));
            FirstPoints { points_m: person.map(change).collect(), ..FirstPoints::default() }
                .lies_along_sight(" of `points`")
        };
        assert_eq!(warning(|point| point), None);
        assert_eq!(warning(|point| Vec3::new(point.x, 0.4 * point.y, point.z)), None, "a trunk without legs");
        let z_up = warning(|point| Vec3::new(point.x, point.z - 2.0, 3.0 - point.y)).unwrap();
        assert!(z_up.contains("within 0.3 m from top to bottom and 1.5 m") && z_up.contains("--init"), "{z_up}");
        assert_eq!(FirstPoints::default().lies_along_sight(""), None);
    }

    #[test]
    fn other_units_and_axes_are_refused_with_the_remedy() {
        let names = |message: Option<String>, part: &str| {
            let message = message.unwrap_or_default();
            assert!(message.contains(part), "{message}");
        };
        names(said(3.0, |point| 100.0 * point), "begin 300 m from the camera, and 30 m is the most");
        names(said(0.6, |point| 100.0 * point), "multiply");
        names(said(3.0, |point| 0.01 * point), "end 0.031 m from the camera, and 0.1 m is the least");
        names(said(3.0, |point| Vec3::new(point.x, -point.y, -point.z)), "100 % of the first points of `points`");
        let beyond = FirstPoints { beyond: 7, ..FirstPoints::default() };
        names(beyond.check("", "multiply").err().map(|error| error.to_string()), "farther than 1000 m, 7 of them");
        FirstPoints::default().check("", "multiply").unwrap();
    }

    #[test]
    fn clouds_that_come_one_by_one_are_checked_from_the_first_one_with_points() {
        let cloud = |z_m: f32| PointCloud::from_points([Vec3::new(0.0, 0.0, z_m)]);
        let mut first = FirstPoints::default();
        first.add(PointCloud::default());
        first.add(cloud(1.0e4));
        assert!(!first.can_be_checked() && !first.is_complete());
        (0..CLOUDS).for_each(|_| first.add(cloud(3.0)));
        assert!(first.can_be_checked() && first.is_complete());
        let mut beyond = FirstPoints::default();
        (0..CLOUDS).for_each(|_| beyond.add(cloud(1.0e4)));
        assert!(beyond.can_be_checked() && !beyond.is_complete());
        beyond.check("", "multiply").unwrap_err();
    }
}
