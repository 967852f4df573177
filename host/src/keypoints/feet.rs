//! Heels and toes among keypoints.

use super::layout::{Keypoint, Part, Side};
use crate::cyclic::feet::Feet;

/// Heel and toe of each foot, pixels; `None` where one was not found.
#[must_use]
pub fn feet(person: &[Keypoint]) -> Feet {
    let place = |part: Part| Some(person.iter().find(|keypoint| keypoint.part == part)?.position_px);
    [Side::Left, Side::Right].map(|side| [place(Part::Heel(side)), place(Part::Toe(side))])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_point_has_its_place() {
        let point = |part: Part, u: f64| Keypoint { part, position_px: [u, 0.0], confidence: 1.0 };
        let person = [point(Part::Toe(Side::Right), 3.0), point(Part::Heel(Side::Left), 1.0), point(Part::Nose, 9.0)];
        assert_eq!(feet(&person), [[Some([1.0, 0.0]), None], [None, Some([3.0, 0.0])]]);
    }
}
