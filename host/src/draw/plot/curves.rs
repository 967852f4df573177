//! Curves with bands of uncertainty.

use super::axis::{Axis, log_place, plottable};
use super::figure::{INK, Key, Names, ZOOM, band, broken_line, chart, legend, px, render, text};
use crate::error::{Result, ensure};
use image::RgbImage;
use plotters::prelude::*;

const SIZE_PX: (u32, u32) = (960, 600);
/// Colours that stay apart for colour-blind people (Okabe and Ito's set without yellow).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(20, 20, 20),
];
/// Curves with more points than this get no dots.
const MAX_DOTS: usize = 60;
/// Radius of a mark, pixels of the doubled drawing.
const MARK_RADIUS: i32 = 3;

/// One line of [`curves_plot`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// What the legend calls it.
    pub name: String,
    /// Points (x, y) in the order of the line; it breaks where one is not finite.
    pub points: Vec<(f64, f64)>,
    /// Lower rim of the band, one for each point.
    pub low: Option<Vec<f64>>,
    /// Upper rim of the band, one for each point.
    pub high: Option<Vec<f64>>,
    /// Points that stand beside the line, such as what was measured: small dots in its colour.
    /// Those that are not finite are absent.
    pub marks: Vec<(f64, f64)>,
}

impl Curve {
    /// (x, low, high) of each point with a band.
    fn band(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        let (low, high) = (self.low.iter().flatten(), self.high.iter().flatten());
        self.points.iter().zip(low.zip(high)).map(|(point, (low, high))| (point.0, *low, *high))
    }

    fn check(&self, log_x: bool) -> Result<()> {
        let (name, count) = (&self.name, self.points.len());
        for (rim, values) in [("low", &self.low), ("high", &self.high)] {
            let values = values.as_ref().map_or(count, Vec::len);
            ensure!(
                values == count,
                "curve `{name}`: {values} values of `{rim}` for {count} points; give one for each"
            );
        }
        ensure!(
            self.low.is_some() == self.high.is_some(),
            "curve `{name}`: a band needs both `low` and `high`; give both or none"
        );
        let bad = self.points.iter().chain(&self.marks).find(|point| log_x && point.0 <= 0.0);
        let bad = bad.map_or(1.0, |point| point.0);
        ensure!(bad > 0.0, "curve `{name}`: x = {bad} on a logarithmic axis, which needs x > 0; use a linear one");
        Ok(())
    }
}

/// Plots `curves` over a linear or logarithmic x axis, with bands where given and a legend for more
/// than one.
///
/// # Errors
/// Bands need as many values as points, logarithmic axes positive x; one point at least has to be
/// finite.
pub fn curves_plot(title: &str, x_label: &str, y_label: &str, log_x: bool, curves: &[Curve]) -> Result<RgbImage> {
    curves.iter().try_for_each(|curve| curve.check(log_x))?;
    let place = |x: f64| if log_x { log_place(x) } else { plottable(x).then_some(x) };
    let seen = curves.iter().flat_map(|curve| &curve.points).any(|(x, y)| place(*x).is_some() && plottable(*y));
    ensure!(seen, "plot `{title}`: no curve has a finite point; give one at least");
    let all = |curve: &'_ Curve| curve.points.iter().chain(&curve.marks).copied().collect::<Vec<_>>();
    let xs = curves.iter().flat_map(all).map(|point| point.0);
    let x_axis = if log_x { Axis::logarithmic(xs) } else { Axis::over(xs) };
    let lines = curves.iter().flat_map(all).map(|point| point.1);
    let bands = curves.iter().flat_map(Curve::band).flat_map(|(_, low, high)| [low, high]);
    let y_axis = Axis::over(lines.chain(bands));
    render(SIZE_PX.0, SIZE_PX.1, |area| {
        let (left, right) = area.split_horizontally(px(SIZE_PX.0) - legend_width(curves));
        let mut chart = chart(&left, Names { title, x: x_label, y: y_label }, &x_axis, &y_axis)?;
        for (curve, colour) in curves.iter().zip(COLOURS.iter().cycle()) {
            let rims = curve.band().map(|(x, low, high)| {
                place(x).filter(|_| plottable(low) && plottable(high)).map(|x| (x, low.min(high), high.max(low)))
            });
            band(&mut chart, rims, *colour, 0.18)?;
        }
        for (curve, colour) in curves.iter().zip(COLOURS.iter().cycle()) {
            let marks = curve.marks.iter().filter_map(|(x, y)| place(*x).filter(|_| plottable(*y)).map(|x| (x, *y)));
            chart.draw_series(marks.map(|mark| Circle::new(mark, MARK_RADIUS, colour.mix(0.45).filled())))?;
        }
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let points: Vec<Option<(f64, f64)>> =
                curve.points.iter().map(|(x, y)| place(*x).filter(|_| plottable(*y)).map(|x| (x, *y))).collect();
            let dots = points.iter().flatten().filter(|_| points.len() <= MAX_DOTS);
            chart.draw_series(dots.map(|dot| Circle::new(*dot, px(4), style(index, colour))))?;
            broken_line(&mut chart, points.iter().copied(), colour.stroke_width(2 * ZOOM))?;
        }
        if curves.len() > 1 {
            legend(&right.margin(px(40), 0, 0, 0), &entries(curves))?;
        }
        Ok(())
    })
}

