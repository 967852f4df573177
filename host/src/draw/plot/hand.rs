//! The way of the hands: in the image, and over time with what the tracker knew of it.

use super::axis::{Axis, plottable};
use super::figure::{Area, Chart, INK, Key, Names, ZOOM, band, broken_line, chart, legend, paint, px, render};
use crate::draw::colour::of_side;
use crate::error::Result;
use crate::track::HandSample;
use crate::wording::side_name;
use image::RgbImage;
use plotters::prelude::*;
use sinew_core::camera::Pixel;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::Status;

const SIZE_PX: (u32, u32) = (1500, 980);
/// Width of the column with the path, pixels.
const PATH_WIDTH_PX: u32 = 640;
/// Height below the path for the legend, pixels.
const LEGEND_HEIGHT_PX: u32 = 210;
/// What axes and margins of the path take of width and height, pixels.
const PATH_RIM_PX: (u32, u32) = (84, 80);

/// The samples of one side in the order of time.
type Track = (Side, Vec<HandSample>);

/// Plots the hands' way in an image of `image_size` (width and height, pixels). Over time it plots
/// their column, row and depth with one standard deviation. It also plots the likelihood of the
/// carrying blob shaded by status, and the effective sample size.
///
/// Samples of both sides may be mixed. Numbers that are not finite leave gaps, no samples at all
/// leave empty axes.
///
/// # Errors
/// The library that draws reports one; the input cannot be wrong.
pub fn hand_plot(samples: &[HandSample], image_size: (u32, u32)) -> Result<RgbImage> {
    let tracks: Vec<Track> = [Side::Left, Side::Right].into_iter().filter_map(|side| track(samples, side)).collect();
    let time_axis = Axis::over(tracks.iter().flat_map(|track| track.1.iter().map(|sample| f64::from(sample.time_s))));
    render(SIZE_PX.0, SIZE_PX.1, |area| {
        let (left, right) = area.split_horizontally(px(PATH_WIDTH_PX));
        let lower = draw_path(&left, &tracks, image_size)?;
        legend(&lower.margin(px(10), 0, px(60), 0), &entries(&tracks))?;
        draw_panels(&right, &tracks, &time_axis)
    })
}

fn track(samples: &[HandSample], side: Side) -> Option<Track> {
    let of_side = samples.iter().filter(|sample| sample.side == side && plottable(f64::from(sample.time_s)));
    let mut track: Vec<HandSample> = of_side.copied().collect();
    track.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    (!track.is_empty()).then_some((side, track))
}

/// The way in the image, u to the right, v down, in true proportions; returns the area below.
fn draw_path<'b>(area: &Area<'b>, tracks: &[Track], image_size: (u32, u32)) -> Result<Area<'b>> {
    let (width, height) = (f64::from(image_size.0.max(1)), f64::from(image_size.1.max(1)));
    // What lies far outside of the image would only make the rest small.
    let inside = |point: &Pixel| {
        let (u, v) = (f64::from(point.u_px), f64::from(point.v_px));
        (u.abs() <= 1.5 * width && v.abs() <= 1.5 * height && u >= -0.5 * width && v >= -0.5 * height).then_some((u, v))
    };
    let place = |sample: &HandSample| sample.hand_px.as_ref().and_then(inside);
    let seen = || tracks.iter().flat_map(|track| track.1.iter().filter_map(place));
    let u_axis = Axis::over(seen().map(|point| point.0).chain([0.0, width - 1.0]));
    let v_axis = Axis { reversed: true, ..Axis::over(seen().map(|point| point.1).chain([0.0, height - 1.0])) };
    let proportion = (v_axis.high - v_axis.low) / (u_axis.high - u_axis.low);
    let room =
        (f64::from(px(PATH_WIDTH_PX - PATH_RIM_PX.0)), f64::from(px(SIZE_PX.1 - LEGEND_HEIGHT_PX - PATH_RIM_PX.1)));
    let panel_width = room.0.min(room.1 / proportion).max(40.0);
    let panel_height = (panel_width * proportion).clamp(40.0, room.1);
    let (area, below) = area.split_vertically(panel_height as u32 + px(PATH_RIM_PX.1));
    let (area, _) = area.split_horizontally(panel_width as u32 + px(PATH_RIM_PX.0));
    let names = Names { title: "Hand in the image", x: "u (px)", y: "v (px)" };
    let mut chart = chart(&area, names, &u_axis, &v_axis)?;
    let (right, bottom) = (width - 0.5, height - 0.5);
    let frame = [(-0.5, -0.5), (right, -0.5), (right, bottom), (-0.5, bottom), (-0.5, -0.5)];
    chart.draw_series([PathElement::new(frame, INK.stroke_width(ZOOM))])?;
    for (side, samples) in tracks {
        draw_line(&mut chart, samples, *side, place)?;
        let mut ends = samples.iter().filter(|sample| sample.status != Status::Lost).filter_map(place);
        let first = ends.next();
        let colour = paint(of_side(*side));
        chart.draw_series(first.map(|first| Circle::new(first, px(6), colour.stroke_width(2 * ZOOM))))?;
        chart.draw_series(ends.next_back().or(first).map(|last| Circle::new(last, px(5), colour.filled())))?;
    }
    Ok(below)
}

