//! Figure 3: true and estimated angles.

use crate::cyclic::Protocol;
use crate::cyclic::experiments::Setting;
use crate::cyclic::figures::trajectories;
use crate::reproduce::page::{Row, Section};
use crate::reproduce::plot::{Plot, Series};
use crate::reproduce::{Made, of_trend};
use anyhow::Result;
use sinew::cyclic::angle_table::COLUMNS;
use sinew::cyclic::tracking::FilterName;
use sinew::draw::plot::Curve;

/// What is shown, and the column of its angle: of the segments that end at ankle and wrist.
const SHOWN: [(&str, &str); 2] = [("left foot", "l_ankle_rad"), ("left hand", "l_wrist_rad")];

/// Adds figure 3.
///
/// # Errors
/// A run that fails.
pub fn figure_3(setting: &Setting<'_>, made: &mut Made) -> Result<()> {
    let (mut pictures, mut rows) = (Vec::new(), Vec::new());
    for protocol in [Protocol::ExactMean, Protocol::Noisy] {
        for (name, column) in SHOWN {
            let angle = COLUMNS[1..].iter().position(|other| *other == column).unwrap_or_default();
            let curves = trajectories(setting, angle, protocol)?;
            rows.push(trend(&format!("{name}, {}", protocol.name()), &curves));
            let flat = |curve: Curve| Series {
                name: curve.name,
                points: curve.points.iter().map(|(x, y)| (*x, *y, 0.0)).collect(),
            };
            let plot = Plot {
                title: format!("Figure 3: {name}, two cycles, sigma 6 degrees ({})", protocol.name()),
                x_label: "frame of 1/60 s".into(),
                y_label: "angle of the segment, degrees".into(),
                series: curves.into_iter().map(flat).collect(),
                ..Plot::default()
            };
            let file = format!("figure_3_{}_{}.svg", name.replace(' ', "_"), protocol.name());
            made.plots.push((file.clone(), plot));
            pictures.push(file);
        }
    }
    made.page.sections.push(Section {
        id: "figure-3",
        title: "Figure 3: true and estimated angles of the left foot and hand".into(),
        material: "The first two test cycles, one after the other. Angles are those of the segments that end at ankle \
                   and wrist. Roughness is the mean size of the second difference from frame to frame."
            .into(),
        rows,
        reason: "The paper's protocol adds no noise to the measurement: exact-mean. In noise the estimate follows a \
                 part of it."
            .into(),
        pictures,
        ..Section::default()
    });
    Ok(())
}

/// How close `paper` is to the truth, and how smooth.
fn trend(what: &str, curves: &[Curve]) -> Row {
    let of = |name: &str| curves.iter().find(|curve| curve.name == name).map_or(&[][..], |curve| &curve.points);
    let (paper, truth) = (of(FilterName::Paper.name()), of("truth"));
    let off_deg = mean(paper.iter().zip(truth).map(|(a, b)| (a.1 - b.1).abs()));
    let [rough, truth_rough] = [paper, truth].map(roughness_deg);
    Row {
        what: what.into(),
        paper: "the estimate follows the truth closely, and is smoother than it".into(),
        ours: format!(
            "`paper` is {off_deg:.1} degrees off on the mean; its roughness is {rough:.2} degrees a frame^2, the \
             truth's {truth_rough:.2}"
        ),
        // The mean distance of normal noise with a standard deviation of 6 degrees.
        difference: match (off_deg < 4.8, rough < truth_rough) {
            (true, false) => "it is close, and not smoother".into(),
            (is_close, _) => of_trend(is_close),
        },
    }
}

/// Mean size of the second difference, degrees per frame^2.
fn roughness_deg(points: &[(f64, f64)]) -> f64 {
    mean(points.windows(3).map(|three| (three[0].1 - 2.0 * three[1].1 + three[2].1).abs()))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / f64::max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_close_and_smooth_curve_follows_the_trend_and_a_rough_one_does_not() {
        let curve = |name: &str, rough: f64| Curve {
            name: name.into(),
            points: (0..40).map(|x| (f64::from(x), f64::from(x) + if x % 2 == 0 { rough } else { -rough })).collect(),
            ..Curve::default()
        };
        // Values that change sides by 2 r have second differences of 4 r.
        assert!((roughness_deg(&curve("a", 0.5).points) - 2.0).abs() < 1.0e-9);
        let of = |paper, truth| trend("foot", &[curve("paper", paper), curve("truth", truth)]).difference;
        assert_eq!(of(0.1, 0.5), "none in the trend");
        assert_eq!(of(0.5, 0.1), "it is close, and not smoother");
        assert_eq!(of(9.0, 0.1), "the trend does not come out");
    }
}
