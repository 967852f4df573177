//! Plots of a cyclic motion: over time, and over the cycle.

use super::document::{Band, Colour, Plot, Series, Shade, Style};
use super::series::{DEGREES, select};
use super::table::Table;

/// Half width of a normal's 90 % band, standard deviations.
const HALF_90: f64 = 1.644_853_626_951;
/// Angles of the stick figure that share a plot.
const GROUPS: [(&str, &[&str]); 5] = [
    ("trunk and links", &["neck", "l_shoulder", "r_shoulder", "l_hip", "r_hip"]),
    ("left arm", &["l_elbow", "l_wrist"]),
    ("right arm", &["r_elbow", "r_wrist"]),
    ("left leg", &["l_knee", "l_ankle"]),
    ("right leg", &["r_knee", "r_ankle"]),
];
/// Flexions that both sides have.
const PAIRS: [&str; 4] = ["shoulder_flexion", "elbow_flexion", "hip_flexion", "knee_flexion"];

/// The tables over time, and how their frames become time.
struct OverTime<'a> {
    estimates: &'a Table,
    measured: Option<&'a Table>,
    seconds: Option<f64>,
}

impl OverTime<'_> {
    fn series(&self, table: &Table, column: &str, name: &str, colour: Colour) -> Series {
        let x_times = self.seconds.unwrap_or(1.0);
        Series { name: name.to_owned(), x_times, colour, ..select(table, "frame", column) }
    }

    /// The band that holds 90 %, from a column of standard deviations.
    fn band(&self, column: &str) -> Option<Band> {
        self.estimates.has(column).then(|| Band::Around { half: column.to_owned(), times: HALF_90 })
    }

    fn plot(&self, id: &str, title: &str, y_label: &str, series: Vec<Series>) -> Plot {
        let outliers = Shade {
            name: "outlier".to_owned(),
            table: self.estimates.name.clone(),
            x: "frame".to_owned(),
            x_times: self.seconds.unwrap_or(1.0),
            only: vec![["outlier".to_owned(), "1".to_owned()]],
        };
        let has_outliers = self.estimates.rows.iter().any(|row| self.estimates.cell(row, "outlier") == "1");
        Plot {
            id: format!("cyclic {id}"),
            group: "The cycle".to_owned(),
            title: title.to_owned(),
            x_label: if self.seconds.is_some() { "time, s" } else { "frame" }.to_owned(),
            y_label: y_label.to_owned(),
            over_frames: true,
            series,
            shades: if has_outliers { vec![outliers] } else { Vec::new() },
            ..Plot::default()
        }
    }

    fn cadence(&self) -> Plot {
        let line = self.series(self.estimates, "cadence_per_min", "cadence", Colour::C0);
        let series = vec![Series { band: self.band("cadence_std_per_min"), ..line }];
        let reading = "Cycles a minute: two steps of a walker are one cycle. A flat line with a narrow 90 % band says that the phase was found.";
        Plot { reading: reading.to_owned(), ..self.plot("cadence", "Cadence", "cadence, cycles a minute", series) }
    }

    fn position(&self) -> Plot {
        let line = self.series(self.estimates, "cycle_position", "position", Colour::C2);
        let series = vec![Series { breaks: Some(0.5), ..line }];
        let reading = "A saw-tooth; even teeth are an even gait, a jump is a lost place.";
        Plot {
            reading: reading.to_owned(),
            ..self.plot("position", "Position in the cycle", "position, cycles", series)
        }
    }

    fn likelihood(&self) -> Plot {
        let series = vec![self.series(self.estimates, "log_likelihood", "log-likelihood", Colour::C3)];
        let reading = "How well the model explained each measured row; a dip is a row that it did not expect.";
        Plot { reading: reading.to_owned(), ..self.plot("likelihood", "Log-likelihood", "natural logarithm", series) }
    }

    fn angles(&self, name: &str, angles: &[&str]) -> Plot {
        let mut all = Vec::new();
        for (index, angle) in angles.iter().enumerate() {
            let (column, words) = (format!("{angle}_rad"), angle.replace('_', " "));
            let line = self.series(self.estimates, &column, &words, Colour::nth(index));
            all.push(Series { y_times: DEGREES, band: self.band(&format!("{angle}_std_rad")), ..line });
            if let Some(measured) = self.measured.filter(|measured| measured.has(&column)) {
                let dots = self.series(measured, &column, &format!("{words}, measured"), Colour::nth(index));
                all.push(Series { y_times: DEGREES, style: Style::Dots, ..dots });
            }
        }
        let title = format!("Angles of the stick figure: {name}");
        Plot {
            group: "Angles with their bands".to_owned(),
            reading: "Lines are the estimate, bands hold 90 % of what it may be, dots are what was measured."
                .to_owned(),
            ..self.plot(&format!("angles {name}"), &title, "angle, degrees", all)
        }
    }
}

