//! The cyclic paper: tables 1 and 2, figures 3 to 5, on walkers.

use super::page::{Page, Row, Section};
use super::plot::{Plot, Series};
use super::{Made, Material, compared, of_trend, printed, seeds};
use crate::cyclic::experiments::{Cell, Setting};
use crate::cyclic::figures::trajectories;
use crate::cyclic::{Protocol, TestCycle, rate_of, test_cycles};
use anyhow::Result;
use sinew::cyclic::CutList;
use sinew::cyclic::angle_table::COLUMNS;
use sinew::cyclic::tracking::{FilterName, StartName};
use sinew::cyclic::training::{TrainingOptions, train};
use sinew::draw::plot::Curve;
use sinew::resume::Cells;

/// Most samples of a quick run.
const QUICK_SAMPLES: usize = 10_000;
/// Samples of figure 5a, as in the paper.
const SPARSE_SAMPLES: [usize; 2] = [10_000, 50_000];
/// The paper's people are swimmers.
const OTHER_MOTION: &str = "The motion is another one: the paper's swimmers are not public, and these people walk.";
/// Angles of upper arms and forearms.
const ARMS: [usize; 4] = [2, 3, 5, 6];
/// Angles of thighs and shanks.
const LEGS: [usize; 4] = [8, 9, 11, 12];

/// Everything of the page.
///
/// # Errors
/// Recordings that are missing; a run that fails.
pub fn make(material: Material<'_>, cells: &Cells<'_>) -> Result<Made> {
    let folder = material.data.join("cyclic-walking");
    let list = CutList::read(&folder.join("train_cuts.csv"))?;
    let rate_hz = rate_of(&list, None)?;
    let model = train(&list, TrainingOptions { rate_hz: Some(rate_hz), ..TrainingOptions::default() })?;
    let cycles = test_cycles(&CutList::read(&folder.join("test_cuts.csv"))?)?;
    let seeds = seeds(material.is_quick, 10);
    let setting = Setting { cycles: &cycles, model: &model, rate_hz, seeds, cells };
    let most = material.max_particles.min(if material.is_quick { QUICK_SAMPLES } else { usize::MAX });
    let at_most = |all: &'static [usize]| &all[..all.partition_point(|&count| count <= most)];
    let (samples, sparse) = (at_most(&printed::CYCLIC_SAMPLES), at_most(&SPARSE_SAMPLES));
    let mut made = Made::default();
    let page = &mut made.page;
    page.title = "Cyclic paper: a kinematic model for Bayesian tracking of cyclic human motion".into();
    if material.is_quick {
        page.left_out.push(format!("seeds 3 to 10; spread is that of {seeds} seeds and {} cycles", cycles.len()));
    }
    if samples.len() < printed::CYCLIC_SAMPLES.len() {
        page.left_out.push(format!("more than {most} samples in table 2 and figures 5a and 5b"));
    }
    let training = test_cycles(&list)?;
    table_1(&setting, &training, page, &mut made.plots)?;
    figure_3(&setting, page, &mut made.plots)?;
    figure_4a(&setting, page)?;
    figure_4b(&setting, page, &mut made.plots)?;
    table_2(&setting, samples, page)?;
    figures_5(&setting, (sparse, samples), page, &mut made.plots)?;
    Ok(made)
}

fn walkers(setting: &Setting<'_>) -> String {
    let frames: usize = setting.cycles.iter().map(|cycle| cycle.truth.rows().len()).sum();
    format!(
        "{} cycles, {frames} frames of walkers who were not trained on; ten training cycles. Mean absolute error over \
         13 angles, degrees. {} seeds where noise or samples are drawn.",
        setting.cycles.len(),
        setting.seeds
    )
}

