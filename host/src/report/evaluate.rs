//! Pages of `sinew evaluate arm`, `body` and `cyclic`: errors against particles, noise and options.

use super::document::{Band, Colour, Fact, Level, Plot, Run, Series, Style};
use super::facts::{facts_of, options_table, text};
use super::folder::RunFolder;
use super::series::{only, select};
use super::table::Table;
use serde_json::Value;

/// Version of all three records that is known here.
const VERSION: u64 = 1;
const QUARTILES: &str =
    "Median over the runs of a run's mean error; the band goes from the lower to the upper quartile.";

/// The evaluation of arm trackers in `folder`.
pub fn evaluate_arm_run(mut folder: RunFolder) -> Run {
    let mut run = start(&folder, "Evaluation of the arm trackers");
    let report = record(&mut run, &mut folder, "arm.json");
    let scenes = report["scenes"].as_array().map(|scenes| Fact::new("Scenes", scenes.len().to_string()));
    run.facts.extend(scenes);
    run.facts.extend(facts_of(&report, &[("frames", "Frames of each scene")]));
    let share = |field: &str| Some(format!("{:.0} %", 100.0 * report["recovery"][field].as_f64()?));
    run.highlights.extend(share("without_false_blob").map(|value| Fact::new("Recovered in time", value)));
    run.highlights
        .extend(share("with_false_blob").map(|value| Fact::new("Recovered in time beside a false blob", value)));
    for (field, title) in [
        ("variants", "Errors of the trackers against particles"),
        ("options", "Each option's own effect"),
        ("as_printed", "The trackers as the arm paper prints them"),
    ] {
        let table = spread_table(field, title, &report[field]);
        if table.rows.is_empty() {
            continue;
        }
        for (unit, long) in [("m", "in space"), ("px", "in the image")] {
            let middle = format!("error_{unit}_median");
            let band = Some(Band::Between { low: format!("error_{unit}_lower"), high: format!("error_{unit}_upper") });
            run.plots.push(if field == "variants" {
                let each = |tracker: &String| Series {
                    only: only("tracker", tracker),
                    band: band.clone(),
                    ..select(&table, "particles", &middle)
                };
                against_particles(
                    &format!("evaluate arm {unit}"),
                    &format!("Hand error {long}"),
                    &format!("error, {unit}"),
                    QUARTILES,
                    named(&table, "tracker", each),
                )
            } else {
                let bars =
                    Series { name: title.to_owned(), style: Style::Bars, band, ..select(&table, "what", &middle) };
                Plot {
                    id: format!("evaluate arm {field} {unit}"),
                    group: title.to_owned(),
                    title: format!("{title}, {long}"),
                    reading: QUARTILES.to_owned(),
                    y_label: format!("error, {unit}"),
                    series: vec![bars],
                    ..Plot::default()
                }
            });
        }
        run.tables.push(table);
    }
    run.tables.extend(folder.table("arm.csv", "Errors of every run"));
    run.notices = folder.into_notices();
    run
}

/// A measure of the motion models.
struct Measure {
    column: &'static str,
    title: &'static str,
    y_label: &'static str,
    /// Column of the half width of the band.
    half: Option<&'static str>,
    reading: &'static str,
}

const MEASURES: [Measure; 5] = [
    Measure {
        column: "error_m",
        title: "Error on the skin",
        y_label: "error, m",
        half: Some("error_ci95_m"),
        reading: "Mean distance of the markers from the skin; the band is the 95 % confidence interval of the mean over the trials.",
    },
    Measure {
        column: "joint_error_m",
        title: "Error at the joints",
        y_label: "error, m",
        half: None,
        reading: "Mean distance of the joints from the true ones.",
    },
    Measure {
        column: "lost_joint_share",
        title: "Lost joints",
        y_label: "share of frames",
        half: None,
        reading: "Share of the frames that have a joint more than 10 cm off.",
    },
    Measure {
        column: "smoothness_m",
        title: "Smoothness",
        y_label: "mean step of a marker, m",
        half: None,
        reading: "How far markers move from frame to frame; more than the truth's (dashed) is jitter.",
    },
    Measure {
        column: "seconds_per_frame",
        title: "Time",
        y_label: "time, s a frame",
        half: None,
        reading: "The tracker's step alone, on the machine of the run.",
    },
];

