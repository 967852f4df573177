//! The PIK paper: figures 2, 9 to 17, 19 and 20, on real motion before a simulated stereo camera.

use super::goals_against_angles::{Comparison, PAIR, Pair, Value, compare, plots};
use super::open_numbers::{self, Numbers};
use super::page::{Row, Section};
use super::pik_geometry::figure_7;
use super::plot::{Plot, Series};
use super::{Made, Material, of_trend, printed, seeds};
use crate::body::prediction::lift::SampleSpread;
use crate::body::prediction::{self, PredictionReport};
use crate::body::trial::{SeenMotion, TrialResult, trial};
use crate::body::{Measured, MotionChoice};
use crate::data_split::{Role, motions};
use anyhow::Result;
use image::RgbImage;
use serde_json::json;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::body::{BodyJoints, BodyPart, fit_pose};
use sinew::draw::body_views::{body_views, drawn_bones};
use sinew::draw::pose_fan::{Look, PoseFan, pose_fans};
use sinew::resume::Cells;
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_ANGLES, body_radii_m, full_body};

/// Rows in the data split of these numbers.
pub const TRACKER: &str = "body-paper";
/// Rows in the data split of the recordings with markers.
const MARKERS_TRACKER: &str = "body-markers";
/// Numbers of particles of figures 13 to 15.
const PARTICLES: [usize; 6] = [50, 100, 250, 500, 1000, 2500];
/// Those of a quick run.
const QUICK_PARTICLES: [usize; 3] = [50, 100, 500];
/// Numbers of particles whose margin is printed.
const MARGIN_PARTICLES: [usize; 2] = [100, 500];
/// Why the numbers are not the paper's.
const OTHER_DATA: &str = "The paper's stereo sequence is not public. Real motion is seen by a simulated small-baseline \
                          stereo camera at 15 frames a second, and the paper draws its errors without printing a number.";

/// Everything of the page.
///
/// # Errors
/// Recordings that are missing; a run that fails.
pub fn make(material: Material<'_>, cells: &Cells<'_>) -> Result<Made> {
    let seeds = seeds(material.is_quick, 5);
    let all = if material.is_quick { &QUICK_PARTICLES[..] } else { &PARTICLES[..] };
    let particles = &all[..all.partition_point(|&count| count <= material.max_particles)];
    let mut made = Made::default();
    made.page.title = "PIK paper: predicting articulated human motion from spatial processes".into();
    if material.is_quick {
        made.page.left_out = vec![
            "seeds 3 to 5, and 250, 1000 and 2500 particles".into(),
            "the whole body: upper bodies only, as in the paper's sequence".into(),
            "other sets of open numbers with 500 particles".into(),
        ];
    }
    if particles.len() < all.len() {
        made.page.left_out.push(format!("more than {} particles", material.max_particles));
    }
    made.page.left_out.push("figures 8, 18 and 21: the paper's films are not public".into());
    let skeleton = material.data.join("mocap/cmu-walk/35/35.asf");
    let tuning = BodyTuning::default();
    let parts: &[BodyPart] = if material.is_quick { &[BodyPart::Upper] } else { &[BodyPart::Upper, BodyPart::Whole] };
    predictions(&tuning, &mut made)?;
    geometry(&mut made);
    for &part in parts {
        let mut seen: Vec<(String, Vec<SeenMotion>)> = Vec::new();
        for motion in motions(material.data, TRACKER, Role::Reporting)? {
            cells.go_on()?;
            let read = motion.read(Some(&skeleton))?;
            seen.push((motion.name(), (1..=seeds).map(|seed| read.seen(part, seed)).collect::<Result<_>>()?));
        }
        let shared = [tuning; 2];
        let comparison = Comparison { part, motions: &seen, particles, tunings: shared, models: PAIR };
        figures_13_to_15(&comparison, cells, &mut made)?;
        let counts = if material.is_quick { &MARGIN_PARTICLES[..1] } else { &MARGIN_PARTICLES[..] };
        let counts = &counts[..counts.partition_point(|&count| count <= material.max_particles)];
        other_numbers(&Comparison { particles: counts, ..comparison }, cells, &mut made)?;
    }
    recorded_markers(&material, (&tuning, seeds), cells, &mut made)?;
    stick(&tuning, (seeds, particles), cells, &mut made)?;
    Ok(made)
}

