//! A tree of rigid bones with hinge and ball joints and box limits, PIK (2).

use crate::error::{ParameterError, Rule};
use crate::math::{Vec3, abs, clamp, length};

/// How a bone turns about its joint.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::Joint;
///
/// let knee = Joint::Hinge(Vec3::x());
/// let hip = Joint::Ball([Vec3::x(), Vec3::z(), Vec3::y()]);
/// let pelvis =
///     Joint::Free([Vec3::x(), Vec3::y(), Vec3::z(), Vec3::y(), Vec3::z(), Vec3::x()]);
/// assert_eq!([knee, hip, pelvis].map(|joint| joint.angle_count()), [1, 3, 6]);
/// assert_eq!(
///     [hip, pelvis].map(|joint| joint.shift_count()),
///     [0, 3],
///     "only the root goes anywhere"
/// );
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joint {
    /// Does not turn.
    Fixed,
    /// One angle about a unit axis, given in the bone's own rest axes.
    Hinge(Vec3),
    /// Three angles about unit axes, applied as R(axis 0) R(axis 1) R(axis 2). They are singular
    /// where the middle angle reaches +-pi/2, which the limits should exclude.
    Ball([Vec3; 3]),
    /// Goes anywhere, at the root only. Three shifts along the first three axes, metres, stand
    /// before the angles. The three angles are about the last three axes, as those of a ball.
    Free([Vec3; 6]),
}

/// Shifts of a free root: its first coordinates.
pub const SHIFTS: usize = 3;
/// Coordinates of a free root: shifts and angles.
pub const FREE_ROOT_COORDINATES: usize = 6;

impl Joint {
    /// Number of coordinates: angles, and the shifts of a free root.
    #[must_use]
    pub const fn angle_count(&self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Hinge(_) => 1,
            Self::Ball(_) => 3,
            Self::Free(_) => FREE_ROOT_COORDINATES,
        }
    }

    /// Axes of the coordinates, in their order.
    #[must_use]
    pub fn axes(&self) -> &[Vec3] {
        match self {
            Self::Fixed => &[],
            Self::Hinge(axis) => core::slice::from_ref(axis),
            Self::Ball(axes) => axes,
            Self::Free(axes) => axes,
        }
    }

    /// How many of the coordinates are shifts, which come first.
    #[must_use]
    pub const fn shift_count(&self) -> usize {
        match self {
            Self::Free(_) => SHIFTS,
            _ => 0,
        }
    }
}

/// A rigid bone from its joint to its end.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{Bone, Joint, Limit, Skeleton};
///
/// // A leg that stands still at the hip and bends at the knee; y points down.
/// let thigh = Bone { parent: None, joint: Joint::Fixed, offset_m: Vec3::new(0.0, 0.43, 0.0) };
/// let shank = Bone {
///     parent: Some(0),
///     joint: Joint::Hinge(Vec3::x()),
///     offset_m: Vec3::new(0.0, 0.42, 0.0),
/// };
/// let leg = Skeleton::new([thigh, shank], [Limit::from_degrees(0.0, 150.0)])?;
/// assert!(leg.angle_moves(0, 1) && !leg.angle_moves(0, 0));
/// // Parents come first.
/// let wrong = Skeleton::new([shank, thigh], [Limit::from_degrees(0.0, 150.0)]);
/// assert_eq!(wrong.map_err(|error| error.parameter), Err("bone.parent"));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bone {
    /// Index of the bone at whose end this one's joint sits; `None` at the root.
    pub parent: Option<u8>,
    /// How the bone turns.
    pub joint: Joint,
    /// From the joint to the end at rest (all angles zero), metres.
    pub offset_m: Vec3,
}

/// Closed interval of an angle.
///
/// ```
/// use sinew_core::skeleton::Limit;
///
/// let elbow = Limit::from_degrees(0.0, 150.0);
/// assert_eq!(elbow.clamp(-0.2), 0.0);
/// assert_eq!(elbow.clamp(1.2), 1.2, "inside nothing changes");
/// assert_eq!(elbow.clamp(3.0), elbow.high_rad);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Lowest angle, radians.
    pub low_rad: f32,
    /// Highest angle, radians.
    pub high_rad: f32,
}