fn table_1(
    setting: &Setting<'_>,
    training: &[TestCycle],
    page: &mut Page,
    plots: &mut Vec<(String, Plot)>,
) -> Result<()> {
    let cells = setting.noise_table()?;
    let paper = printed::CYCLIC_TABLE_1_DEG[0];
    let of = |filter: FilterName, protocol: Protocol| {
        cells.iter().filter(move |c| c.filter == filter && c.protocol == protocol)
    };
    let rows = of(FilterName::Paper, Protocol::ExactMean).zip(paper).map(|(cell, paper)| {
        let (paper, ours, difference) = compared(paper, cell.error_deg, 2);
        let what = format!("sigma {} degrees, test set 1, filter `paper`", cell.sigma_deg.round());
        Row { what, paper, ours: format!("{ours} +- {:.2}", cell.cycle_std_deg), difference }
    });
    let mut table = vec![["filter", "protocol", "1", "3", "6", "29", "57", "115"].map(String::from).to_vec()];
    for protocol in [Protocol::ExactMean, Protocol::Noisy] {
        for filter in [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled] {
            let mut row = vec![filter.name().to_owned(), protocol.name().to_owned()];
            row.extend(of(filter, protocol).map(|cell| format!("{:.2} +- {:.2}", cell.error_deg, cell.cycle_std_deg)));
            table.push(row);
        }
        let mut row = vec!["paper, covariance by k^2 as worded".to_owned(), protocol.name().to_owned()];
        let worded = setting.worded(protocol)?;
        row.extend(worded.iter().map(|cell| format!("{:.2} +- {:.2}", cell.error_deg, cell.cycle_std_deg)));
        table.push(row);
    }
    table.extend(crate::cyclic::baselines::rows(setting, training)?);
    let mut plot = Plot {
        title: "Table 1: error against the noise that the filter assumes (exact-mean)".into(),
        x_label: "sigma, degrees (logarithmic)".into(),
        y_label: "mean absolute error, degrees".into(),
        log_x: true,
        bars: "one standard deviation over test cycles".into(),
        series: Vec::new(),
    };
    for (name, values) in [("paper's test set 1", paper), ("paper's test set 2", printed::CYCLIC_TABLE_1_DEG[1])] {
        let points = printed::CYCLIC_SIGMAS_DEG.into_iter().zip(values).map(|(x, y)| (x, y, 0.0)).collect();
        plot.series.push(Series { name: name.into(), points });
    }
    for filter in [FilterName::Paper, FilterName::PaperCut, FilterName::Coupled] {
        let points = of(filter, Protocol::ExactMean).map(|c| (c.sigma_deg, c.error_deg, c.cycle_std_deg)).collect();
        plot.series.push(Series { name: format!("ours, {}", filter.name()), points });
    }
    plots.push(("table_1.svg".into(), plot));
    page.sections.push(Section {
        id: "table-1",
        title: "Table 1: error against measurement noise".into(),
        material: format!("{} +- is one standard deviation over cycles.", walkers(setting)),
        rows: rows.collect(),
        reason: format!(
            "{OTHER_MOTION} In exact-mean the measurement is the true angle, so raw measurements have no error: the \
             protocol rewards a filter that ignores sigma."
        ),
        table,
        pictures: vec!["table_1.svg".into()],
    });
    Ok(())
}

fn figure_3(setting: &Setting<'_>, page: &mut Page, plots: &mut Vec<(String, Plot)>) -> Result<()> {
    let (mut pictures, mut off_deg) = (Vec::new(), [0.0; 2]);
    for (name, column) in [("left foot", "l_ankle_rad"), ("left hand", "l_wrist_rad")] {
        let angle = COLUMNS[1..].iter().position(|other| *other == column).unwrap_or_default();
        let curves = trajectories(setting, angle)?;
        off_deg[pictures.len()] = distance_deg(&curves, FilterName::Paper.name());
        let series = curves
            .into_iter()
            .map(|curve| Series { name: curve.name, points: curve.points.iter().map(|(x, y)| (*x, *y, 0.0)).collect() })
            .collect();
        let file = format!("figure_3_{}.svg", name.replace(' ', "_"));
        let plot = Plot {
            title: format!("Figure 3: {name}, two cycles, sigma 6 degrees (noisy)"),
            x_label: "frame of 1/60 s".into(),
            y_label: "angle of the segment, degrees".into(),
            series,
            ..Plot::default()
        };
        plots.push((file.clone(), plot));
        pictures.push(file);
    }
    page.sections.push(Section {
        title: "Figure 3: true and estimated angles of the left foot and hand".into(),
        material: "The first two test cycles, one after the other. Angles are those of the segments that end at ankle and wrist.".into(),
        rows: vec![Row {
            what: "trend".into(),
            paper: "estimates follow the truth closely and are smooth".into(),
            ours: format!("`paper` is {:.1} and {:.1} degrees off on the mean, measurements 4.8", off_deg[0], off_deg[1]),
            // The mean distance of normal noise with a standard deviation of 6 degrees.
            difference: of_trend(off_deg.into_iter().all(|off_deg| off_deg < 4.8)),
        }],
        pictures,
        ..Section::default()
    });
    Ok(())
}

/// Mean distance of the curve `name` from that of the truth, degrees.
fn distance_deg(curves: &[Curve], name: &str) -> f64 {
    let of = |name: &str| curves.iter().find(|curve| curve.name == name).map_or(&[][..], |curve| &curve.points);
    let (found, truth) = (of(name), of("truth"));
    found.iter().zip(truth).map(|(a, b)| (a.1 - b.1).abs()).sum::<f64>() / truth.len().max(1) as f64
}

