//! BVH files of any skeleton.
//!
//! Lengths are centimetres, as in most collections of motion (in Blender, import with scale 0.01).
//! Axes are those of the layout and the frames: y up is what programs expect. Every joint has the
//! channels `Zrotation Xrotation Yrotation`, the root before them `Xposition Yposition Zposition`.

use super::error::ExportError;
use super::euler::zxy_rad;
use super::layout::SkeletonLayout;
use sinew_core::math::{Mat3, Vec3};
use std::io::Write;

const CENTIMETRES: f32 = 100.0;
const ROTATIONS: &str = "Zrotation Xrotation Yrotation";

/// A pose.
#[derive(Debug, Clone, PartialEq)]
pub struct BvhFrame {
    /// Place of the root in the world, metres. It takes the place of the root's offset.
    pub root_position_m: Vec3,
    /// Rotation of each joint relative to its parent, in the layout's order; the identity is the
    /// rest. Together with those of its ancestors it turns the joint's children about the joint.
    pub local_rotations: Vec<Mat3>,
}

/// Writes frames of `layout`, `rate_hz` of them a second. Joints without children get an `End
/// Site`.
///
/// # Errors
/// There is no frame, or the rate is not above zero. A frame has another number of joints, or
/// numbers that are not finite. `out` refuses.
pub fn write_bvh(
    layout: &SkeletonLayout,
    frames: &[BvhFrame],
    rate_hz: f64,
    out: &mut (impl Write + ?Sized),
) -> Result<(), ExportError> {
    check(layout, frames, rate_hz)?;
    let order = layout.depth_first();
    writeln!(out, "HIERARCHY")?;
    for (position, &(joint, depth)) in order.iter().enumerate() {
        let next_depth = order.get(position + 1).map_or(0, |next| next.1);
        write_joint(layout, joint, depth, next_depth, out)?;
    }
    writeln!(out, "MOTION\nFrames: {}\nFrame Time: {:.9}", frames.len(), 1.0 / rate_hz)?;
    for frame in frames {
        let [x, y, z] = (frame.root_position_m * CENTIMETRES).into();
        write!(out, "{x:.5} {y:.5} {z:.5}")?;
        for &(joint, _) in &order {
            let [z, x, y] = zxy_rad(&frame.local_rotations[joint]).map(f32::to_degrees);
            write!(out, " {z:.6} {x:.6} {y:.6}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn check(layout: &SkeletonLayout, frames: &[BvhFrame], rate_hz: f64) -> Result<(), ExportError> {
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        let rule = format!("must be greater than zero, not {rate_hz}");
        return Err(ExportError::Parameter { parameter: "rate_hz", rule });
    }
    if frames.is_empty() {
        let rule = "must hold a frame at least; a BVH file has one or more".to_owned();
        return Err(ExportError::Parameter { parameter: "frames", rule });
    }
    let joints = layout.joints().len();
    for (index, frame) in frames.iter().enumerate() {
        let numbers = frame.root_position_m.iter().chain(frame.local_rotations.iter().flat_map(Mat3::iter));
        let rule = if frame.local_rotations.len() != joints {
            format!("needs a rotation for each of {joints} joints, and has {}", frame.local_rotations.len())
        } else if !numbers.into_iter().all(|number| number.is_finite()) {
            "holds a number that is not finite; leave the frame out, or repeat the one before".to_owned()
        } else {
            continue;
        };
        return Err(ExportError::Frame { frame: index, rule });
    }
    Ok(())
}

/// Writes a joint without its children, and the closing braces that come before a joint of
/// `next_depth`.
fn write_joint(
    layout: &SkeletonLayout,
    index: usize,
    depth: usize,
    next_depth: usize,
    out: &mut (impl Write + ?Sized),
) -> Result<(), ExportError> {
    let joint = &layout.joints()[index];
    let tabs = "\t".repeat(depth);
    let (word, channels) = if depth == 0 { ("ROOT", "6 Xposition Yposition Zposition") } else { ("JOINT", "3") };
    writeln!(out, "{tabs}{word} {}\n{tabs}{{", joint.name)?;
    writeln!(out, "{tabs}\tOFFSET {}\n{tabs}\tCHANNELS {channels} {ROTATIONS}", in_centimetres(joint.offset_m))?;
    if next_depth <= depth {
        let end_m = joint.end_m.unwrap_or_default();
        writeln!(out, "{tabs}\tEnd Site\n{tabs}\t{{\n{tabs}\t\tOFFSET {}\n{tabs}\t}}", in_centimetres(end_m))?;
    }
    for closed in (next_depth..=depth).rev() {
        writeln!(out, "{}}}", "\t".repeat(closed))?;
    }
    Ok(())
}

fn in_centimetres(place_m: Vec3) -> String {
    let [x, y, z] = (place_m * CENTIMETRES).into();
    format!("{x:.5} {y:.5} {z:.5}")
}

#[cfg(test)]
mod tests {
    use super::super::layout::LayoutJoint;
    use super::*;
    use crate::motion::bvh::parse;
    use core::f32::consts::{FRAC_PI_2, PI};
    use proptest::prelude::*;
    use sinew_core::math::axis_rotation;
    use std::path::Path;

    /// Two branches, listed across each other; bones of 0.3 m and one of length zero.
    fn layout() -> SkeletonLayout {
        let joint = |name: &str, parent, offset: [f32; 3], end: Option<[f32; 3]>| LayoutJoint {
            name: name.to_owned(),
            parent,
            offset_m: offset.into(),
            end_m: end.map(Vec3::from),
        };
        SkeletonLayout::new(vec![
            joint("Pelvis", None, [0.0, 0.9, 0.0], None),
            joint("Chest", Some(0), [0.0, 0.3, 0.0], None),
            joint("Thigh", Some(0), [0.1, -0.05, 0.0], None),
            joint("Arm", Some(1), [0.2, 0.1, 0.0], None),
            joint("Shank", Some(2), [0.0, -0.4, 0.0], Some([0.0, -0.4, 0.1])),
            joint("Head", Some(1), [0.0, 0.3, 0.0], Some([0.0, 0.2, 0.0])),
            joint("Wrist", Some(3), [0.3, 0.0, 0.0], None),
            joint("Hand", Some(6), [0.0, 0.0, 0.0], Some([0.1, 0.0, 0.0])),
        ])
        .unwrap()
    }

    /// Places of the joints, then (joint, place) of the ends.
    fn places(layout: &SkeletonLayout, frame: &BvhFrame) -> (Vec<Vec3>, Vec<Option<Vec3>>) {
        let mut global: Vec<(Vec3, Mat3)> = Vec::new();
        for (joint, local) in layout.joints().iter().zip(&frame.local_rotations) {
            let place = joint.parent.map_or((frame.root_position_m, *local), |parent| {
                let (origin, rotation) = global[parent];
                (origin + rotation * joint.offset_m, rotation * local)
            });
            global.push(place);
        }
        let ends = layout.joints().iter().zip(&global).map(|(joint, (at, turn))| Some(at + turn * joint.end_m?));
        (global.iter().map(|place| place.0).collect(), ends.collect())
    }

    fn rotation() -> impl Strategy<Value = Mat3> {
        let gimbal = prop_oneof![-PI..PI, FRAC_PI_2 - 0.001..FRAC_PI_2 + 0.001, Just(FRAC_PI_2), Just(-FRAC_PI_2)];
        (-PI..PI, gimbal, -PI..PI).prop_map(|(z, x, y)| {
            axis_rotation(&Vec3::z(), z) * axis_rotation(&Vec3::x(), x) * axis_rotation(&Vec3::y(), y)
        })
    }

    fn frame() -> impl Strategy<Value = BvhFrame> {
        let root = (-3.0_f32..3.0, -3.0_f32..3.0, -3.0_f32..3.0).prop_map(|(x, y, z)| Vec3::new(x, y, z));
        (root, prop::collection::vec(rotation(), 8))
            .prop_map(|(root_position_m, local_rotations)| BvhFrame { root_position_m, local_rotations })
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_back(frames in prop::collection::vec(frame(), 1..4)) {
            let layout = layout();
            let mut bytes = Vec::new();
            write_bvh(&layout, &frames, 15.0, &mut bytes).unwrap();
            let motion = parse(&String::from_utf8(bytes).unwrap(), Path::new("m.bvh"), Some(0.01)).unwrap();
            prop_assert_eq!(motion.len(), frames.len());
            prop_assert!((motion.frames_per_second - 15.0).abs() < 1.0e-4);
            for (index, frame) in frames.iter().enumerate() {
                let (joints, ends) = places(&layout, frame);
                for (number, joint) in layout.joints().iter().enumerate() {
                    let found = |name: &str| motion.frame(index)[motion.joint(name).unwrap()];
                    prop_assert!((found(&joint.name) - joints[number]).norm() < 1.0e-4);
                    if let Some(end) = ends[number] {
                        let name = joint.name.clone() + "_end";
                        prop_assert!((found(&name) - end).norm() < 1.0e-4);
                    }
                }
            }
        }
    }

    #[test]
    fn the_file_is_in_centimetres_with_one_end_for_each_leaf() {
        let frame = BvhFrame { root_position_m: Vec3::new(1.0, 2.0, -0.5), local_rotations: vec![Mat3::identity(); 8] };
        let mut bytes = Vec::new();
        write_bvh(&layout(), &[frame], 30.0, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.starts_with("HIERARCHY\nROOT Pelvis\n{\n\tOFFSET 0.00000 90.00000 0.00000\n\tCHANNELS 6 Xposition")
        );
        assert!(
            text.contains(
                "\tJOINT Chest\n\t{\n\t\tOFFSET 0.00000 30.00000 0.00000\n\t\tCHANNELS 3 Zrotation Xrotation"
            )
        );
        assert!(text.contains("MOTION\nFrames: 1\nFrame Time: 0.033333333\n100.00000 200.00000 -50.00000 0.000000"));
        assert_eq!((text.matches("End Site").count(), text.matches("JOINT").count()), (3, 7));
    }

    #[test]
    fn frames_that_do_not_fit_are_refused() {
        let good = BvhFrame { root_position_m: Vec3::zeros(), local_rotations: vec![Mat3::identity(); 8] };
        let short = BvhFrame { local_rotations: vec![Mat3::identity(); 7], ..good.clone() };
        let lost = BvhFrame { root_position_m: Vec3::new(f32::NAN, 0.0, 0.0), ..good.clone() };
        for (frames, rate_hz, wanted) in [
            (vec![], 30.0, "`frames` must hold a frame"),
            (vec![good.clone(), short], 30.0, "frame 1 of the motion needs a rotation for each of 8 joints, and has 7"),
            (vec![lost], 30.0, "frame 0 of the motion holds a number that is not finite"),
            (vec![good], 0.0, "`rate_hz` must be greater than zero, not 0"),
        ] {
            let found = write_bvh(&layout(), &frames, rate_hz, &mut Vec::new()).unwrap_err().to_string();
            assert!(found.contains(wanted), "{found} does not contain {wanted}");
        }
    }
}
