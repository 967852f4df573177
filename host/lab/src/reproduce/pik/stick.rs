//! Figures 6, 9 to 12, 16 and 17: a person who waves a stick.

use super::common::{MEASURES, OTHER_DATA, measures, reported, with_head};
use crate::body::trial::{PoseMeasures, SeenMotion, TrialResult, trial};
use crate::body::{Measured, MotionChoice};
use crate::reproduce::body_panels::{BodyPanel, body_panels};
use crate::reproduce::page::{Row, Section};
use crate::reproduce::plot::{Plot, Series};
use crate::reproduce::{Made, of_trend, printed};
use anyhow::Result;
use serde_json::json;
use sinew::body::tracking::{BodyModelKind, BodyTuning};
use sinew::body::{BodyJoints, BodyPart, fit_pose};
use sinew::draw::body_views::{DrawnBone, drawn_bones};
use sinew::draw::pose_fan::Look;
use sinew::resume::Cells;
use sinew_core::kinematics::forward::posture;
use sinew_core::math::Vec3;
use sinew_core::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, body_radii_m, full_body};

/// Models of figure 17.
const MODELS: [BodyModelKind; 3] = [BodyModelKind::AngularPaper, BodyModelKind::EndEffectorPaper, BodyModelKind::Stick];

/// A model with a number of particles, its trials one a seed.
struct Cell {
    model: BodyModelKind,
    particles: usize,
    trials: Vec<TrialResult>,
}

/// Adds the figures.
///
/// # Errors
/// A number of a tracker that breaks a rule; an interrupted run.
pub fn stick(
    tuning: &BodyTuning,
    (seeds, particles): (u64, &[usize]),
    cells: &Cells<'_>,
    made: &mut Made,
) -> Result<()> {
    let read = MotionChoice::StickWave.read(None)?;
    let seen: Vec<SeenMotion> = (1..=seeds).map(|seed| read.seen(BodyPart::Whole, seed)).collect::<Result<_>>()?;
    let tracked = |model: BodyModelKind, particles: usize| -> Result<Cell> {
        let one = |(seed, motion): (u64, &SeenMotion)| {
            let key = json!(["stick", model.name(), tuning.paper, particles, seed]);
            cells.cell(&key, || trial(motion, model, tuning, particles, seed).map(|trial| trial.0))
        };
        Ok(Cell { model, particles, trials: (1..).zip(&seen).map(one).collect::<Result<_>>()? })
    };
    let jobs = MODELS.into_iter().flat_map(|model| particles.iter().map(move |&count| (model, count)));
    let tracks: Vec<Cell> = jobs.map(|(model, count)| tracked(model, count)).collect::<Result<_>>()?;
    let series = MODELS.map(|model| curve(model, &tracks));
    let largest = particles.last().copied().unwrap_or(500);
    let mut names = vec!["figure_6.svg".to_owned()];
    made.drawings.push(("figure_6.svg".to_owned(), points(&seen[0])?));
    for (figure, model, count) in [
        (9, BodyModelKind::AngularPaper, 500),
        (10, BodyModelKind::AngularPaper, largest),
        (11, BodyModelKind::EndEffectorPaper, 500),
        (12, BodyModelKind::EndEffectorPaper, largest),
        (16, BodyModelKind::Stick, 500),
    ] {
        cells.go_on()?;
        let name = format!("figure_{figure}.svg");
        made.drawings.push((name.clone(), frames(&seen[0], model, tuning, count)?));
        names.push(name);
    }
    names.push("figure_17.svg".to_owned());
    made.page.sections.push(Section {
        id: "figure-17",
        title: "Figures 6, 9 to 12, 16 and 17: a person who waves a stick".into(),
        material: format!(
            "The built-in motion stick-wave, {seeds} seeds; +- is one standard deviation over them. Figures 9 to 12 \
             and 16 show the same three frames over the truth, from the camera, with seed 1; figures 10 and 12 have \
             {largest} particles. The stick's model is the shipped one, with a deadband; the other two have none."
        ),
        rows: stick_trends(&series),
        reason: OTHER_DATA.into(),
        table: table(&tracks, &tracked(BodyModelKind::Guided, 1)?),
        pictures: names,
    });
    made.plots.push((
        "figure_17.svg".into(),
        Plot {
            title: "Figure 17: error, PIK (34), with a known stick".into(),
            x_label: "particles (logarithmic)".into(),
            y_label: "distance of markers from the skin, cm".into(),
            log_x: true,
            bars: "one standard deviation over seeds, as in the paper".into(),
            series: series.to_vec(),
            ..Plot::default()
        },
    ));
    Ok(())
}

