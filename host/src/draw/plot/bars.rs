//! Bars of named numbers.

use super::axis::{Axis, plottable};
use super::figure::{Area, INK, Names, ZOOM, chart, px, render, text};
use crate::error::{Result, ensure};
use image::RgbImage;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const SIZE_PX: (u32, u32) = (960, 560);
const FILL: RGBColor = RGBColor(0, 114, 178);
/// Maximum number of bars of a plot.
const MAX_BARS: usize = 200;

/// Plots one bar a pair of name and value, with the value written on it; "-" where it is not
/// finite.
///
/// # Errors
/// There have to be 1 to 200 bars.
pub fn bars_plot(title: &str, y_label: &str, bars: &[(String, f64)]) -> Result<RgbImage> {
    let count = bars.len();
    ensure!((1..=MAX_BARS).contains(&count), "plot `{title}`: {count} bars; give 1 to {MAX_BARS}");
    let values = bars.iter().map(|bar| bar.1).filter(|value| plottable(*value));
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    let room = if high > low { 0.1 * (high - low) } else { 1.0 };
    let y = Axis::linear(if low < 0.0 { low - room } else { 0.0 }, high + room);
    let x = Axis { low: -0.6, high: count as f64 - 0.4, ticks: Vec::new(), reversed: false };
    render(SIZE_PX.0, SIZE_PX.1, |area| {
        let slot_px = px(SIZE_PX.0 - 84) / count as u32;
        let (upright, names_px) = names_height(bars, slot_px);
        let (upper, lower) = area.split_vertically(px(SIZE_PX.1) - names_px);
        let mut chart = chart(&upper, Names { title, x: "", y: y_label }, &x, &y)?;
        for (index, (name, value)) in bars.iter().enumerate() {
            let middle = index as f64;
            let shown = if plottable(*value) { *value } else { 0.0 };
            chart.draw_series([Rectangle::new([(middle - 0.36, 0.0), (middle + 0.36, shown)], FILL.filled())])?;
            let at = chart.backend_coord(&(middle, shown));
            let (down, gap_px) = if shown < 0.0 { (VPos::Top, px(5)) } else { (VPos::Bottom, 0) };
            let style = text(if slot_px < px(50) { 10 } else { 14 }).pos(Pos::new(HPos::Center, down));
            area.draw(&Text::new(written(*value), (at.0, at.1 + gap_px as i32), style))?;
            draw_name(&lower, name, at.0, upright)?;
        }
        let zero = PathElement::new([(x.low, 0.0), (x.high, 0.0)], INK.stroke_width(ZOOM));
        chart.draw_series([zero])?;
        Ok(())
    })
}

/// Three significant digits or so.
fn written(value: f64) -> String {
    match value.abs() {
        _ if !plottable(value) => "-".to_owned(),
        0.0 => "0".to_owned(),
        size if !(1.0e-3..1.0e6).contains(&size) => format!("{value:.1e}"),
        size if size < 1.0 => format!("{value:.3}"),
        size if size < 10.0 => format!("{value:.2}"),
        size if size < 100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// Whether names have to stand upright to fit below their bars, and how much height they take.
fn names_height(bars: &[(String, f64)], slot_px: u32) -> (bool, u32) {
    let style = text(14);
    let widths = bars.iter().filter_map(|bar| style.font.box_size(&bar.0).ok());
    let longest = widths.map(|size| size.0).max().unwrap_or(0);
    let upright = longest + px(6) > slot_px;
    (upright, if upright { (longest + px(12)).min(px(SIZE_PX.1) / 2) } else { px(24) })
}

fn draw_name(area: &Area, name: &str, x: i32, upright: bool) -> Result<()> {
    let style = if upright {
        text(14).transform(FontTransform::Rotate270).pos(Pos::new(HPos::Right, VPos::Center))
    } else {
        text(14).pos(Pos::new(HPos::Center, VPos::Top))
    };
    area.draw(&Text::new(name, (x, 0), style))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn filled(image: &RgbImage, columns: std::ops::Range<u32>) -> usize {
        let columns = columns.flat_map(|x| (0..SIZE_PX.1).map(move |y| (x, y)));
        columns.filter(|(x, y)| image.get_pixel(*x, *y).0 == [FILL.0, FILL.1, FILL.2]).count()
    }

    #[test]
    fn the_area_of_bars_follows_their_values() {
        let bars = [("one".to_owned(), 1.0), ("three".to_owned(), 3.0)];
        let image = bars_plot("Bars", "error (m)", &bars).unwrap();
        let (first, second) = (filled(&image, 0..515), filled(&image, 515..SIZE_PX.0));
        let ratio = second as f64 / first as f64;
        assert!((2.9..3.1).contains(&ratio), "{second} / {first}");
    }

    #[test]
    fn numbers_are_written_short() {
        assert_eq!(
            ["0", "0.012", "2.35", "42.0", "1234"],
            [0.0, 0.0123, 2.346, 42.0, 1234.4].map(written).each_ref().map(String::as_str)
        );
        assert_eq!(written(f64::NAN), "-");
    }

    #[test]
    fn no_bars_are_refused() {
        assert!(bars_plot("Empty", "y", &[]).unwrap_err().to_string().contains("give 1 to 200"));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn no_numbers_make_it_panic(values in prop::collection::vec((".{0,60}", any::<f64>()), 1..40)) {
            prop_assert_eq!(bars_plot("hostile", "y", &values).unwrap().dimensions(), SIZE_PX);
        }
    }
}