/// Figures 2, 19 and 20.
fn predictions(tuning: &BodyTuning, made: &mut Made) -> Result<()> {
    let seen = MotionChoice::StickWave.seen(None, 1)?;
    let (report, pictures) = prediction::predict(&seen, tuning)?;
    let PredictionReport { chain_spread, pelvic_lift } = &report;
    let row = Row {
        what: "trend".into(),
        paper: "the spread of limbs grows along the chains under noise of angles".into(),
        ours: format!("kappa {}; goals known to {} cm", chain_spread.kappa, cm(f64::from(chain_spread.reach_std_m))),
        // Two joints of a chain follow each other.
        difference: of_trend(chain_spread.joints.chunks(2).all(|two| two[0].angular_m <= two[two.len() - 1].angular_m)),
    };
    let joints = chain_spread.joints.iter();
    let rows = joints.map(|joint| vec![joint.joint.to_owned(), cm(joint.angular_m), cm(joint.end_effector_m)]);
    let table = with_head(&["joint", "noise of angles, cm", "goals, cm"], rows);
    let title = "Figure 2: where noise of the angles goes, and where goals leave it";
    made.page.sections.push(built_in(title, row, table, "figure_2_spread.png"));
    let row = Row {
        what: "trend".into(),
        paper: "pelvis and spine spread up and down, knees in all directions, the rest little".into(),
        ours: format!("pelvis up and down {} cm; the others in the table", cm(pelvic_lift.pelvis_up_std_m)),
        difference: of_trend(moves_without_goals(&pelvic_lift.joints)),
    };
    let rows = pelvic_lift.joints.iter().map(|joint| vec![joint.joint.to_owned(), cm(joint.spread_m)]);
    let table = with_head(&["joint", "spread of ten samples, cm"], rows);
    made.page.sections.push(built_in("Figure 19: ten samples of the pelvic lift", row, table, "figure_19_samples.png"));
    let precision = pelvic_lift.precision;
    let row = Row {
        what: "trend".into(),
        paper: "blocks of joints that share a goal".into(),
        ours: format!("mean entry inside a block {:.3}, between blocks {:.4}", precision.inside, precision.between),
        difference: of_trend(precision.inside > precision.between),
    };
    let title = "Figure 20: precision of the importance distribution";
    made.page.sections.push(built_in(title, row, Vec::new(), "figure_20_precision.png"));
    made.pictures.extend(pictures);
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

/// PIK (34) over markers that were recorded on a person, which no model of ours made.
fn recorded_markers(
    material: &Material<'_>,
    (tuning, seeds): (&BodyTuning, u64),
    cells: &Cells<'_>,
    made: &mut Made,
) -> Result<()> {
    let head = ["recording", "model", "recorded markers, PIK (34), cm", "virtual markers, cm", "joints, cm", "lost, %"];
    let mut table = vec![head.map(String::from).to_vec()];
    for motion in motions(material.data, MARKERS_TRACKER, Role::Reporting)? {
        let read = motion.read(None)?;
        let seen: Vec<SeenMotion> = (1..=seeds).map(|seed| read.seen(BodyPart::Whole, seed)).collect::<Result<_>>()?;
        for (model, count) in [(PAIR[0], 500), (PAIR[1], 500), (BodyModelKind::Guided, 50)] {
            let one = |(seed, motion): (u64, &SeenMotion)| -> Result<TrialResult> {
                let key = json!(["recorded markers", motion.key(), model.name(), tuning.paper, count, seed]);
                cells.cell(&key, || trial(motion, model, tuning, count, seed).map(|trial| trial.0))
            };
            let trials: Vec<TrialResult> = (1..).zip(&seen).map(one).collect::<Result<_>>()?;
            let of = |value: Value| Measured::of(&trials.iter().map(value).collect::<Vec<_>>());
            let cm = |value: Value| format!("{:.2} +- {:.2}", 100.0 * of(value).mean, 100.0 * of(value).std);
            table.push(vec![
                motion.name(),
                format!("{}, {count}", model.name()),
                cm(|t| t.recorded_error_m.unwrap_or(f64::NAN)),
                cm(|t| t.error_m),
                cm(|t| t.joint_error_m),
                format!("{:.0}", 100.0 * of(|t| t.lost_joint_share).mean),
            ]);
        }
        if let Some(floor_m) = seen.first().map(SeenMotion::recorded_floor_m).transpose()?.flatten() {
            let none = String::new;
            let floor = format!("{:.2}", 100.0 * floor_m);
            table.push(vec![motion.name(), "nearest pose of this body".into(), floor, none(), none(), none()]);
        }
    }
    made.page.sections.push(Section {
        id: "recorded-markers",
        title: "PIK (34) over recorded markers".into(),
        material: format!(
            "A take of HDM05 with the markers of its optical system; {seeds} seeds, +- is one standard deviation over \
             them. The points are still those of the simulated camera. No tracker of this body gets below the nearest \
             pose."
        ),
        table,
        ..Section::default()
    });
    Ok(())
}

/// Whether pelvis and knees spread more than what is held: head, wrists and ankles.
fn moves_without_goals(joints: &[SampleSpread]) -> bool {
    let of = |names: &[&str]| -> Vec<f64> {
        joints.iter().filter(|joint| names.contains(&joint.joint)).map(|joint| joint.spread_m).collect()
    };
    let held = of(&["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"]).into_iter().fold(0.0, f64::max);
    of(&["pelvis", "l_knee", "r_knee"]).into_iter().all(|spread_m| spread_m > held)
}

/// Centimetres with one decimal.
fn cm(metres: f64) -> String {
    format!("{:.1}", 100.0 * metres)
}

fn with_head(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Vec<Vec<String>> {
    std::iter::once(head.iter().map(|name| (*name).to_owned()).collect()).chain(rows).collect()
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

fn percent((mean, low, high): (f64, f64, f64)) -> String {
    format!("{mean:.0} % (95 % interval {low:.0} to {high:.0})")
}

fn figures_13_to_15(comparison: &Comparison<'_>, cells: &Cells<'_>, made: &mut Made) -> Result<()> {
    let pairs = compare(comparison, cells)?;
    let (part, motions) = (comparison.part, comparison.motions);
    let truth: Vec<f64> = motions.iter().filter_map(|(_, seen)| seen.first().map(SeenMotion::smoothness_m)).collect();
    let truth_m = Measured::of(&truth).mean;
    let plots = plots(&pairs, part, truth_m);
    let mut table = numbers(&pairs);
    table.extend(baselines(comparison, cells)?);
    let mut rows = Vec::new();
    for pair in pairs.iter().filter(|pair| MARGIN_PARTICLES.contains(&pair.particles)) {
        let measures: [(&str, Value); 3] =
            [("PIK (34)", |t| t.error_m), ("joint error", |t| t.joint_error_m), ("PIK (35)", |t| t.smoothness_m)];
        for (name, value) in measures {
            rows.push(Row {
                what: format!("goals below angles by, {name}, {} particles", pair.particles),
                paper: "above zero at every number; drawn, not printed".into(),
                ours: percent(pair.margin_percent(value)),
                difference: "no number to compare".into(),
            });
        }
    }
    let times: Vec<f64> =
        pairs.iter().map(|p| mean(p, 0, |t| t.seconds_per_frame) / mean(p, 1, |t| t.seconds_per_frame)).collect();
    rows.push(Row {
        what: "time of goals over that of angles".into(),
        paper: format!("about {}", printed::PIK_TIME_RATIO),
        ours: format!("{:.2}", Measured::of(&times).mean),
        difference: format!("{:+.2}", Measured::of(&times).mean - printed::PIK_TIME_RATIO),
    });
    made.page.sections.push(Section {
        id: if part == BodyPart::Upper { "figures-13-upper" } else { "figures-13-whole" },
        title: format!("Figures 13 to 15: goals against angles, {} body", part.name()),
        material: format!(
            "{} motions, {} seeds each, none of them tuned on. Both models have the paper's structure, and the numbers \
             that it leaves open were searched alike. Intervals are over motions.",
            motions.len(),
            motions.first().map_or(0, |(_, seen)| seen.len())
        ),
        rows,
        reason: OTHER_DATA.into(),
        table,
        pictures: plots.iter().map(|(file, _)| file.clone()).collect(),
    });
    made.plots.extend(plots);
    Ok(())
}

fn mean(pair: &Pair, model: usize, value: Value) -> f64 {
    pair.mean_and_std(model, value).0
}

fn numbers(pairs: &[Pair]) -> Vec<Vec<String>> {
    let head = [
        "particles",
        "model",
        "PIK (34), cm",
        "joints, cm",
        "frames with a joint over 10 cm off",
        "PIK (35), cm a frame",
        "ms a frame",
    ];
    let mut table = vec![head.map(String::from).to_vec()];
    for pair in pairs {
        for (index, model) in PAIR.iter().enumerate() {
            let of = |value: Value, scale: f64| {
                let (mean, std) = pair.mean_and_std(index, value);
                format!("{:.2} +- {:.2}", scale * mean, scale * std)
            };
            table.push(vec![
                pair.particles.to_string(),
                model.name().into(),
                of(|t| t.error_m, 100.0),
                of(|t| t.joint_error_m, 100.0),
                format!("{:.0} %", 100.0 * mean(pair, index, |t| t.lost_joint_share)),
                of(|t| t.smoothness_m, 100.0),
                format!("{:.1}", 1000.0 * mean(pair, index, |t| t.seconds_per_frame)),
            ]);
        }
    }
    table
}

/// What any tracker has to beat: the mode alone, and the true pose of the frame before.
fn baselines(comparison: &Comparison<'_>, cells: &Cells<'_>) -> Result<Vec<Vec<String>>> {
    let (mut modes, mut before_m) = (Vec::new(), Vec::new());
    for (name, seen) in comparison.motions {
        for (seed, motion) in (1..).zip(seen) {
            let key = json!(["mode alone", name, comparison.part.name(), seed]);
            let run = || trial(motion, BodyModelKind::Guided, &comparison.tunings[0], 1, seed).map(|trial| trial.0);
            modes.push(cells.cell(&key, run)?);
        }
        before_m.extend(seen.first().map(last_pose_error_m));
    }
    let of = |value: Value| Measured::of(&modes.iter().map(value).collect::<Vec<_>>()).mean;
    let row = |name: &str, cells: [String; 5]| [vec!["1".into(), name.to_owned()], cells.to_vec()].concat();
    let cm = |value: f64| format!("{:.2}", 100.0 * value);
    let mode = [
        cm(of(|t| t.error_m)),
        cm(of(|t| t.joint_error_m)),
        format!("{:.0} %", 100.0 * of(|t| t.lost_joint_share)),
        cm(of(|t| t.smoothness_m)),
        format!("{:.1}", 1000.0 * of(|t| t.seconds_per_frame)),
    ];
    let none = String::new;
    let before = [none(), cm(Measured::of(&before_m).mean), none(), none(), none()];
    Ok(vec![
        row("baseline: the mode alone (one guided particle, default numbers)", mode),
        row("baseline: the true pose of the frame before", before),
    ])
}

/// Mean distance of the joints from their places in the frame before, metres.
fn last_pose_error_m(motion: &SeenMotion) -> f64 {
    let mut ways_m = Vec::new();
    for frames in motion.joints_m.windows(2) {
        for (before, now) in frames[0].iter().zip(&frames[1]).take(motion.part.bones()) {
            if let (Some(before), Some(now)) = (before, now) {
                ways_m.push(f64::from((now - before).norm()));
            }
        }
    }
    Measured::of(&ways_m).mean
}

/// The margin with other sets of open numbers, and with the other reading of PIK (31) and PIK (33).
fn other_numbers(comparison: &Comparison<'_>, cells: &Cells<'_>, made: &mut Made) -> Result<()> {
    let head = [
        "numbers",
        "reach, cm",
        "particles",
        "PIK (34), cm: goals",
        "angles",
        "goals below angles by",
        "joints, cm: goals",
        "angles",
        "goals below angles by",
    ];
    let mut table = vec![head.map(String::from).to_vec()];
    for Numbers { name, tunings } in open_numbers::all() {
        for pair in compare(&Comparison { tunings, ..comparison.clone() }, cells)? {
            let reach_cm = format!("{:.1}", 100.0 * tunings[0].paper.reach_std_m);
            let mut row = vec![name.to_owned(), reach_cm, pair.particles.to_string()];
            let values: [Value; 2] = [|t| t.error_m, |t| t.joint_error_m];
            for value in values {
                row.extend([0, 1].map(|model| format!("{:.2}", 100.0 * mean(&pair, model, value))));
                row.push(percent(pair.margin_percent(value)));
            }
            table.push(row);
        }
    }
    made.page.sections.push(Section {
        id: if comparison.part == BodyPart::Upper { "open-numbers-upper" } else { "open-numbers-whole" },
        title: format!("Figure 13 with other open numbers, {} body", comparison.part.name()),
        material:
            "The paper prints no lambda, W, sigma, tau or kappa. Each set was searched alike for goals and angles. \
                   Reach is 1 / root W: a goal that is known to metres does not pull. The last row reads (31) and (33) \
                   literally: of the particle's own last two angles and sampled goals."
                .into(),
        table,
        ..Section::default()
    });
    Ok(())
}

/// Figures 6, 9 to 12, 16 and 17: a stick in both hands.
fn stick(tuning: &BodyTuning, (seeds, particles): (u64, &[usize]), cells: &Cells<'_>, made: &mut Made) -> Result<()> {
    let read = MotionChoice::StickWave.read(None)?;
    let seen: Vec<SeenMotion> = (1..=seeds).map(|seed| read.seen(BodyPart::Whole, seed)).collect::<Result<_>>()?;
    let series = stick_series(tuning, (&seen, particles), cells)?;
    let rows = stick_trends(&series);
    made.plots.push((
        "figure_17.svg".into(),
        Plot {
            title: "Figure 17: error, PIK (34), with a known stick".into(),
            x_label: "particles (logarithmic)".into(),
            y_label: "distance of markers from the skin, cm".into(),
            log_x: true,
            bars: "one standard deviation over seeds, as in the paper".into(),
            series,
        },
    ));
    let largest = particles.last().copied().unwrap_or(500);
    let mut names = vec!["figure_17.svg".to_owned()];
    if let Some(motion) = seen.first() {
        made.pictures.push(("figure_6.png".to_owned(), points_picture(motion)?));
        names.push("figure_6.png".to_owned());
        for (name, model, count) in [
            ("figure_9.png", BodyModelKind::AngularPaper, 500),
            ("figure_10.png", BodyModelKind::AngularPaper, largest),
            ("figure_11.png", BodyModelKind::EndEffectorPaper, 500),
            ("figure_12.png", BodyModelKind::EndEffectorPaper, largest),
            ("figure_16.png", BodyModelKind::Stick, 500),
        ] {
            cells.go_on()?;
            made.pictures.push((name.to_owned(), frames_picture(motion, model, tuning, count)?));
            names.push(name.to_owned());
        }
    }
    made.page.sections.push(Section {
        id: "figure-17",
        title: "Figures 6, 9 to 12, 16 and 17: a person who waves a stick".into(),
        material: format!(
            "The built-in motion stick-wave, {seeds} seeds. Figures 9 to 12 and 16 show the same three frames, from \
             the camera; figures 10 and 12 have {largest} particles. The stick's model is the shipped one."
        ),
        rows,
        reason: OTHER_DATA.into(),
        pictures: names,
        ..Section::default()
    });
    Ok(())
}

/// Whether goals are below angles, and the stick below both, at every number of particles.
fn stick_trends(series: &[Series]) -> Vec<Row> {
    let [angles, goals, stick] = series else { return Vec::new() };
    let below = |low: &Series, high: &Series| low.points.iter().zip(&high.points).all(|(a, b)| a.1 < b.1);
    let ends = |curve: &Series| {
        let [Some(first), Some(last)] = [curve.points.first(), curve.points.last()] else { return String::new() };
        format!("{} {:.2} to {:.2}", curve.name, first.1, last.1)
    };
    let row = |what: &str, paper: &str, curves: &[&Series], comes_out: bool| Row {
        what: what.into(),
        paper: paper.into(),
        ours: format!(
            "cm from the least to the most particles: {}",
            curves.iter().map(|c| ends(c)).collect::<Vec<_>>().join(", ")
        ),
        difference: of_trend(comes_out),
    };
    vec![
        row("figures 9 to 12", "goals track more accurately than angles", &[goals, angles], below(goals, angles)),
        row(
            "figures 16 and 17",
            "the stick is better than all others, with fewer particles",
            &[stick, goals, angles],
            below(stick, goals) && below(stick, angles),
        ),
    ]
}

/// The curves of figure 17.
fn stick_series(
    tuning: &BodyTuning,
    (seen, particles): (&[SeenMotion], &[usize]),
    cells: &Cells<'_>,
) -> Result<Vec<Series>> {
    let models = [BodyModelKind::AngularPaper, BodyModelKind::EndEffectorPaper, BodyModelKind::Stick];
    let point = |model: BodyModelKind, count: usize| -> Result<(f64, f64, f64)> {
        let one = |(seed, motion): (u64, &SeenMotion)| {
            let key = json!(["stick", model.name(), tuning.paper, count, seed]);
            let run = || trial(motion, model, tuning, count, seed).map(|trial| trial.0);
            cells.cell(&key, run).map(|trial: TrialResult| trial.error_m)
        };
        let measured = Measured::of(&(1..).zip(seen).map(one).collect::<Result<Vec<f64>>>()?);
        Ok((count as f64, 100.0 * measured.mean, 100.0 * measured.std))
    };
    models
        .into_iter()
        .map(|model| {
            let points = particles.iter().map(|&count| point(model, count)).collect::<Result<_>>()?;
            Ok(Series { name: model.name().into(), points })
        })
        .collect()
}

/// Figure 6: the points of a frame from the camera and from the side, with the true pose.
fn points_picture(motion: &SeenMotion) -> Result<RgbImage> {
    let (skeleton, radii_m) = (full_body(&motion.measures)?, body_radii_m(&motion.measures));
    let frame = printed::PIK_FRAMES[0].min(motion.clouds_m.len() - 1);
    let truth = fit_pose(&skeleton, &motion.joints_m[frame], None).angles;
    let bones = drawn_bones(&posture(&skeleton, &Vec3::zeros(), &truth), &radii_m);
    Ok(body_views(&format!("Figure 6: points of frame {frame}"), &motion.clouds_m[frame], &bones))
}

/// True and estimated pose in the paper's three frames, or in as many parts of a shorter motion.
fn frames_picture(motion: &SeenMotion, model: BodyModelKind, tuning: &BodyTuning, count: usize) -> Result<RgbImage> {
    let (_, estimates) = trial(motion, model, tuning, count, 1)?;
    let (skeleton, radii_m) = (full_body(&motion.measures)?, body_radii_m(&motion.measures));
    let bones = |angles: &[f32; BODY_ANGLES]| drawn_bones(&posture(&skeleton, &Vec3::zeros(), angles), &radii_m);
    let frames = printed::PIK_FRAMES.map(|frame| frame.min(estimates.len()));
    let panels: Vec<_> = frames
        .iter()
        .map(|&frame| {
            let joints: &BodyJoints = &motion.joints_m[frame];
            let estimate = &estimates[frame - 1];
            let truth = fit_pose(&skeleton, joints, Some(&estimate.angles_rad)).angles;
            (
                format!("{}, {count}: frame {frame}, over the truth", model.name()),
                vec![bones(&truth), bones(&estimate.angles_rad)],
            )
        })
        .collect();
    let fans: Vec<PoseFan<'_>> =
        panels.iter().map(|(title, poses)| PoseFan { title, notes: &[], poses, look: Look::Front }).collect();
    Ok(pose_fans(&fans))
}