/// Curves over the number of frames a measurement, one a filter or number of samples.
fn by_skip<'a>(cells: impl Iterator<Item = &'a Cell>) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for cell in cells {
        let Some(skip) = cell.updates.strip_prefix("every ").and_then(|text| text.parse::<f64>().ok()) else {
            continue;
        };
        let name = cell.particles.map_or_else(|| cell.filter.name().to_owned(), |count| format!("{count} samples"));
        let point =
            (skip, cell.error_deg, if cell.particles.is_some() { cell.seed_std_deg } else { cell.cycle_std_deg });
        match all.iter_mut().find(|series| series.name == name) {
            Some(series) => series.points.push(point),
            None => all.push(Series { name, points: vec![point] }),
        }
    }
    all
}

fn figure_4a(setting: &Setting<'_>, page: &mut Page) -> Result<()> {
    let noise = setting.noise_table()?;
    let names: Vec<&str> = COLUMNS[1..].iter().map(|name| name.trim_end_matches("_rad")).collect();
    let wide = noise.iter().filter(|c| c.protocol == Protocol::ExactMean && (c.sigma_deg - 115.0).abs() < 0.5);
    let first = wide.clone().find(|cell| cell.filter == FilterName::Paper).map_or([0.0; 13], |cell| cell.each_deg);
    let limbs = |angles: &[usize; 4]| angles.iter().map(|&angle| first[angle]).sum::<f64>() / 4.0;
    let mut table = vec![std::iter::once("filter".to_owned()).chain(names.iter().map(|n| (*n).to_owned())).collect()];
    for cell in wide {
        let mut row: Vec<String> = vec![cell.filter.name().into()];
        row.extend(cell.each_deg.iter().zip(&cell.each_cycle_std_deg).map(|(e, std)| format!("{e:.1} +- {std:.1}")));
        table.push(row);
    }
    page.sections.push(Section {
        id: "figure-4a",
        title: "Figure 4a: error of each angle at sigma 115 degrees".into(),
        material: format!("{} Exact-mean; +- is one standard deviation over cycles.", walkers(setting)),
        rows: vec![Row {
            what: "trend".into(),
            paper: "legs are followed more easily than arms".into(),
            ours: format!("`paper`: legs {:.1}, arms {:.1} degrees", limbs(&LEGS), limbs(&ARMS)),
            difference: of_trend(limbs(&LEGS) < limbs(&ARMS)),
        }],
        reason: OTHER_MOTION.into(),
        table,
        ..Section::default()
    });
    Ok(())
}

fn figure_4b(setting: &Setting<'_>, page: &mut Page, plots: &mut Vec<(String, Plot)>) -> Result<()> {
    let sparse = setting.sparse_measurements()?;
    let exact = || sparse.iter().filter(|cell| cell.protocol == Protocol::ExactMean);
    plots.push((
        "figure_4b.svg".into(),
        Plot {
            title: "Figure 4b: fewer measurements, sigma 29 degrees (exact-mean)".into(),
            x_label: "frames a measurement".into(),
            y_label: "mean absolute error, degrees".into(),
            bars: "one standard deviation over test cycles".into(),
            series: by_skip(exact()),
            ..Plot::default()
        },
    ));
    let third = exact().find(|cell| cell.filter == FilterName::Paper && cell.updates == "every 3");
    let mut rows = Vec::new();
    if let Some(cell) = third {
        let (paper, ours, difference) = compared(printed::CYCLIC_SKIP_2_DEG, cell.error_deg, 2);
        let ours = format!("{ours} +- {:.2}", cell.cycle_std_deg);
        rows.push(Row { what: "two of three frames skipped, sigma 29".into(), paper, ours, difference });
    }
    for cell in exact().filter(|cell| cell.updates.starts_with("two")) {
        rows.push(Row {
            what: format!("two updates a cycle, sigma 6, `{}`", cell.filter.name()),
            paper: "an error that rises considerably; drawn, not printed".into(),
            ours: format!("{:.2} +- {:.2} degrees", cell.error_deg, cell.cycle_std_deg),
            difference: "no number to compare".into(),
        });
    }
    page.sections.push(Section {
        id: "figure-4b",
        title: "Figure 4b: fewer measurements, and two updates a cycle".into(),
        material: format!("{} +- is one standard deviation over cycles.", walkers(setting)),
        rows,
        reason: OTHER_MOTION.into(),
        pictures: vec!["figure_4b.svg".into()],
        ..Section::default()
    });
    Ok(())
}