/// Thick where tracking, thin where either end is uncertain or a prediction, nothing where either
/// is lost or has no `place`.
fn draw_line(
    chart: &mut Chart,
    samples: &[HandSample],
    side: Side,
    place: impl Fn(&HandSample) -> Option<(f64, f64)>,
) -> Result<()> {
    let colour = paint(of_side(side));
    let at = |sample: &HandSample, status: Status| place(sample).filter(|_| sample.status == status);
    broken_line(chart, samples.iter().map(|sample| at(sample, Status::Tracking)), colour.stroke_width(2 * ZOOM))?;
    let thin = colour.mix(0.55).stroke_width(ZOOM);
    let is_thin = |sample: &HandSample| matches!(sample.status, Status::Predicted | Status::Uncertain);
    let thin_at = |index: usize| samples.get(index).is_some_and(is_thin);
    let bridges = samples.iter().enumerate().map(|(index, sample)| {
        let beside = thin_at(index + 1) || (index > 0 && thin_at(index - 1));
        place(sample).filter(|_| is_thin(sample)).or_else(|| at(sample, Status::Tracking).filter(|_| beside))
    });
    broken_line(chart, bridges, thin)
}

/// What a panel shows of a sample.
type Quantity = fn(&HandSample) -> Option<f32>;

fn draw_panels(area: &Area, tracks: &[Track], time: &Axis) -> Result<()> {
    let panels: [(&str, Quantity); 5] = [
        ("u (px)", |sample| sample.hand_px.map(|hand| hand.u_px)),
        ("v (px)", |sample| sample.hand_px.map(|hand| hand.v_px)),
        ("depth z (m)", depth_m),
        ("likelihood", |sample| Some(sample.likelihood).filter(|likelihood| (0.0..=1.0).contains(likelihood))),
        ("effective samples", |sample| Some(sample.effective_sample_size)),
    ];
    let heights = [1, 2, 3, 4].map(|index| (px(SIZE_PX.1 - 20) * index / 5) as i32);
    let areas = area.split_by_breakpoints([0; 0], heights);
    for (index, ((y_name, quantity), area)) in panels.into_iter().zip(&areas).enumerate() {
        let place = |sample: &HandSample| {
            let value = f64::from(quantity(sample)?);
            plottable(value).then_some((f64::from(sample.time_s), value))
        };
        let shown = || tracks.iter().flat_map(|track| &track.1).filter(|sample| sample.status != Status::Lost);
        let values = shown().filter_map(place).map(|point| point.1);
        let y_axis = match y_name {
            "likelihood" => Axis::linear(-0.05, 1.05),
            "effective samples" => Axis::over(values.chain([0.0])),
            "v (px)" => Axis { reversed: true, ..Axis::over(values) },
            "depth z (m)" => Axis::over(values.chain(shown().filter_map(depth_band).flat_map(|band| [band.1, band.2]))),
            _ => Axis::over(values),
        };
        let x_name = if index == 4 { "time (s)" } else { "" };
        let mut chart = chart(area, Names { title: "", x: x_name, y: y_name }, time, &y_axis)?;
        if y_name == "likelihood" {
            shade_by_status(&mut chart, tracks)?;
        }
        for (side, samples) in tracks {
            if y_name == "depth z (m)" {
                let rims = samples.iter().map(|s| depth_band(s).filter(|_| s.status != Status::Lost));
                band(&mut chart, rims, paint(of_side(*side)), 0.18)?;
            }
            draw_line(&mut chart, samples, *side, place)?;
        }
    }
    Ok(())
}

