//! Pages of `sinew track arm` and `sinew demo`.

use super::arm_plots::{PLOTTED, arm_plots};
use super::document::{Bone, Colour, Fact, Figure, Level, Player, Run};
use super::facts::{facts_of, number, options_table, text};
use super::folder::RunFolder;
use super::pictures::{Pictures, overlay_of};
use super::table::Table;
use crate::csv_text::cell_name;
use crate::track::REPORT_VERSION;
use serde_json::Value;

/// Name of the table of distances between track and truth.
pub const ERROR_TABLE: &str = "distance_from_truth.csv";
/// Name of the table of the truth.
pub const TRUTH_TABLE: &str = "truth.csv";

/// The run in `folder`.
pub fn arm_run(mut folder: RunFolder, pictures: &mut Pictures) -> Run {
    let report = folder.json("run.json").unwrap_or_default();
    let mut run = Run { name: folder.path().display().to_string(), ..Run::default() };
    let is_demo = folder.has("scene/demo.json");
    run.kind = if is_demo { "Demo: an arm in a rendered scene" } else { "Arm in images" }.to_owned();
    if !report.is_null() {
        folder.check_version("run.json", &report, u64::from(REPORT_VERSION));
        tell_what_was_run(&mut run, &mut folder, &report);
    }
    let track = folder.table_of_all_frames("track.csv", "Hand, elbow and shoulder of each frame and side");
    if let Some(track) = track {
        for column in PLOTTED.iter().filter(|column| !track.has(column)) {
            folder
                .notice(Level::Missing, format!("track.csv has no column {column}; what is drawn from it is missing"));
        }
        let truth = truth(&mut folder, &report);
        let error = truth.as_ref().map(|truth| distances(&track, truth));
        run.plots = arm_plots(&track, truth.as_ref(), error.as_ref(), size_px(&report));
        run.player = Some(player(&mut folder, &report, &track, truth.is_some(), pictures));
        run.tables.push(track);
        run.tables.extend(error.filter(|error| !error.rows.is_empty()));
        run.tables.extend(truth);
    } else {
        run.player = overlays_alone(&mut folder, &report, pictures);
    }
    if is_demo && let Some(error) = folder.json("error.json") {
        let metres = number(&error["median_error_m"], 3, "m");
        run.highlights.extend(metres.map(|value| Fact::new("Median error in space", value)));
        let pixels = number(&error["median_error_px"], 1, "px");
        run.highlights.extend(pixels.map(|value| Fact::new("Median error in the image", value)));
        run.tables.push(options_table("error.json", &error));
    }
    if !report["options"].is_null() {
        run.tables.push(options_table("options", &report["options"]));
    }
    run.notices = folder.into_notices();
    run
}

