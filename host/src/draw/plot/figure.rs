//! The sheet that plots are drawn on, and what all of them share: font, axes, lines with gaps,
//! legends.

use super::axis::Axis;
use crate::error::{Result, ensure};
use image::{Rgb, RgbImage, imageops};
use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::sync::OnceLock;

/// All lengths in plots are given in pixels of the result; drawn is this many times larger.
pub const ZOOM: u32 = 2;
/// Text in plots.
pub const INK: RGBColor = RGBColor(40, 40, 46);
const FONT: &str = "sans-serif";
/// Maximum number of pixels along a side of a plot.
const MAX_SIDE_PX: u32 = 8000;

/// A part of the sheet.
pub type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
/// A part of the sheet with axes.
pub type Chart<'c, 'b> = ChartContext<'c, BitMapBackend<'b>, Cartesian2d<Axis, Axis>>;

/// `length_px` of the result, as drawn.
pub fn px(length_px: u32) -> u32 {
    ZOOM * length_px
}

/// Renders what `draw` paints on a white sheet of `width` times `height` pixels.
pub fn render(width: u32, height: u32, draw: impl FnOnce(&Area) -> Result<()>) -> Result<RgbImage> {
    register_font()?;
    let sides = 1..=MAX_SIDE_PX;
    ensure!(
        sides.contains(&width) && sides.contains(&height),
        "plot of {width} x {height} pixels: sides must be 1 to {MAX_SIDE_PX}"
    );
    let mut image = RgbImage::from_pixel(ZOOM * width, ZOOM * height, Rgb([255, 255, 255]));
    {
        let area = BitMapBackend::with_buffer(&mut image, (ZOOM * width, ZOOM * height)).into_drawing_area();
        draw(&area)?;
        area.present()?;
    }
    Ok(imageops::thumbnail(&image, width, height))
}

fn register_font() -> Result<()> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let registered = *REGISTERED.get_or_init(|| {
        plotters::style::register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok()
    });
    ensure!(registered, "the font of the plots cannot be read; build the program again");
    Ok(())
}

/// Text of `size_px`.
pub fn text(size_px: u32) -> TextStyle<'static> {
    (FONT, px(size_px)).into_font().color(&INK)
}

/// The colour of a side or curve for plotters.
pub fn paint(colour: Rgb<u8>) -> RGBColor {
    RGBColor(colour[0], colour[1], colour[2])
}

/// Names of a chart; empty ones are left out.
#[derive(Debug, Clone, Copy, Default)]
pub struct Names<'a> {
    pub title: &'a str,
    pub x: &'a str,
    pub y: &'a str,
}

/// Draws axes with marks and a faint grid on all of `area`.
pub fn chart<'c, 'b>(area: &'c Area<'b>, names: Names, x: &Axis, y: &Axis) -> Result<Chart<'c, 'b>> {
    let mut builder = ChartBuilder::on(area);
    builder.margin(px(6)).margin_right(px(14));
    if !names.title.is_empty() {
        builder.caption(names.title, text(19));
    }
    builder.x_label_area_size(px(if names.x.is_empty() { 22 } else { 42 })).y_label_area_size(px(64));
    let mut chart = builder.build_cartesian_2d(x.clone(), y.clone())?;
    let mut mesh = chart.configure_mesh();
    mesh.label_style(text(13)).axis_desc_style(text(15)).axis_style(INK.stroke_width(ZOOM));
    mesh.bold_line_style(BLACK.mix(0.12).stroke_width(ZOOM)).light_line_style(TRANSPARENT);
    if !names.x.is_empty() {
        mesh.x_desc(names.x);
    }
    if !names.y.is_empty() {
        mesh.y_desc(names.y);
    }
    mesh.draw()?;
    Ok(chart)
}

/// Runs of neighbouring points that are all there.
pub fn runs<T: Copy>(points: impl IntoIterator<Item = Option<T>>) -> Vec<Vec<T>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Draws a line through `points`, broken where one is missing; a lone point becomes a dot.
pub fn broken_line(
    chart: &mut Chart,
    points: impl IntoIterator<Item = Option<(f64, f64)>>,
    style: ShapeStyle,
) -> Result<()> {
    for run in runs(points) {
        if let [lone] = run[..] {
            chart.draw_series([Circle::new(lone, style.stroke_width, style.filled())])?;
        } else {
            chart.draw_series([PathElement::new(run, style)])?;
        }
    }
    Ok(())
}

/// Fills between the second (low) and third (high) of each point, broken where one is missing.
pub fn band(
    chart: &mut Chart,
    points: impl IntoIterator<Item = Option<(f64, f64, f64)>>,
    colour: RGBColor,
    opacity: f64,
) -> Result<()> {
    for run in runs(points).into_iter().filter(|run| run.len() > 1) {
        let low = run.iter().map(|(x, low, _)| (*x, *low));
        let outline: Vec<(f64, f64)> = low.chain(run.iter().rev().map(|(x, _, high)| (*x, *high))).collect();
        chart.draw_series([Polygon::new(outline, colour.mix(opacity).filled())])?;
    }
    Ok(())
}

/// A symbol of the legend.
#[derive(Debug, Clone, Copy)]
pub enum Key {
    /// A line.
    Line(ShapeStyle),
    /// A dot of this radius in pixels of the result.
    Dot(ShapeStyle, u32),
    /// A filled rectangle.
    Patch(ShapeStyle),
}

/// Draws symbols with their texts in rows from the top left of `area`.
pub fn legend(area: &Area, entries: &[(Key, String)]) -> Result<()> {
    let (width, row) = (px(26) as i32, px(20) as i32);
    for (index, (key, name)) in (0..).zip(entries) {
        let (left, middle) = (px(6) as i32, row * index + row / 2 + px(4) as i32);
        let (right, half) = (left + width, px(6) as i32);
        match *key {
            Key::Line(style) => area.draw(&PathElement::new([(left, middle), (right, middle)], style))?,
            Key::Dot(style, radius) => area.draw(&Circle::new(((left + right) / 2, middle), px(radius), style))?,
            Key::Patch(style) => area.draw(&Rectangle::new([(left, middle - half), (right, middle + half)], style))?,
        }
        area.draw(&Text::new(name.as_str(), (right + px(8) as i32, middle - px(6) as i32), text(14)))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_points_split_runs() {
        assert_eq!(runs([None, Some(1), Some(2), None, None, Some(3)]), [vec![1, 2], vec![3]]);
        assert!(runs::<i32>([None]).is_empty());
    }

    #[test]
    fn sheets_without_pixels_are_refused() {
        assert!(render(0, 10, |_| Ok(())).unwrap_err().to_string().contains("1 to 8000"));
    }
}