impl Limit {
    /// An interval in degrees.
    #[must_use]
    pub const fn from_degrees(low_deg: f32, high_deg: f32) -> Self {
        /// Radians of a degree, by definition.
        const RADIANS: f32 = core::f32::consts::PI / 180.0;
        Self { low_rad: low_deg * RADIANS, high_rad: high_deg * RADIANS }
    }

    /// The angle of the interval that is nearest to `angle_rad`.
    #[inline]
    #[must_use]
    pub fn clamp(&self, angle_rad: f32) -> f32 {
        clamp(angle_rad, self.low_rad, self.high_rad)
    }
}

/// A tree of `BONES` bones with `ANGLES` angles.
///
/// Invariants: a parent stands before its children; the angles of the bones follow one another in
/// the bones' order.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{Bone, Joint, Limit, Skeleton};
///
/// // A head on a neck: one bone of three angles, one of none.
/// let neck = Bone {
///     parent: None,
///     joint: Joint::Ball([Vec3::x(), Vec3::z(), Vec3::y()]),
///     offset_m: -Vec3::y() * 0.1,
/// };
/// let head = Bone { parent: Some(0), joint: Joint::Fixed, offset_m: -Vec3::y() * 0.2 };
/// let skeleton = Skeleton::new([neck, head], [Limit::from_degrees(-60.0, 60.0); 3])?;
/// assert_eq!(skeleton.root_coordinates(), 0, "this root does not move");
/// assert!((0..3).all(|angle| skeleton.angle_moves(angle, 1)));
/// assert_eq!(skeleton.clamp([0.0, 2.0, 0.0]), [0.0, 60.0_f32.to_radians(), 0.0]);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Skeleton<const BONES: usize, const ANGLES: usize> {
    bones: [Bone; BONES],
    limits: [Limit; ANGLES],
    bone_of_angle: [u8; ANGLES],
    /// Bit b of entry e: bone b moves the end of bone e.
    moved_by: [u32; BONES],
    /// First coordinates that are shifts of a free root.
    shifts: usize,
}

impl<const BONES: usize, const ANGLES: usize> Skeleton<BONES, ANGLES> {
    /// Checks and stores a tree.
    ///
    /// # Errors
    /// At most 32 bones; parents before children; only the first bone free; axes of length one;
    /// limits finite and ordered; `ANGLES` angles in all.
    pub fn new(bones: [Bone; BONES], limits: [Limit; ANGLES]) -> Result<Self, ParameterError> {
        if BONES > 32 {
            return Err(ParameterError::new("bones", Rule::Capacity { capacity: 32 }));
        }
        let mut bone_of_angle = [0_u8; ANGLES];
        let mut moved_by = [0_u32; BONES];
        let mut angle = 0;
        for (index, bone) in bones.iter().enumerate() {
            let inherited = match bone.parent {
                None => 0,
                Some(parent) => {
                    let before = moved_by.get(..index).and_then(|before| before.get(usize::from(parent)));
                    let rule = Rule::Within { low: 0.0, high: index as f32 - 1.0 };
                    *before.ok_or(ParameterError::new("bone.parent", rule))?
                }
            };
            if let Some(mask) = moved_by.get_mut(index) {
                *mask = inherited | (1 << index);
            }
            if index > 0 && bone.joint.shift_count() > 0 {
                return Err(ParameterError::new(
                    "bone.joint: a free one is first; its index",
                    Rule::Within { low: 0.0, high: 0.0 },
                ));
            }
            for axis in bone.joint.axes() {
                if !(abs(length(axis) - 1.0) < 1.0e-4) {
                    return Err(ParameterError::new("bone.joint axis length", Rule::Within { low: 1.0, high: 1.0 }));
                }
                let slot = bone_of_angle.get_mut(angle);
                *slot.ok_or(ParameterError::new("bones' angles", Rule::Capacity { capacity: ANGLES }))? = index as u8;
                angle += 1;
            }
            if !length(&bone.offset_m).is_finite() {
                return Err(ParameterError::new("bone.offset_m", Rule::Finite));
            }
        }
        if angle != ANGLES {
            return Err(ParameterError::new("limits", Rule::SameLength { expected: angle }));
        }
        for limit in &limits {
            if !(limit.low_rad.is_finite() && limit.high_rad.is_finite()) {
                return Err(ParameterError::new("limits", Rule::Finite));
            }
            if limit.low_rad > limit.high_rad {
                return Err(ParameterError::new("limits", Rule::OrderedInterval));
            }
        }
        let shifts = bones.first().map_or(0, |root| root.joint.shift_count());
        Ok(Self { bones, limits, bone_of_angle, moved_by, shifts })
    }