/// Highlights, facts, and what the run says it left out.
fn tell_what_was_run(run: &mut Run, folder: &mut RunFolder, report: &Value) {
    let (finished, frames) = (text(&report["frames_finished"]), text(&report["frames"]));
    run.highlights.push(Fact::new("Frames", format!("{finished} of {frames}")));
    for (side, counts) in report["status_counts"].as_object().into_iter().flatten() {
        // Runs of older versions have no uncertain frames.
        let all = ["tracking", "uncertain", "predicted", "lost"];
        let known = all.into_iter().filter(|status| !counts[*status].is_null());
        let words: Vec<String> = known.map(|status| format!("{} {status}", text(&counts[status]))).collect();
        run.highlights.push(Fact::new(format!("{} arm", capital(side)), words.join(", ")));
    }
    run.highlights.extend(number(&report["frames_per_second"], 0, "frames/s").map(|speed| Fact::new("Speed", speed)));
    let options = &report["options"];
    let tracker = &options["config"]["tracker"];
    run.facts =
        facts_of(report, &[("sinew_version", "Version"), ("seed", "Seed"), ("image_size_px", "Image size, px")]);
    run.facts.extend(facts_of(&report["inputs"], &[("folder", "Input")]));
    run.facts.extend(facts_of(options, &[("side", "Side"), ("rate_hz", "Frame rate, Hz"), ("skin", "Skin model")]));
    run.facts.extend(facts_of(tracker, &[("variant", "Tracker"), ("particles", "Particles")]));
    if report["complete"].as_bool() == Some(false) {
        folder.notice(Level::Missing, format!("the run ended after {finished} of {frames} frames"));
    }
    let skipped = report["skipped"].as_array().into_iter().flatten();
    let items: Vec<String> = skipped
        .map(|one| format!("frame {}, {}: {}", text(&one["frame"]), text(&one["file"]), text(&one["reason"])))
        .collect();
    let what = format!("{} images are missing or could not be read; their frames are predictions", items.len());
    folder.notice_of(Level::Skipped, what, items);
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn size_px(report: &Value) -> Option<[f64; 2]> {
    let size = &report["image_size_px"];
    Some([size[0].as_f64()?, size[1].as_f64()?])
}

/// The truth of a rendered scene: in the demo's own folder, or beside the frames that were tracked.
fn truth(folder: &mut RunFolder, report: &Value) -> Option<Table> {
    let own = folder.path().join("scene/truth.csv");
    let beside = || {
        let input = std::path::PathBuf::from(report["inputs"]["folder"].as_str()?);
        let path = input.parent()?.join("truth.csv");
        folder.find(path.to_str()?)
    };
    let path = if own.is_file() { own } else { beside().filter(|path| path.is_file())? };
    let truth = folder.table_at(&path, TRUTH_TABLE, "The truth of the rendered scene")?;
    ["frame", "side", "hand_x_m", "hand_u_px"].iter().all(|column| truth.has(column)).then_some(truth)
}

/// How far the tracked hand is from the true one, in every row that has both.
fn distances(track: &Table, truth: &Table) -> Table {
    let columns = ["frame", "time_s", "side", "error_m", "error_px"];
    let mut table = Table::new(ERROR_TABLE, "Distance of the tracked hand from the true one", &columns);
    let key = |table: &Table, row: &[String]| (table.cell(row, "frame").to_owned(), table.cell(row, "side").to_owned());
    let true_rows: std::collections::BTreeMap<_, _> = truth.rows.iter().map(|row| (key(truth, row), row)).collect();
    for row in &track.rows {
        let Some(true_row) = true_rows.get(&key(track, row)) else { continue };
        let distance = |columns: &[&str]| -> Option<f64> {
            let squares = columns.iter().map(|column| {
                let off = track.number(row, column)? - truth.number(true_row, column)?;
                Some(off * off)
            });
            squares.sum::<Option<f64>>().map(f64::sqrt)
        };
        let [metres, pixels] =
            [(distance(&["hand_x_m", "hand_y_m", "hand_z_m"]), 5), (distance(&["hand_u_px", "hand_v_px"]), 2)]
                .map(|(value, decimals)| value.map_or_else(String::new, |value| format!("{value:.decimals$}")));
        let [frame, time, side] = ["frame", "time_s", "side"].map(|column| track.cell(row, column).to_owned());
        table.rows.push(vec![frame, time, side, metres, pixels]);
    }
    table
}

fn player(folder: &mut RunFolder, report: &Value, track: &Table, has_truth: bool, pictures: &mut Pictures) -> Player {
    let frames = track.distinct("frame");
    let mut player = Player {
        table: Some(track.name.clone()),
        rate_hz: report["options"]["rate_hz"].as_f64(),
        figures: vec![figure(track, has_truth, size_px(report))],
        shown: ["image", "time_s", "side", "status", "hand_u_px", "hand_v_px", "hand_z_m", "hand_likelihood"]
            .map(str::to_owned)
            .to_vec(),
        ..Player::default()
    };
    let names = folder.path().join("overlay");
    if names.is_dir() {
        let image_of: std::collections::BTreeMap<&str, &str> =
            track.rows.iter().map(|row| (track.cell(row, "frame"), cell_name(track.cell(row, "image")))).collect();
        let found: Vec<_> = frames
            .iter()
            .map(|frame| image_of.get(frame.as_str()).and_then(|image| overlay_of(&names, image)))
            .collect();
        let lacking: Vec<String> = frames
            .iter()
            .zip(&found)
            .filter(|(_, path)| path.is_none())
            .map(|(frame, _)| format!("frame {frame}"))
            .collect();
        let what = format!("{} frames have no picture in overlay/", lacking.len());
        folder.notice_of(Level::Skipped, what, lacking);
        player.pictures = Some(pictures.add(found));
    } else {
        let text = "there are no pictures of the frames (overlay/); the player draws the arm from its numbers. Track with --overlay to have them";
        folder.notice(Level::Note, text);
    }
    player.frames = frames;
    player
}

/// Pictures of a run whose table was never written.
fn overlays_alone(folder: &mut RunFolder, report: &Value, pictures: &mut Pictures) -> Option<Player> {
    let overlay = folder.path().join("overlay");
    let names: Vec<String> =
        super::folder::names_in(&overlay).into_iter().filter(|name| name.ends_with(".png")).collect();
    if names.is_empty() {
        return None;
    }
    folder.notice(Level::Note, "the pictures of overlay/ are shown without numbers");
    let block = pictures.add(names.iter().map(|name| Some(overlay.join(name))).collect());
    let rate_hz = report["options"]["rate_hz"].as_f64();
    Some(Player { frames: names, pictures: Some(block), rate_hz, ..Player::default() })
}

/// The arms in the image.
fn figure(track: &Table, has_truth: bool, size_px: Option<[f64; 2]>) -> Figure {
    let mut bones = Vec::new();
    let tables = if has_truth { vec![(TRUTH_TABLE, true)] } else { vec![] };
    for (table, truth) in tables.into_iter().chain([(track.name.as_str(), false)]) {
        for side in track.distinct("side") {
            for (from, to) in [("shoulder", "elbow"), ("elbow", "hand")] {
                let ends = [from, to].map(|joint| [format!("{joint}_u_px"), format!("{joint}_v_px")]);
                let [from, to] = ends;
                let only = vec![["side".to_owned(), side.clone()]];
                bones.push(Bone { table: table.to_owned(), only, from, to, colour: Colour::of_side(&side), truth });
            }
        }
    }
    Figure {
        title: "The arm in the image".to_owned(),
        bounds: size_px.map(|[width, height]| [0.0, 0.0, width, height]),
        y_down: true,
        bones,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_rows_that_have_both() {
        let columns = "frame,time_s,side,hand_x_m,hand_y_m,hand_z_m,hand_u_px,hand_v_px\n";
        let track = format!(
            "{columns}0,0.0,left,0,0,1,10,10\n0,0.0,right,0.3,0.4,1,13,14\n1,0.1,right,,,,,\n2,0.2,right,0,0,1,0,0\n"
        );
        let truth = format!("{columns}0,0.0,right,0,0,1,10,10\n1,0.1,right,0,0,1,10,10\n");
        let table = |name: &str, text: &str| Table::parse(name, "", text.as_bytes()).0;
        let error = distances(&table("track.csv", &track), &table(TRUTH_TABLE, &truth));
        let expected = "frame,time_s,side,error_m,error_px\n0,0.0,right,0.50000,5.00\n1,0.1,right,,\n";
        assert_eq!(error.to_csv(), expected);
    }
}