/// The comparison of motion models in `folder`.
pub fn evaluate_body_run(mut folder: RunFolder) -> Run {
    let mut run = start(&folder, "Evaluation of the body's motion models");
    let report = record(&mut run, &mut folder, "report.json");
    run.facts.extend(facts_of(&report, &[("trials", "Trials of each cell"), ("threads", "Threads")]));
    if let Some(table) = folder.table("table.csv", "Errors, smoothness and time of each model and number of particles")
    {
        for motion in table.distinct("motion") {
            let measures = MEASURES.iter().filter(|measure| table.has(measure.column));
            run.plots.extend(measures.map(|measure| body_plot(&table, &motion, measure)));
        }
        run.tables.push(table);
    }
    if !report["tuning"].is_null() {
        run.tables.push(options_table("tuning", &report["tuning"]));
    }
    run.notices = folder.into_notices();
    run
}

/// A line for each model.
fn body_plot(table: &Table, motion: &str, measure: &Measure) -> Plot {
    let column = measure.column;
    let half = measure.half.filter(|half| table.has(half));
    let of_motion = |model: &String| {
        let only = [("motion", motion), ("model", model)].map(|(name, value)| [name.to_owned(), value.to_owned()]);
        let band = half.map(|half| Band::Around { half: half.to_owned(), times: 1.0 });
        Series { only: only.to_vec(), band, ..select(table, "particles", column) }
    };
    let mut series = named(table, "model", of_motion);
    if column == "smoothness_m" && table.has("truth_smoothness_m") {
        let truth = Series { only: only("motion", motion), ..select(table, "particles", "truth_smoothness_m") };
        series.push(Series { style: Style::Dashes, colour: Colour::Middle, ..truth }.called("truth".to_owned()));
    }
    let title = format!("{}: {motion}", measure.title);
    against_particles(&format!("evaluate body {column} {motion}"), &title, measure.y_label, measure.reading, series)
}

/// The tables and figures of the cyclic paper in `folder`.
pub fn evaluate_cyclic_run(mut folder: RunFolder) -> Run {
    let mut run = start(&folder, "Evaluation of the cyclic filters");
    let report = record(&mut run, &mut folder, "cyclic.json");
    let facts = [
        ("model", "Motion model"),
        ("test", "Tested on"),
        ("cycles", "Cycles"),
        ("frames", "Frames"),
        ("seeds", "Seeds"),
    ];
    run.facts.extend(facts_of(&report, &facts));
    if let Some(table) = folder.table("cyclic.csv", "Mean absolute errors over 13 angles") {
        for protocol in table.distinct("protocol") {
            run.plots.extend(noise_plot(&table, &protocol));
        }
        let start_of = |start: &String| {
            let only = [["table".to_owned(), "figure-5b".to_owned()], ["start".to_owned(), start.clone()]];
            Series { only: only.to_vec(), ..select(&table, "particles", "error_deg") }
        };
        let reading = "The particle filter by what it knows of the first frame: more particles help until they do not.";
        run.plots.push(against_particles(
            "evaluate cyclic particles",
            "Error against particles",
            "mean error, degrees",
            reading,
            named(&table, "start", start_of),
        ));
        run.tables.push(table);
    }
    run.plots.retain(|plot| !plot.series.is_empty());
    let long_runs = &report["long_runs"];
    if long_runs.as_array().is_some_and(|list| !list.is_empty()) {
        run.tables.push(super::other::list_table("long_runs", "Recordings without a break", long_runs));
    }
    run.notices = folder.into_notices();
    run
}

fn start(folder: &RunFolder, kind: &str) -> Run {
    Run { name: folder.path().display().to_string(), kind: kind.to_owned(), ..Run::default() }
}

/// The record of an evaluation, with the facts that all have.
fn record(run: &mut Run, folder: &mut RunFolder, name: &str) -> Value {
    let report = folder.json(name).unwrap_or_default();
    if !report.is_null() {
        folder.check_version(name, &report, VERSION);
        if report["format"].as_str().is_none() {
            folder.notice(Level::Warning, format!("{name} does not say what it is (`format`)"));
        }
        run.facts = facts_of(&report, &[("sinew_version", "Version")]);
    }
    report
}