fn depth_m(sample: &HandSample) -> Option<f32> {
    sample.hand_m.map(|hand| hand.z)
}

/// Time, and depth less and plus one standard deviation.
fn depth_band(sample: &HandSample) -> Option<(f64, f64, f64)> {
    let (depth, std) = (f64::from(depth_m(sample)?), f64::from(sample.hand_std_m));
    (plottable(depth) && plottable(std)).then_some((f64::from(sample.time_s), depth - std, depth + std))
}

/// Opacity of the shading of a status.
fn shading(status: Status) -> f64 {
    match status {
        Status::Tracking => 0.0,
        Status::Uncertain => 0.07,
        Status::Predicted => 0.14,
        Status::Lost => 0.38,
    }
}

/// Fills the times of prediction and loss; with two sides, the upper half is the first one's.
fn shade_by_status(chart: &mut Chart, tracks: &[Track]) -> Result<()> {
    for (index, (side, samples)) in tracks.iter().enumerate() {
        let rows = match (tracks.len(), index) {
            (1, _) => (0.0, 1.0),
            (_, 0) => (0.5, 1.0),
            _ => (0.0, 0.5),
        };
        for (status, from_s, to_s) in status_spans(samples) {
            let style = paint(of_side(*side)).mix(shading(status)).filled();
            if status != Status::Tracking {
                chart.draw_series([Rectangle::new([(from_s, rows.0), (to_s, rows.1)], style)])?;
            }
        }
    }
    Ok(())
}

/// Runs of equal status with their times; borders lie midway between samples.
fn status_spans(samples: &[HandSample]) -> Vec<(Status, f64, f64)> {
    let mut spans: Vec<(Status, f64, f64)> = Vec::new();
    for sample in samples {
        let time_s = f64::from(sample.time_s);
        match spans.last_mut() {
            Some(span) if span.0 == sample.status => span.2 = time_s,
            Some(span) => {
                let border_s = 0.5 * (span.2 + time_s);
                span.2 = border_s;
                spans.push((sample.status, border_s, time_s));
            }
            None => spans.push((sample.status, time_s, time_s)),
        }
    }
    spans
}

