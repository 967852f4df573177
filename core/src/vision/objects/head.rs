//! Where the head is: it gives the scale, the shoulders, and a region that is no hand.

use crate::math::sqrt;
use crate::skeleton::Side;

/// A face's box, pixels of the picture.
///
/// ```
/// use sinew_core::skeleton::Side;
/// use sinew_core::vision::objects::head::{HeadBox, shoulder};
///
/// let head = HeadBox { centre_px: [320.0, 100.0], width_px: 60.0 };
/// // The person's left is on the right of the picture.
/// assert_eq!(head.place_px(shoulder(Side::Left)), [380.0, 160.0]);
/// assert_eq!(head.relative([380.0, 160.0]), shoulder(Side::Left));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct HeadBox {
    /// Middle of the box.
    pub centre_px: [f32; 2],
    /// Width of the box.
    pub width_px: f32,
}

impl HeadBox {
    /// A place relative to the centre, in widths.
    #[must_use]
    pub fn relative(&self, place_px: [f32; 2]) -> [f32; 2] {
        core::array::from_fn(|axis| (place_px[axis] - self.centre_px[axis]) / self.width_px)
    }

    /// The place of the picture that is so many widths from the centre.
    #[must_use]
    pub fn place_px(&self, relative: [f32; 2]) -> [f32; 2] {
        core::array::from_fn(|axis| self.centre_px[axis] + relative[axis] * self.width_px)
    }
}

/// A shoulder of a person who faces the camera, widths from the face's centre: one to the side, one
/// down.
///
/// ```
/// use sinew_core::skeleton::Side;
/// use sinew_core::vision::objects::head::shoulder;
///
/// assert_eq!(shoulder(Side::Right), [-1.0, 1.0]);
/// ```
#[must_use]
pub fn shoulder(side: Side) -> [f32; 2] {
    [sign(side), 1.0]
}

/// Direction of a side along x: the person's left is on the picture's right.
#[must_use]
pub(super) const fn sign(side: Side) -> f32 {
    match side {
        Side::Left => 1.0,
        Side::Right => -1.0,
    }
}

/// Whether a place, relative to the face's centre in widths, belongs to head or neck.
#[must_use]
pub(super) fn is_head([x, y]: [f32; 2]) -> bool {
    let (across, down) = (x / 0.58, (y - 0.05) / 0.80);
    let is_in_neck = x < 0.45 && x > -0.45 && y > 0.0 && y < 1.0;
    across * across + down * down <= 1.0 || is_in_neck
}

/// Distance of two places.
#[must_use]
pub(super) fn distance([ax, ay]: [f32; 2], [bx, by]: [f32; 2]) -> f32 {
    sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))
}