/// A row for each entry of a list of errors with quartiles.
fn spread_table(name: &str, title: &str, list: &Value) -> Table {
    let mut columns = vec!["tracker".to_owned(), "particles".to_owned(), "what".to_owned()];
    let parts: Vec<(&str, &str)> = ["error_m", "error_px"]
        .into_iter()
        .flat_map(|error| ["lower", "median", "upper"].map(|part| (error, part)))
        .collect();
    columns.extend(parts.iter().map(|(error, part)| format!("{error}_{part}")));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    let mut table = Table::new(name, title, &columns);
    for one in list.as_array().into_iter().flatten() {
        let (tracker, particles) = (text(&one["name"]), text(&one["particles"]));
        let what = format!("{tracker}, {particles} particles");
        let mut cells = vec![tracker, particles, what];
        cells.extend(
            parts
                .iter()
                .map(|(error, part)| one[error][part].as_f64().map_or_else(String::new, |value| format!("{value:.5}"))),
        );
        table.rows.push(cells);
    }
    table
}

/// A series for each of the different names in a column.
fn named(table: &Table, column: &str, series: impl Fn(&String) -> Series) -> Vec<Series> {
    let has_rows = |one: &Series| {
        let fits = |row: &&Vec<String>| one.only.iter().all(|[name, value]| table.cell(row, name) == value);
        table.rows.iter().filter(fits).any(|row| table.number(row, &one.y).is_some())
    };
    let all = table.distinct(column).into_iter().enumerate();
    all.map(|(index, name)| Series { colour: Colour::nth(index), style: Style::Points, ..series(&name) }.called(name))
        .filter(has_rows)
        .collect()
}

impl Series {
    fn called(self, name: String) -> Self {
        Self { name, ..self }
    }
}

fn against_particles(id: &str, title: &str, y_label: &str, reading: &str, series: Vec<Series>) -> Plot {
    Plot {
        id: id.to_owned(),
        group: "Against particles".to_owned(),
        title: title.to_owned(),
        reading: reading.to_owned(),
        x_label: "particles".to_owned(),
        y_label: y_label.to_owned(),
        x_log: true,
        from_zero: true,
        series,
        ..Plot::default()
    }
}

fn noise_plot(table: &Table, protocol: &str) -> Option<Plot> {
    let of = |name: &str, filter: &String| {
        let only = [("table", name), ("protocol", protocol), ("filter", filter)]
            .map(|(column, value)| [column.to_owned(), value.to_owned()]);
        Series { only: only.to_vec(), ..select(table, "sigma_deg", "error_deg") }
    };
    let mut series = named(table, "filter", |filter| of("table-1", filter));
    let smoothed = named(table, "filter", |filter| of("smoothed", filter));
    series.extend(smoothed.into_iter().map(|one| {
        let name = format!("{} --smooth", one.name);
        Series { style: Style::Dashes, ..one }.called(name)
    }));
    (!series.is_empty()).then(|| Plot {
        id: format!("evaluate cyclic noise {protocol}"),
        group: "Against noise".to_owned(),
        title: format!("Error against noise: {protocol}"),
        reading: "Mean absolute error over 13 angles against the noise that the filter assumes.".to_owned(),
        x_label: "sigma, degrees".to_owned(),
        y_label: "mean error, degrees".to_owned(),
        x_log: true,
        from_zero: true,
        series,
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn errors_with_quartiles_become_rows() {
        let spread = json!({"lower": 0.1, "median": 0.2, "upper": 0.3});
        let list =
            json!([{"name": "pik", "particles": 50, "error_m": spread, "error_px": {"median": 7.0}}, {"name": "x"}]);
        let table = spread_table("variants", "", &list);
        assert_eq!(
            table.rows[0],
            ["pik", "50", "pik, 50 particles", "0.10000", "0.20000", "0.30000", "", "7.00000", ""]
        );
        assert_eq!(table.rows[1], ["x", "", "x,  particles", "", "", "", "", "", ""]);
        let series = named(&table, "tracker", |tracker| Series {
            only: only("tracker", tracker),
            ..select(&table, "particles", "error_m_median")
        });
        assert_eq!(series.iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["pik"]);
    }
}
