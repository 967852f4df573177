//! Plots of a tracked body.

use super::document::{Colour, Plot, Series, Style};
use super::series::{DEGREES, select};
use super::table::Table;

/// Angles that share a plot: name, what the columns begin with.
const GROUPS: [(&str, &[&str]); 5] = [
    ("pelvis and trunk", &["root_turn", "root_tilt", "root_pitch", "trunk_", "head_pitch", "head_tilt", "head_turn"]),
    ("left arm", &["l_shoulder_", "l_elbow_"]),
    ("right arm", &["r_shoulder_", "r_elbow_"]),
    ("left leg", &["l_hip_", "l_knee_", "l_ankle_"]),
    ("right leg", &["r_hip_", "r_knee_", "r_ankle_"]),
];
const ENDS: [&str; 5] = ["head", "l_wrist", "r_wrist", "l_ankle", "r_ankle"];

/// All plots of a track; with `rate_hz` over time, else over frames.
#[must_use]
pub fn body_plots(track: &Table, error: Option<&Table>, rate_hz: Option<f64>) -> Vec<Plot> {
    let time = Time { seconds: rate_hz.filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate) };
    let mut plots = vec![path(track)];
    plots.extend(error.map(|error| errors(error, &time)));
    plots.extend(GROUPS.iter().map(|(name, starts)| angles(track, name, starts, &time)));
    let one = |column: &str, title: &str, y_label: &str, reading: &str| Plot {
        id: format!("body {column}"),
        group: "How sure the tracker was".to_owned(),
        title: title.to_owned(),
        reading: reading.to_owned(),
        from_zero: column != "log_evidence",
        series: vec![time.series(track, column, &title.to_lowercase(), Colour::C0)],
        ..time.plot(y_label)
    };
    plots.push(one(
        "effective_sample_size",
        "Effective sample size",
        "particles",
        "How many particles share the weight; near 1 the estimate hangs on a single one.",
    ));
    plots.push(one(
        "log_evidence",
        "Log evidence",
        "natural logarithm",
        "How well the particles explained the points; a drop marks a surprise.",
    ));
    plots.extend([spread(track, &time), ambiguous(track, &time)]);
    plots.push(one("points", "Points", "points weighed", "How much there was to see; 0 makes the frame a prediction."));
    for plot in &mut plots {
        plot.series.retain(|series| series.table != track.name || (track.has(&series.x) && track.has(&series.y)));
    }
    plots.retain(|plot| !plot.series.is_empty());
    plots
}

/// Time in seconds where the rate is known.
struct Time {
    seconds: Option<f64>,
}

impl Time {
    fn plot(&self, y_label: &str) -> Plot {
        let x_label = if self.seconds.is_some() { "time, s" } else { "frame" };
        Plot { x_label: x_label.to_owned(), y_label: y_label.to_owned(), over_frames: true, ..Plot::default() }
    }

    fn series(&self, table: &Table, column: &str, name: &str, colour: Colour) -> Series {
        let x_times = self.seconds.unwrap_or(1.0);
        Series { name: name.to_owned(), x_times, colour, ..select(table, "frame", column) }
    }
}

/// A word as people read it: `l_wrist` is the left wrist.
fn words(name: &str) -> String {
    let side =
        [("l_", "left "), ("r_", "right ")].iter().find_map(|(short, long)| Some((name.strip_prefix(short)?, *long)));
    side.map_or_else(|| name.to_owned(), |(rest, side)| format!("{side}{rest}")).replace('_', " ")
}

fn path(track: &Table) -> Plot {
    let wrist = |name: &str| Series {
        name: words(name),
        style: Style::Points,
        colour: Colour::of_side(name),
        ..select(track, &format!("{name}_x_m"), &format!("{name}_y_m"))
    };
    Plot {
        id: "body path".to_owned(),
        group: "Hands".to_owned(),
        title: "Path of the wrists, from the front".to_owned(),
        reading: "Camera axes: x right, y down; the frame of the player is marked.".to_owned(),
        x_label: "x, m".to_owned(),
        y_label: "y, m".to_owned(),
        image_axes: true,
        over_frames: true,
        series: vec![wrist("l_wrist"), wrist("r_wrist")],
        ..Plot::default()
    }
}

fn errors(error: &Table, time: &Time) -> Plot {
    let columns = error.columns.iter().skip(1).enumerate();
    let series = columns.map(|(index, column)| {
        let name = words(column.trim_end_matches("_error_m"));
        let style = if index == 0 { Style::Line } else { Style::Dashes };
        Series { style, ..time.series(error, column, &name, Colour::nth(index)) }
    });
    Plot {
        id: "body error".to_owned(),
        group: "Hands".to_owned(),
        title: "Joint error".to_owned(),
        reading: "Distance from the true joints: the mean over all, and single ends of limbs dashed.".to_owned(),
        from_zero: true,
        series: series.collect(),
        ..time.plot("distance, m")
    }
}

fn angles(track: &Table, name: &str, starts: &[&str], time: &Time) -> Plot {
    let belongs = |column: &&String| column.ends_with("_rad") && starts.iter().any(|start| column.starts_with(start));
    let columns = track.columns.iter().filter(belongs).enumerate();
    let series = columns.map(|(index, column)| Series {
        y_times: DEGREES,
        breaks: Some(180.0),
        ..time.series(track, column, &words(column.trim_end_matches("_rad")), Colour::nth(index))
    });
    Plot {
        id: format!("body angles {name}"),
        group: "Joint angles".to_owned(),
        title: format!("Angles of the {name}"),
        reading: "Always inside the joints' limits; zero is someone who stands upright with the arms down.".to_owned(),
        series: series.collect(),
        ..time.plot("angle, degrees")
    }
}

fn spread(track: &Table, time: &Time) -> Plot {
    Plot {
        id: "body spread".to_owned(),
        title: "Spread of the ends".to_owned(),
        reading:
            "Standard deviation of head, wrists and ankles over the particles; it grows where no points show them."
                .to_owned(),
        ..of_ends(track, time, "spread_m", "standard deviation, m")
    }
}

fn ambiguous(track: &Table, time: &Time) -> Plot {
    Plot {
        id: "body ambiguous".to_owned(),
        title: "Ends that may be elsewhere".to_owned(),
        reading: "Weight of the particles that put head, wrists or ankles more than 10 cm from the estimate."
            .to_owned(),
        ..of_ends(track, time, "ambiguous", "share of the weight")
    }
}

/// The columns `name` of head, wrists and ankles.
fn of_ends(track: &Table, time: &Time, name: &str, y_label: &str) -> Plot {
    let series = ENDS
        .iter()
        .enumerate()
        .map(|(index, end)| time.series(track, &format!("{end}_{name}"), &words(end), Colour::nth(index)));
    Plot {
        group: "How sure the tracker was".to_owned(),
        from_zero: true,
        series: series.collect(),
        ..time.plot(y_label)
    }
}
