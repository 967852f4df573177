//! Figures 2, 7, 19 and 20: what is predicted before a point is seen.

use super::common::{cm, with_head};
use crate::body::MotionChoice;
use crate::body::prediction::lift::{ANGLE_BLOCKS, SampleSpread};
use crate::body::prediction::{self, PredictionReport};
use crate::reproduce::body_panels::{BodyPanel, body_panels};
use crate::reproduce::matrix::matrix;
use crate::reproduce::page::{Row, Section};
use crate::reproduce::pik_geometry::figure_7;
use crate::reproduce::{Made, of_trend};
use anyhow::Result;
use sinew::body::tracking::BodyTuning;
use sinew::draw::body_views::DrawnBone;
use sinew::draw::pose_fan::Look;
use sinew_core::skeleton::full_body::BODY_ANGLE_NAMES;

/// Adds figures 2, 7, 19 and 20.
///
/// # Errors
/// Numbers of a model that break a rule.
pub fn predictions(tuning: &BodyTuning, made: &mut Made) -> Result<()> {
    let drawn = prediction::draw(&MotionChoice::StickWave.seen(None, 1)?, tuning)?;
    let PredictionReport { chain_spread, pelvic_lift } = &drawn.report;
    let panel = |title: String, look, poses| -> BodyPanel<'_> {
        BodyPanel { title, look, truth: &[] as &[DrawnBone], poses, points_m: &[] }
    };
    let row = Row {
        what: "trend".into(),
        paper: "the spread of limbs grows along the chains under noise of angles".into(),
        ours: format!("kappa {}; goals known to {} cm", chain_spread.kappa, cm(f64::from(chain_spread.reach_std_m))),
        // Two joints of a chain follow each other.
        difference: of_trend(chain_spread.joints.chunks(2).all(|two| two[0].angular_m <= two[two.len() - 1].angular_m)),
    };
    let joints = chain_spread.joints.iter();
    let rows = joints.map(|joint| vec![joint.joint.to_owned(), cm(joint.angular_m), cm(joint.end_effector_m)]);
    let table = with_head(["joint", "noise of angles, cm", "goals, cm"], rows);
    let title = "Figure 2: where noise of the angles goes, and where goals leave it";
    made.page.sections.push(built_in(title, row, table, "figure_2.svg"));
    let titles = [
        format!("noise of each angle, kappa {}", chain_spread.kappa),
        format!("goals known to {} cm, lambda {}", cm(f64::from(chain_spread.reach_std_m)), chain_spread.kappa),
    ];
    let [angles, goals] = &drawn.chains;
    let [first, second] = titles;
    let panels = [panel(first, Look::Front, angles), panel(second, Look::Front, goals)];
    made.drawings.push(("figure_2.svg".into(), body_panels(&panels)));
    geometry(made);
    let row = Row {
        what: "trend".into(),
        paper: "pelvis and spine spread up and down, knees in all directions, the rest little".into(),
        ours: format!("pelvis up and down {} cm; the others in the table", cm(pelvic_lift.pelvis_up_std_m)),
        difference: of_trend(moves_without_goals(&pelvic_lift.joints)),
    };
    let rows = pelvic_lift.joints.iter().map(|joint| vec![joint.joint.to_owned(), cm(joint.spread_m)]);
    let table = with_head(["joint", "spread of ten samples, cm"], rows);
    made.page.sections.push(built_in("Figure 19: ten samples of the pelvic lift", row, table, "figure_19.svg"));
    let panels = [
        panel("as the camera looks".into(), Look::Front, &drawn.lift),
        panel("from the side, camera to the left".into(), Look::Side, &drawn.lift),
    ];
    made.drawings.push(("figure_19.svg".into(), body_panels(&panels)));
    let precision = pelvic_lift.precision;
    let row = Row {
        what: "trend".into(),
        paper: "blocks of joints that share a goal".into(),
        ours: format!("mean entry inside a block {:.3}, between blocks {:.4}", precision.inside, precision.between),
        difference: of_trend(precision.inside > precision.between),
    };
    let title = "Figure 20: precision of the importance distribution, diagonal scaled to 1";
    made.page.sections.push(built_in(title, row, Vec::new(), "figure_20.svg"));
    let names = &BODY_ANGLE_NAMES[ANGLE_BLOCKS[0].1.start..];
    let blocks = ANGLE_BLOCKS.map(|(_, rows)| rows.len());
    made.drawings.push(("figure_20.svg".into(), matrix(names, &drawn.precision, &blocks)));
    Ok(())
}

/// Figure 7.
fn geometry(made: &mut Made) {
    made.drawings.push(("figure_7.svg".into(), figure_7()));
    made.page.sections.push(Section {
        title: "Figure 7: the visible surface of a bone, and the nearest visible skin of two points".into(),
        material:
            "Drawn by the functions of the likelihood. (a) A bone from a to b, seen from c: filled dots are skin \
                   that c sees. (b) The same bone across: x before it has its nearest skin, x behind it the nearest \
                   skin that c sees."
                .into(),
        pictures: vec!["figure_7.svg".into()],
        ..Section::default()
    });
}

/// Whether pelvis and knees spread more than what is held: head, wrists and ankles.
fn moves_without_goals(joints: &[SampleSpread]) -> bool {
    let of = |names: &[&str]| -> Vec<f64> {
        joints.iter().filter(|joint| names.contains(&joint.joint)).map(|joint| joint.spread_m).collect()
    };
    let held = of(&["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"]).into_iter().fold(0.0, f64::max);
    of(&["pelvis", "l_knee", "r_knee"]).into_iter().all(|spread_m| spread_m > held)
}

/// A figure of the person of the built-in motions.
fn built_in(title: &str, row: Row, table: Vec<Vec<String>>, picture: &str) -> Section {
    Section {
        title: title.into(),
        material: "The person of the built-in motions, seed 1.".into(),
        rows: vec![row],
        table,
        pictures: vec![picture.to_owned()],
        ..Section::default()
    }
}