/// Filled dots, or rings once the colours repeat.
fn style(index: usize, colour: RGBColor) -> ShapeStyle {
    if (index / COLOURS.len()).is_multiple_of(2) { colour.filled() } else { colour.stroke_width(ZOOM) }
}

fn entries(curves: &[Curve]) -> Vec<(Key, String)> {
    let keys = COLOURS.iter().cycle().map(|colour| Key::Line(colour.stroke_width(3 * ZOOM)));
    keys.zip(curves).map(|(key, curve)| (key, curve.name.clone())).collect()
}

/// Room for the longest name, at most 40 % of the plot.
fn legend_width(curves: &[Curve]) -> u32 {
    if curves.len() < 2 {
        return 0;
    }
    let style = text(14).color(&INK);
    let widths = curves.iter().filter_map(|curve| style.font.box_size(&curve.name).ok());
    (widths.map(|size| size.0).max().unwrap_or(0) + px(52)).min(2 * px(SIZE_PX.0) / 5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn curve(points: &[(f64, f64)]) -> Curve {
        Curve { name: "error".to_owned(), points: points.to_vec(), ..Curve::default() }
    }

    fn pixels_near(image: &RgbImage, colour: RGBColor) -> usize {
        let far = |a: u8, b: u8| a.abs_diff(b) > 12;
        image.pixels().filter(|p| !far(p[0], colour.0) && !far(p[1], colour.1) && !far(p[2], colour.2)).count()
    }

    #[test]
    fn every_curve_appears_in_its_colour() {
        let first = curve(&[(25.0, 3.0), (50.0, 2.0), (100.0, 1.5)]);
        let second = curve(&[(25.0, 1.5), (50.0, 0.9), (100.0, 0.8)]);
        let second = Curve { low: Some(vec![0.5, 0.4, 0.3]), high: Some(vec![2.5, 1.4, 1.3]), ..second };
        let image = curves_plot("Error", "particles", "error (px)", true, &[first, second]).unwrap();
        assert_eq!(image.dimensions(), SIZE_PX);
        for colour in &COLOURS[..2] {
            let count = pixels_near(&image, *colour);
            assert!((500..20_000).contains(&count), "{count} pixels of {colour:?}");
        }
        assert_eq!(pixels_near(&image, COLOURS[2]), 0);
    }

    /// Marks are dots off the line, in a lighter shade of its colour, and widen the axes.
    #[test]
    fn marks_appear_beside_the_line_and_what_is_not_finite_is_absent() {
        let line = curve(&[(0.0, 0.0), (1.0, 0.0)]);
        let plot = |marks: &[(f64, f64)]| {
            let marked = Curve { marks: marks.to_vec(), ..line.clone() };
            let image = curves_plot("", "x", "y", false, &[marked]).unwrap();
            image.pixels().filter(|p| p[2] > 180 && p[0] < 180 && p[2] > p[0] + 40).count()
        };
        let [none, missing, some] = [&[][..], &[(0.5, f64::NAN)], &[(0.3, 0.4), (0.6, 0.5), (0.9, -0.4)]].map(plot);
        assert_eq!(none, missing);
        assert!(some > none + 15, "{some} beside {none} pixels");
        let bad = Curve { marks: vec![(-1.0, 1.0)], ..curve(&[(1.0, 1.0)]) };
        assert!(curves_plot("t", "x", "y", true, &[bad]).unwrap_err().to_string().contains("x = -1"));
    }

    #[test]
    fn a_rising_line_rises_to_the_right() {
        let image = curves_plot("", "x", "y", false, &[curve(&[(0.0, 0.0), (1.0, 1.0)])]).unwrap();
        let row_of =
            |x: u32| (0..SIZE_PX.1).find(|y| image.get_pixel(x, *y)[2] > 120 && image.get_pixel(x, *y)[0] < 60);
        assert!(row_of(700).unwrap() + 100 < row_of(300).unwrap());
    }

    #[test]
    fn the_same_curves_give_the_same_bytes() {
        let plot = || curves_plot("t", "x", "y", false, &[curve(&[(0.0, 0.1), (2.0, 1.7)])]).unwrap();
        assert_eq!(plot().as_raw(), plot().as_raw());
    }

    #[test]
    fn what_cannot_be_plotted_is_refused_by_name() {
        let message = |log_x, curve| curves_plot("t", "x", "y", log_x, &[curve]).unwrap_err().to_string();
        assert!(message(true, curve(&[(0.0, 1.0)])).contains("`error`: x = 0"));
        assert!(message(false, curve(&[(f64::NAN, 1.0)])).contains("no curve has a finite point"));
        let short = Curve { low: Some(vec![]), high: Some(vec![1.0]), ..curve(&[(1.0, 1.0)]) };
        assert!(message(false, short).contains("0 values of `low`"));
        let half = Curve { low: Some(vec![0.0]), ..curve(&[(1.0, 1.0)]) };
        assert!(message(false, half).contains("both"));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn no_numbers_make_it_panic(points in prop::collection::vec(any::<(f64, f64)>(), 0..12), log_x: bool) {
            let rims = points.iter().map(|point| point.0).collect::<Vec<_>>();
            let banded = Curve { low: Some(rims.clone()), high: Some(rims), ..curve(&points) };
            let _ = curves_plot("hostile", "x", "y", log_x, &[banded]).map(|image| assert_eq!(image.dimensions(), SIZE_PX));
        }
    }
}