fn entries(tracks: &[Track]) -> Vec<(Key, String)> {
    let mut entries = Vec::new();
    for (side, _) in tracks {
        entries.push((Key::Line(paint(of_side(*side)).stroke_width(3 * ZOOM)), format!("{} hand", side_name(*side))));
    }
    entries.push((Key::Line(INK.mix(0.55).stroke_width(ZOOM)), "uncertain or predicted".to_owned()));
    entries.push((Key::Dot(INK.stroke_width(2 * ZOOM), 6), "first place".to_owned()));
    entries.push((Key::Dot(INK.filled(), 5), "last place".to_owned()));
    entries.push((Key::Patch(INK.mix(0.18).filled()), "depth: one standard deviation of the hand".to_owned()));
    let halves = if tracks.len() > 1 { " (left: upper half, right: lower half)" } else { "" };
    for (status, name) in [(Status::Uncertain, "uncertain"), (Status::Predicted, "predicted"), (Status::Lost, "lost")] {
        entries.push((Key::Patch(INK.mix(shading(status)).filled()), format!("likelihood: {name}{halves}")));
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::{LEFT, RIGHT};
    use proptest::prelude::*;
    use sinew_core::math::Vec3;

    fn sample(time_s: f32, side: Side, status: Status) -> HandSample {
        HandSample {
            time_s,
            side,
            status,
            hand_px: Some(Pixel::new(100.0 + 60.0 * time_s, 200.0 - 50.0 * time_s)),
            hand_m: Some(Vec3::new(0.0, 0.0, 1.2 + 0.1 * time_s)),
            likelihood: 0.8,
            hand_std_m: 0.03,
            effective_sample_size: 40.0,
        }
    }

    fn count(image: &RgbImage, colour: image::Rgb<u8>, columns: std::ops::Range<u32>) -> usize {
        image.enumerate_pixels().filter(|(x, _, pixel)| columns.contains(x) && **pixel == colour).count()
    }

    #[test]
    fn a_hand_appears_in_its_colour_in_path_and_panels() {
        let samples: Vec<_> = (0..30).map(|i| sample(i as f32 / 10.0, Side::Left, Status::Tracking)).collect();
        let image = hand_plot(&samples, (320, 240)).unwrap();
        assert_eq!(image.dimensions(), SIZE_PX);
        assert!(count(&image, LEFT, 0..PATH_WIDTH_PX) > 200);
        assert!(count(&image, LEFT, PATH_WIDTH_PX..SIZE_PX.0) > 1000);
        assert_eq!(count(&image, RIGHT, 0..SIZE_PX.0), 0);
    }

    #[test]
    fn a_lost_hand_leaves_only_shading() {
        let samples: Vec<_> = (0..30).map(|i| sample(i as f32 / 10.0, Side::Right, Status::Lost)).collect();
        let image = hand_plot(&samples, (320, 240)).unwrap();
        assert_eq!(count(&image, RIGHT, PATH_WIDTH_PX..SIZE_PX.0), 0);
        let empty = hand_plot(&[], (320, 240)).unwrap();
        let tinted = |image: &RgbImage| image.pixels().filter(|p| p[2] > p[0].saturating_add(40)).count();
        assert!(tinted(&image) > tinted(&empty) + 20_000);
    }

    #[test]
    fn spans_of_status_meet_midway() {
        let samples = [(0.0, Status::Tracking), (1.0, Status::Tracking), (2.0, Status::Lost), (3.0, Status::Predicted)];
        let spans = status_spans(&samples.map(|(time_s, status)| sample(time_s, Side::Left, status)));
        let expected = [(Status::Tracking, 0.0, 1.5), (Status::Lost, 1.5, 2.5), (Status::Predicted, 2.5, 3.0)];
        assert_eq!(spans, expected);
    }

    #[test]
    fn the_same_samples_give_the_same_bytes() {
        let samples = [sample(0.0, Side::Left, Status::Tracking), sample(0.5, Side::Right, Status::Predicted)];
        let plot = || hand_plot(&samples, (640, 480)).unwrap();
        assert_eq!(plot().as_raw(), plot().as_raw());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn no_samples_make_it_panic(
            rows in prop::collection::vec((any::<[f32; 8]>(), 0_u8..3, any::<bool>()), 0..12), size: (u32, u32),
        ) {
            let samples: Vec<_> = rows.into_iter().map(|(x, status, left)| HandSample {
                time_s: x[0],
                side: if left { Side::Left } else { Side::Right },
                status: [Status::Tracking, Status::Predicted, Status::Lost][usize::from(status)],
                hand_px: Some(Pixel::new(x[1], x[2])),
                hand_m: Some(Vec3::new(x[3], x[4], x[5])),
                likelihood: x[6],
                hand_std_m: x[7],
                effective_sample_size: x[0],
            }).collect();
            prop_assert_eq!(hand_plot(&samples, size).unwrap().dimensions(), SIZE_PX);
        }
    }
}