fn curve(model: BodyModelKind, tracks: &[Cell]) -> Series {
    let point = |cell: &Cell| {
        let measured = Measured::of(&cell.trials.iter().map(|trial| trial.error_m).collect::<Vec<_>>());
        (cell.particles as f64, 100.0 * measured.mean, 100.0 * measured.std)
    };
    let points = tracks.iter().filter(|cell| cell.model == model).map(point).collect();
    Series { name: model.name().into(), points }
}

/// All measures; of a model with a deadband also before it.
fn table(tracks: &[Cell], mode: &Cell) -> Vec<Vec<String>> {
    let row = |cell: &Cell, name: String, of: fn(&TrialResult) -> PoseMeasures| {
        let poses: Vec<PoseMeasures> = cell.trials.iter().map(of).collect();
        [vec![name, cell.particles.to_string()], measures(&poses).to_vec()].concat()
    };
    let mut rows = Vec::new();
    for cell in tracks {
        rows.push(row(cell, cell.model.name().into(), reported));
        if cell.model == BodyModelKind::Stick {
            rows.push(row(cell, "stick, before the deadband".into(), |trial| trial.before_deadband));
        }
    }
    rows.push(row(mode, "baseline: the mode alone (guided)".into(), reported));
    with_head(["model", "particles"].into_iter().chain(MEASURES), rows)
}

/// Whether goals are below angles, and the stick below both, at every number of particles.
fn stick_trends([angles, goals, stick]: &[Series; 3]) -> Vec<Row> {
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

/// Draws poses of a motion's person.
struct Person {
    skeleton: BodySkeleton,
    radii_m: [f32; BODY_BONES],
}

impl Person {
    fn of(motion: &SeenMotion) -> Result<Self> {
        Ok(Self { skeleton: full_body(&motion.measures)?, radii_m: body_radii_m(&motion.measures) })
    }

    fn bones(&self, angles_rad: &[f32; BODY_ANGLES]) -> Vec<DrawnBone> {
        drawn_bones(&posture(&self.skeleton, &Vec3::zeros(), angles_rad), &self.radii_m)
    }

    fn truth(&self, joints_m: &BodyJoints, near_rad: Option<&[f32; BODY_ANGLES]>) -> Vec<DrawnBone> {
        self.bones(&fit_pose(&self.skeleton, joints_m, near_rad).angles)
    }
}

/// Figure 6: the points of a frame from the camera and from the side, with the true pose.
fn points(motion: &SeenMotion) -> Result<String> {
    let frame = printed::PIK_FRAMES[0].min(motion.clouds_m.len() - 1);
    let truth = Person::of(motion)?.truth(&motion.joints_m[frame], None);
    let panel = |name: &str, look| BodyPanel {
        title: format!("points of frame {frame}, {name}"),
        look,
        truth: &truth,
        poses: &[],
        points_m: &motion.clouds_m[frame],
    };
    Ok(body_panels(&[
        panel("as the camera looks", Look::Front),
        panel("from the side, camera to the left", Look::Side),
    ]))
}

/// True and estimated pose in the paper's three frames, or in as many parts of a shorter motion.
fn frames(motion: &SeenMotion, model: BodyModelKind, tuning: &BodyTuning, count: usize) -> Result<String> {
    let (_, estimates) = trial(motion, model, tuning, count, 1)?;
    let person = Person::of(motion)?;
    let frames = printed::PIK_FRAMES.map(|frame| frame.min(estimates.len()));
    let drawn = frames.map(|frame| {
        let angles_rad = &estimates[frame - 1].angles_rad;
        (person.truth(&motion.joints_m[frame], Some(angles_rad)), [person.bones(angles_rad)])
    });
    let panels: Vec<BodyPanel<'_>> = frames
        .iter()
        .zip(&drawn)
        .map(|(frame, (truth, poses))| BodyPanel {
            title: format!("{}, {count} particles: frame {frame}", model.name()),
            look: Look::Front,
            truth,
            poses,
            points_m: &[],
        })
        .collect();
    Ok(body_panels(&panels))
}