/// Plots of the estimates over time, or over frames where the rate is not known.
#[must_use]
pub fn estimate_plots(estimates: &Table, measured: Option<&Table>, rate_hz: Option<f64>) -> Vec<Plot> {
    let seconds = rate_hz.filter(|rate| *rate > 0.0).map(|rate| 1.0 / rate);
    let over_time = OverTime { estimates, measured, seconds };
    let mut plots = vec![over_time.cadence(), over_time.position(), over_time.likelihood()];
    plots.extend(GROUPS.iter().map(|(name, angles)| over_time.angles(name, angles)));
    for plot in &mut plots {
        plot.series
            .retain(|series| series.table != estimates.name || (estimates.has("frame") && estimates.has(&series.y)));
    }
    plots.retain(|plot| !plot.series.is_empty());
    plots
}

/// Plots over the cycle, of angle against velocity, and of ranges.
#[must_use]
pub fn cycle_plots(curves: Option<&Table>, anatomical: Option<&Table>, repetitions: Option<&Table>) -> Vec<Plot> {
    let mut plots = Vec::new();
    for pair in PAIRS {
        plots.extend(curves.and_then(|curves| {
            cycle_curve(curves, pair, &[(format!("l_{pair}"), "left"), (format!("r_{pair}"), "right")])
        }));
    }
    plots.extend(curves.and_then(|curves| cycle_curve(curves, "trunk_lean", &[("trunk_lean".to_owned(), "trunk")])));
    plots.extend(anatomical.map(knee_against_hip));
    plots.extend(repetitions.map(tempo));
    plots.retain(|plot| !plot.series.is_empty());
    plots
}

fn cycle_curve(curves: &Table, name: &str, angles: &[(String, &str)]) -> Option<Plot> {
    let series =
        angles.iter().filter(|(angle, _)| curves.has(&format!("{angle}_mean_deg"))).map(|(angle, side)| Series {
            name: (*side).to_owned(),
            band: Some(Band::Around { half: format!("{angle}_std_deg"), times: 1.0 }),
            colour: Colour::of_side(side),
            ..select(curves, "percent", &format!("{angle}_mean_deg"))
        });
    let series: Vec<Series> = series.collect();
    let with_values = |series: &Series| curves.rows.iter().any(|row| curves.number(row, &series.y).is_some());
    series.iter().any(with_values).then(|| Plot {
        id: format!("cycle {name}"),
        group: "Over the cycle".to_owned(),
        title: format!("{} over the cycle", capital(&name.replace('_', " "))),
        reading: "Mean over the cycles with one standard deviation to each side; a band wider than the difference leaves it open.".to_owned(),
        x_label: "cycle, %".to_owned(),
        y_label: "angle, degrees".to_owned(),
        series,
        ..Plot::default()
    })
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn knee_against_hip(anatomical: &Table) -> Plot {
    let series =
        ["l", "r"].iter().filter(|side| anatomical.has(&format!("{side}_knee_flexion_deg"))).map(|side| Series {
            name: if *side == "l" { "left" } else { "right" }.to_owned(),
            colour: Colour::of_side(&format!("{side}_")),
            ..select(anatomical, &format!("{side}_hip_flexion_deg"), &format!("{side}_knee_flexion_deg"))
        });
    Plot {
        id: "cycle knee and hip".to_owned(),
        group: "Over the cycle".to_owned(),
        title: "Knee against hip".to_owned(),
        reading: "One loop a cycle; loops that lie on each other are a steady gait.".to_owned(),
        x_label: "hip flexion, degrees".to_owned(),
        y_label: "knee flexion, degrees".to_owned(),
        over_frames: true,
        pairs: true,
        series: series.collect(),
        ..Plot::default()
    }
}

fn tempo(repetitions: &Table) -> Plot {
    Plot {
        id: "cycle tempo".to_owned(),
        group: "Over the cycle".to_owned(),
        title: "Tempo of each repetition".to_owned(),
        reading: "From one passage of position 0 to the next.".to_owned(),
        x_label: "repetition".to_owned(),
        y_label: "tempo, cycles a minute".to_owned(),
        series: vec![Series {
            name: "tempo".to_owned(),
            style: Style::Points,
            colour: Colour::C0,
            ..select(repetitions, "repetition", "tempo_per_min")
        }],
        ..Plot::default()
    }
}
