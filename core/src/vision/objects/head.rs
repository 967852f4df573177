//! Where the head is: it gives the scale, the shoulders, and a region that is no hand.

use crate::camera::{Camera, Pixel};
use crate::math::{Vec3, clamp, sqrt};
use crate::skeleton::Side;
use crate::vision::components::BoundingBox;

/// Columns and rows of a face's middle, shares of its box: forehead to chin, without hair and
/// background.
const MIDDLE: [[f32; 2]; 2] = [[0.20, 0.80], [0.25, 0.85]];

/// Width of a face's box, metres. Chosen: a box is a little wider than the mean breadth between the
/// cheekbones, 0.14 m; arms that hang are then 0.65 m long.
const WIDTH_M: f32 = 0.15;

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
    /// The pixels of its middle, where it is all skin, within a picture of `size_px`.
    #[must_use]
    pub fn middle(&self, size_px: [u16; 2]) -> BoundingBox {
        let [[min_u, max_u], [min_v, max_v]] = core::array::from_fn(|axis| {
            let last = f32::from(size_px[axis].saturating_sub(1));
            MIDDLE[axis].map(|share| clamp(self.centre_px[axis] + (share - 0.5) * self.width_px, 0.0, last) as u16)
        });
        BoundingBox { min_u, min_v, max_u, max_v }
    }

    /// A place relative to the centre, in widths.
    #[must_use]
    pub fn relative(&self, place_px: [f32; 2]) -> [f32; 2] {
        core::array::from_fn(|axis| (place_px[axis] - self.centre_px[axis]) / self.width_px)
    }

    /// The left and the right shoulder of a person who faces the camera, in the head's distance,
    /// metres in camera axes.
    #[must_use]
    pub fn shoulders_m(&self, camera: &Camera) -> [Vec3; 2] {
        [Side::Left, Side::Right].map(|side| {
            let [u_px, v_px] = self.place_px(shoulder(side));
            let direction = camera.back_project(Pixel::new(u_px, v_px)).direction;
            direction * (camera.focal_px() * WIDTH_M / self.width_px / direction.z)
        })
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
///
/// ```
/// use sinew_core::vision::objects::head::is_head;
///
/// assert!(is_head([0.0, 0.0]) && is_head([0.4, 0.9]));
/// assert!(!is_head([0.6, 0.9]));
/// ```
#[must_use]
pub fn is_head([x, y]: [f32; 2]) -> bool {
    let (across, down) = (x / 0.58, (y - 0.05) / 0.80);
    let is_in_neck = x < 0.45 && x > -0.45 && y > 0.0 && y < 1.0;
    across * across + down * down <= 1.0 || is_in_neck
}

/// Distance of two places.
#[must_use]
pub(super) fn distance([ax, ay]: [f32; 2], [bx, by]: [f32; 2]) -> f32 {
    sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))
}