fn table_2(setting: &Setting<'_>, samples: &[usize], page: &mut Page) -> Result<()> {
    let cells = setting.particle_table(samples)?;
    let falls = cells.is_sorted_by(|fewer, more| fewer.error_deg >= more.error_deg);
    let mut rows: Vec<Row> = cells
        .iter()
        .zip(printed::CYCLIC_TABLE_2_DEG[0])
        .map(|(cell, paper)| {
            let (paper, ours, difference) = compared(paper, cell.error_deg, 2);
            let ours = format!("{ours} +- {:.2}", cell.seed_std_deg);
            Row { what: format!("{} samples, test set 1", cell.particles.unwrap_or(0)), paper, ours, difference }
        })
        .collect();
    rows.push(Row {
        what: "trend".into(),
        paper: "the error falls with the number of samples".into(),
        ours: if falls { "in each step" } else { "not in each step" }.into(),
        difference: of_trend(falls),
    });
    page.sections.push(Section {
        id: "table-2",
        title: "Table 2: error against the number of samples at sigma 29 degrees".into(),
        material: format!("{} +- is one standard deviation over seeds.", walkers(setting)),
        rows,
        reason: OTHER_MOTION.into(),
        ..Section::default()
    });
    Ok(())
}

fn figures_5(
    setting: &Setting<'_>,
    (sparse, samples): (&[usize], &[usize]),
    page: &mut Page,
    plots: &mut Vec<(String, Plot)>,
) -> Result<()> {
    let bars = "one standard deviation over seeds".to_owned();
    let skipped = setting.sparse_particles(sparse)?;
    let y_label = "mean absolute error, degrees".to_owned();
    plots.push((
        "figure_5a.svg".into(),
        Plot {
            title: "Figure 5a: fewer measurements, samples, sigma 29 degrees".into(),
            x_label: "frames a measurement".into(),
            y_label: y_label.clone(),
            bars: bars.clone(),
            series: by_skip(skipped.iter()),
            ..Plot::default()
        },
    ));
    let starts = setting.starts(samples)?;
    let named = |start: StartName, name: &str| Series {
        name: name.into(),
        points: starts
            .iter()
            .filter(|cell| cell.start == start)
            .map(|cell| (cell.particles.unwrap_or(0) as f64, cell.late_error_deg, cell.late_seed_std_deg))
            .collect(),
    };
    let series = [(StartName::Standard, "standard"), (StartName::Uniform, "uniform"), (StartName::Random, "random")];
    plots.push((
        "figure_5b.svg".into(),
        Plot {
            title: "Figure 5b: three ways to start, from the fifth frame on, sigma 29 degrees".into(),
            x_label: "samples (logarithmic)".into(),
            y_label,
            log_x: true,
            bars,
            series: series.map(|(start, name)| named(start, name)).to_vec(),
        },
    ));
    page.sections.push(Section {
        id: "figures-5",
        title: "Figures 5a and 5b: samples with fewer measurements, and three ways to start".into(),
        material: walkers(setting),
        rows: [trend_5a(&skipped), trend_5b(&starts)].into_iter().flatten().collect(),
        reason: OTHER_MOTION.into(),
        pictures: vec!["figure_5a.svg".into(), "figure_5b.svg".into()],
        ..Section::default()
    });
    Ok(())
}

/// Whether the first gap costs less than half of what the longest one costs, with the fewest
/// samples.
fn trend_5a(skipped: &[Cell]) -> Option<Row> {
    let curve = by_skip(skipped.iter()).into_iter().next()?;
    let [every, short, long] = [curve.points.first()?, curve.points.get(1)?, curve.points.last()?];
    Some(Row {
        what: format!("5a, {}", curve.name),
        paper: "short gaps cost little, long ones much; drawn, not printed".into(),
        ours: format!(
            "a measurement every {:.0}, {:.0}, {:.0} frames: {:.1}, {:.1}, {:.1} degrees",
            every.0, short.0, long.0, every.1, short.1, long.1
        ),
        difference: of_trend(short.1 - every.1 < 0.5 * (long.1 - every.1)),
    })
}

/// Whether starts uniform over the cycle end nearer to standard ones than to random ones, and
/// random ones have the greatest error, with the most samples.
fn trend_5b(starts: &[Cell]) -> Option<Row> {
    let last = |start: StartName| starts.iter().rfind(|cell| cell.start == start);
    let [standard, uniform, random] = [last(StartName::Standard)?, last(StartName::Uniform)?, last(StartName::Random)?];
    let [s, u, r] = [standard, uniform, random].map(|cell| cell.late_error_deg);
    Some(Row {
        what: format!("5b, {} samples, from the fifth frame on", standard.particles.unwrap_or(0)),
        paper: "random starts fail; starts uniform over the cycle are almost as good as standard ones".into(),
        ours: format!(
            "standard {s:.1} +- {:.1}, uniform {u:.1} +- {:.1}, random {r:.1} +- {:.1} degrees",
            standard.late_seed_std_deg, uniform.late_seed_std_deg, random.late_seed_std_deg
        ),
        difference: of_trend(r > u && r > s && (u - s).abs() < (r - u).abs()),
    })
}