    /// Whether coordinate `angle` is a shift of a free root, metres.
    #[inline]
    #[must_use]
    pub fn is_shift(&self, angle: usize) -> bool {
        angle < self.shifts
    }

    /// How many coordinates belong to a root that moves: they come first.
    #[must_use]
    pub fn root_coordinates(&self) -> usize {
        if self.shifts > 0 { FREE_ROOT_COORDINATES } else { 0 }
    }

    /// The bones, parents first.
    #[must_use]
    pub fn bones(&self) -> &[Bone; BONES] {
        &self.bones
    }

    /// The box of legal angles, PIK (2).
    #[must_use]
    pub fn limits(&self) -> &[Limit; ANGLES] {
        &self.limits
    }

    /// Index of the bone that angle `angle` turns.
    #[inline]
    #[must_use]
    pub fn bone_of_angle(&self, angle: usize) -> usize {
        self.bone_of_angle.get(angle).map_or(0, |&bone| usize::from(bone))
    }

    /// Whether `angle` moves the end of `bone`.
    #[inline]
    #[must_use]
    pub fn angle_moves(&self, angle: usize, bone: usize) -> bool {
        self.moved_by.get(bone).is_some_and(|mask| mask >> self.bone_of_angle(angle) & 1 == 1)
    }

    /// The legal pose nearest to `angles_rad`, angle by angle.
    #[must_use]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub fn clamp(&self, mut angles_rad: [f32; ANGLES]) -> [f32; ANGLES] {
        for (angle, limit) in angles_rad.iter_mut().zip(&self.limits) {
            *angle = limit.clamp(*angle);
        }
        angles_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bone(parent: Option<u8>, joint: Joint) -> Bone {
        Bone { parent, joint, offset_m: Vec3::x() }
    }

    #[test]
    fn a_child_before_its_parent_is_refused() {
        let bones = [bone(Some(1), Joint::Fixed), bone(None, Joint::Fixed)];
        assert_eq!(Skeleton::<2, 0>::new(bones, []).unwrap_err().parameter, "bone.parent");
    }

    #[test]
    fn limits_have_to_be_in_order_and_as_many_as_the_angles() {
        let hinge = [bone(None, Joint::Hinge(Vec3::z()))];
        let inverted = Limit { low_rad: 1.0, high_rad: 0.0 };
        assert_eq!(Skeleton::<1, 1>::new(hinge, [inverted]).unwrap_err().rule, Rule::OrderedInterval);
        assert_eq!(Skeleton::<1, 0>::new(hinge, []).unwrap_err().rule, Rule::Capacity { capacity: 0 });
        let two = [Limit::from_degrees(0.0, 1.0); 2];
        assert_eq!(Skeleton::<1, 2>::new(hinge, two).unwrap_err().rule, Rule::SameLength { expected: 1 });
        let long = [bone(None, Joint::Hinge(Vec3::z() * 2.0))];
        assert!(Skeleton::<1, 1>::new(long, [Limit::from_degrees(0.0, 1.0)]).is_err());
    }

    #[test]
    fn an_angle_moves_what_hangs_on_it_and_nothing_else() {
        let hinge = Joint::Hinge(Vec3::z());
        let bones = [bone(None, hinge), bone(Some(0), hinge), bone(Some(0), hinge)];
        let skeleton = Skeleton::<3, 3>::new(bones, [Limit::from_degrees(-90.0, 90.0); 3]).unwrap();
        assert!(skeleton.angle_moves(0, 2) && skeleton.angle_moves(2, 2));
        assert!(!skeleton.angle_moves(1, 2) && !skeleton.angle_moves(1, 0));
    }
}
