//! Figures 2, 19 and 20 of the PIK paper as pictures.

use super::chain_spread::JointSpread;
use super::drawn::Drawn;
use super::lift::ANGLE_BLOCKS;
use anyhow::Result;
use image::RgbImage;
use sinew::draw::plot::matrix_plot;
use sinew::draw::pose_fan::{Look, PoseFan, pose_fans};
use sinew_core::skeleton::full_body::BODY_ANGLE_NAMES;

/// Joints named in a line below a picture.
const JOINTS_A_LINE: usize = 4;

/// "neck 2.1, head 3.4 cm" in lines.
fn lines(spreads: impl Iterator<Item = (&'static str, f64)>) -> Vec<String> {
    let all: Vec<String> = spreads.map(|(joint, spread_m)| format!("{joint} {:.1}", 100.0 * spread_m)).collect();
    all.chunks(JOINTS_A_LINE).map(|some| format!("{} cm", some.join(", "))).collect()
}

/// A hundred poses of each model beside each other.
pub fn figure_2(drawn: &Drawn) -> RgbImage {
    let spread = &drawn.report.chain_spread;
    let notes = |of: fn(&JointSpread) -> f64| lines(spread.joints.iter().map(|joint| (joint.joint, of(joint))));
    let titles = [
        format!("Figure 2: noise of each angle, kappa {}", spread.kappa),
        format!("goals known to {:.0} mm, lambda {}", 1000.0 * spread.reach_std_m, spread.kappa),
    ];
    let notes = [notes(|joint| joint.angular_m), notes(|joint| joint.end_effector_m)];
    let panel = |index: usize| PoseFan {
        title: &titles[index],
        notes: &notes[index],
        poses: &drawn.chains[index],
        look: Look::Front,
    };
    pose_fans(&[panel(0), panel(1)])
}

/// Ten samples of the pelvic lift, from the camera and from the side.
pub fn figure_19(drawn: &Drawn) -> RgbImage {
    let (lift, poses) = (&drawn.report.pelvic_lift, &drawn.lift);
    let notes = lines(lift.joints.iter().map(|joint| (joint.joint, joint.spread_m)));
    let title = format!("Figure 19: {} samples of a pelvic lift", lift.samples);
    pose_fans(&[
        PoseFan { title: &title, notes: &notes, poses, look: Look::Front },
        PoseFan { title: "from the side, camera to the left", notes: &[], poses, look: Look::Side },
    ])
}

/// The precision that the first sample was drawn with.
///
/// # Errors
/// No sample.
pub fn figure_20(drawn: &Drawn) -> Result<RgbImage> {
    let names = &BODY_ANGLE_NAMES[ANGLE_BLOCKS[0].1.start..];
    let blocks = ANGLE_BLOCKS.map(|(_, rows)| rows.len());
    let title = "Figure 20: precision of the importance distribution, diagonal scaled to 1";
    Ok(matrix_plot(title, names, &drawn.precision, &blocks)?)
}
