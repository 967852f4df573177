//! Plots of a tracked arm.

use super::document::{Band, Colour, Plot, Series, Shade, Style};
use super::series::{DEGREES, only, select};
use super::table::Table;

/// Columns that plots and player need.
pub const PLOTTED: [&str; 15] = [
    "frame",
    "side",
    "status",
    "time_s",
    "hand_u_px",
    "hand_v_px",
    "hand_x_m",
    "hand_y_m",
    "hand_z_m",
    "elevation_rad",
    "hand_likelihood",
    "effective_sample_size",
    "hand_std_m",
    "log_evidence",
    "blob_count",
];

/// Columns that are drawn over time, one line a side: column, title, y axis, how to read it.
const OVER_TIME: [(&str, &str, &str, &str); 5] = [
    (
        "hand_likelihood",
        "Hand likelihood",
        "likelihood, 0 to 1",
        "How much the blob that carries the estimate looks like a hand; 0 where there was none.",
    ),
    (
        "effective_sample_size",
        "Effective sample size",
        "particles",
        "How many particles share the weight; near 1 the estimate hangs on a single one.",
    ),
    (
        "hand_std_m",
        "Spread of the hand",
        "standard deviation, m",
        "How far apart the particles put the hand; it grows while the hand is not seen.",
    ),
    (
        "log_evidence",
        "Log evidence",
        "natural logarithm",
        "How well the particles explained the frame; a drop marks a surprise.",
    ),
    ("blob_count", "Skin blobs", "blobs in the frame", "What the estimate had to choose from."),
];
const ANGLES: [&str; 4] = ["elevation_rad", "deviation_rad", "rotation_rad", "flexion_rad"];

/// All plots of a track, with the truth where there is one.
#[must_use]
pub fn arm_plots(track: &Table, truth: Option<&Table>, error: Option<&Table>, size_px: Option<[f64; 2]>) -> Vec<Plot> {
    let sides = track.distinct("side");
    let mut plots = vec![path(track, truth, &sides, size_px)];
    for side in &sides {
        plots.push(space(track, truth, side));
    }
    if let Some(error) = error.filter(|error| !error.rows.is_empty()) {
        plots.extend(errors(track, error, &sides));
    }
    for side in &sides {
        plots.push(angles(track, side));
    }
    plots.extend(OVER_TIME.map(|(column, title, y_label, reading)| Plot {
        id: format!("arm {column}"),
        title: title.to_owned(),
        reading: reading.to_owned(),
        from_zero: column != "log_evidence",
        series: sides.iter().map(|side| of_side(track, side, column)).collect(),
        ..over_time(track, &sides, "How sure the tracker was", y_label)
    }));
    for plot in &mut plots {
        plot.series.retain(|series| series.table != track.name || (track.has(&series.x) && track.has(&series.y)));
    }
    plots.retain(|plot| !plot.series.is_empty());
    plots
}

/// A plot over time whose ground is shaded where the hand was not seen.
fn over_time(track: &Table, sides: &[String], group: &str, y_label: &str) -> Plot {
    let shade = |side: &String, status: &str| Shade {
        name: if sides.len() > 1 { format!("{status}, {side}") } else { status.to_owned() },
        table: track.name.clone(),
        x: "time_s".to_owned(),
        x_times: 1.0,
        only: vec![["side".to_owned(), side.clone()], ["status".to_owned(), status.to_owned()]],
    };
    let known = |shade: &Shade| {
        track.rows.iter().any(|row| shade.only.iter().all(|[name, value]| track.cell(row, name) == value))
    };
    Plot {
        group: group.to_owned(),
        x_label: "time, s".to_owned(),
        y_label: y_label.to_owned(),
        over_frames: true,
        shades: sides
            .iter()
            .flat_map(|side| ["uncertain", "predicted", "lost"].map(|status| shade(side, status)))
            .filter(known)
            .collect(),
        ..Plot::default()
    }
}

fn of_side(table: &Table, side: &str, column: &str) -> Series {
    Series {
        name: side.to_owned(),
        only: only("side", side),
        colour: Colour::of_side(side),
        ..select(table, "time_s", column)
    }
}

fn path(track: &Table, truth: Option<&Table>, sides: &[String], size_px: Option<[f64; 2]>) -> Plot {
    let mut series = Vec::new();
    for side in sides {
        if let Some(truth) = truth {
            let true_path = Series { x: "hand_u_px".to_owned(), ..of_side(truth, side, "hand_v_px") };
            series.push(Series { name: format!("{side}, truth"), style: Style::Dashes, ..true_path });
        }
        series.push(Series { x: "hand_u_px".to_owned(), style: Style::Points, ..of_side(track, side, "hand_v_px") });
    }
    Plot {
        id: "arm path".to_owned(),
        group: "The hand".to_owned(),
        title: "Hand path in the image".to_owned(),
        reading: "Where the hand went, as the camera sees it; the frame of the player is marked.".to_owned(),
        x_label: "u, px".to_owned(),
        y_label: "v, px".to_owned(),
        image_axes: true,
        over_frames: true,
        bounds: size_px.map(|[width, height]| [0.0, 0.0, width, height]),
        series,
        ..Plot::default()
    }
}

fn space(track: &Table, truth: Option<&Table>, side: &str) -> Plot {
    let mut series = Vec::new();
    for (index, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let column = format!("hand_{axis}_m");
        if let Some(truth) = truth {
            let true_axis = of_side(truth, side, &column);
            let name = format!("{axis}, truth");
            series.push(Series { name, colour: Colour::nth(index), style: Style::Dashes, ..true_axis });
        }
        let band = track.has("hand_std_m").then(|| Band::Around { half: "hand_std_m".to_owned(), times: 1.0 });
        series.push(Series {
            name: axis.to_owned(),
            colour: Colour::nth(index),
            band,
            ..of_side(track, side, &column)
        });
    }
    Plot {
        id: format!("arm space {side}"),
        title: format!("The {side} hand in space"),
        reading: "Camera axes: x right, y down, z away from the camera. The band is the spread of the particles to each side.".to_owned(),
        series,
        ..over_time(track, &[side.to_owned()], "The hand", "place, m")
    }
}

fn angles(track: &Table, side: &str) -> Plot {
    let series = ANGLES.into_iter().enumerate().map(|(index, column)| Series {
        name: column.trim_end_matches("_rad").to_owned(),
        colour: Colour::nth(index),
        y_times: DEGREES,
        breaks: Some(180.0),
        ..of_side(track, side, column)
    });
    Plot {
        id: format!("arm angles {side}"),
        title: format!("Joint angles of the {side} arm"),
        reading:
            "Three angles of the shoulder and the bend of the elbow; the ground is shaded where the hand was not seen."
                .to_owned(),
        series: series.collect(),
        ..over_time(track, &[side.to_owned()], "The arm", "angle, degrees")
    }
}

fn errors(track: &Table, error: &Table, sides: &[String]) -> Vec<Plot> {
    let plot = |column: &str, title: &str, y_label: &str| Plot {
        id: format!("arm {column}"),
        title: title.to_owned(),
        reading: "Distance of the tracked hand from the true one; zero would be perfect.".to_owned(),
        from_zero: true,
        series: sides.iter().map(|side| of_side(error, side, column)).collect(),
        ..over_time(track, sides, "The hand", y_label)
    };
    vec![plot("error_m", "Error in space", "distance, m"), plot("error_px", "Error in the image", "distance, px")]
}
