//! Curves with error bars as SVG. A curve has a dash pattern and a mark of its own, so that no
//! legend relies on colour alone.

use std::fmt::Write;

/// Width and height of a plot, units of the view box.
const SIZE: (f64, f64) = (720.0, 408.0);
/// More height where values of x have names.
const NAMES_HEIGHT: f64 = 60.0;
/// The plot's own area: left, top, right, bottom.
const AREA: (f64, f64, f64, f64) = (70.0, 40.0, 500.0, 350.0);
/// Colours that stay apart for colour-blind people (Okabe and Ito's set without yellow).
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#141414"];
/// Dash patterns; with seven colours no pair comes twice below 35 curves.
const DASHES: [&str; 5] = ["", "8 3", "2 3", "10 3 2 3", "5 5"];

/// One curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// x, y and half the length of the error bar, which may be zero.
    pub points: Vec<(f64, f64, f64)>,
}

/// A plot. Its y axis begins at zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plot {
    /// Above it.
    pub title: String,
    /// x axis with its unit.
    pub x_label: String,
    /// y axis with its unit.
    pub y_label: String,
    /// Names of x = 0, 1, ...; with them the values stand apart, without a line between them.
    pub x_names: Vec<String>,
    /// Whether the x axis is logarithmic.
    pub log_x: bool,
    /// What the error bars are.
    pub bars: String,
    /// The curves.
    pub series: Vec<Series>,
}

/// Where values are drawn.
struct Scale {
    x: (f64, f64),
    y: (f64, f64),
    log_x: bool,
}

impl Scale {
    fn of(plot: &Plot) -> Self {
        let points = || plot.series.iter().flat_map(|series| &series.points);
        let along = |x: f64| if plot.log_x { x.max(1.0e-9).log10() } else { x };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        points().for_each(|(x, _, _)| (low, high) = (low.min(along(*x)), high.max(along(*x))));
        let margin = (0.04 * (high - low)).max(1.0e-3);
        let top = points().map(|(_, y, half)| y + half).fold(0.0, f64::max);
        let bottom = points().map(|(_, y, half)| y - half).fold(0.0, f64::min);
        Self { x: (low - margin, high + margin), y: (1.06 * bottom, (1.06 * top).max(1.0e-9)), log_x: plot.log_x }
    }

    fn x_px(&self, x: f64) -> f64 {
        let x = if self.log_x { x.max(1.0e-9).log10() } else { x };
        AREA.0 + (x - self.x.0) / (self.x.1 - self.x.0) * (AREA.2 - AREA.0)
    }

    fn y_px(&self, y: f64) -> f64 {
        AREA.3 - (y - self.y.0) / (self.y.1 - self.y.0) * (AREA.3 - AREA.1)
    }
}

/// Round values from `low` to `high`, some five of them.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    (first..).map(|index| index as f64 * step).take_while(|value| *value <= high + 1.0e-9 * step).collect()
}

/// `text` with the signs that HTML and SVG reserve written out.
#[must_use]
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A mark at a place; the shape goes by `index`.
fn mark(index: usize, x: f64, y: f64, colour: &str) -> String {
    match index % 5 {
        0 => format!("<circle cx='{x:.1}' cy='{y:.1}' r='4' fill='{colour}'/>"),
        1 => format!("<rect x='{:.1}' y='{:.1}' width='8' height='8' fill='{colour}'/>", x - 4.0, y - 4.0),
        2 => format!("<path d='M{x:.1} {:.1}l5 9h-10z' fill='{colour}'/>", y - 5.0),
        3 => format!(
            "<path d='M{x:.1} {:.1}l5 5l-5 5l-5 -5z' fill='white' stroke='{colour}' stroke-width='2'/>",
            y - 5.0
        ),
        _ => format!("<path d='M{:.1} {:.1}l8 8m0 -8l-8 8' stroke='{colour}' stroke-width='2'/>", x - 4.0, y - 4.0),
    }
}

impl Plot {
    /// The plot as an SVG document that also stands inside HTML.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let scale = Scale::of(self);
        let mut svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' font-family='sans-serif' font-size='12' role='img'>\
             <rect width='100%' height='100%' fill='white'/><text x='{}' y='22' font-size='14'>{}</text>\n",
            SIZE.0,
            SIZE.1 + self.names_height(),
            AREA.0,
            escaped(&self.title)
        );
        self.axes(&scale, &mut svg);
        for (index, series) in self.series.iter().enumerate() {
            curve((index, self.x_names.is_empty()), series, &scale, &mut svg);
        }
        if !self.bars.is_empty() {
            let y = SIZE.1 + self.names_height() - 6.0;
            let _ = writeln!(svg, "<text x='{}' y='{y}' font-size='11'>Bars: {}</text>", AREA.0, escaped(&self.bars));
        }
        svg.push_str("</svg>\n");
        svg
    }

    const fn names_height(&self) -> f64 {
        if self.x_names.is_empty() { 0.0 } else { NAMES_HEIGHT }
    }

    fn axes(&self, scale: &Scale, svg: &mut String) {
        let (left, top, right, bottom) = AREA;
        for y in ticks(scale.y.0, scale.y.1) {
            let at = scale.y_px(y);
            let _ = writeln!(
                svg,
                "<path d='M{left} {at:.1}H{right}' stroke='#ddd'/><text x='{}' y='{:.1}' text-anchor='end'>{}</text>",
                left - 6.0,
                at + 4.0,
                (y * 1.0e6).round() / 1.0e6
            );
        }
        self.x_ticks(scale, svg);
        let _ = writeln!(
            svg,
            "<path d='M{left} {top}V{bottom}H{right}' fill='none' stroke='black'/>\
             <text x='{}' y='{}' text-anchor='middle'>{}</text>\
             <text transform='translate(16 {}) rotate(-90)' text-anchor='middle'>{}</text>",
            0.5 * (left + right),
            bottom + 33.0 + self.names_height(),
            escaped(&self.x_label),
            0.5 * (top + bottom),
            escaped(&self.y_label)
        );
    }

    fn x_ticks(&self, scale: &Scale, svg: &mut String) {
        let bottom = AREA.3;
        let mut tick = |x: f64, placed: &dyn Fn(f64) -> String| {
            let at = scale.x_px(x);
            let _ = writeln!(svg, "<path d='M{at:.1} {bottom}v5' stroke='black'/><text {}</text>", placed(at));
        };
        if !self.x_names.is_empty() {
            for (index, name) in self.x_names.iter().enumerate() {
                let name = escaped(name);
                let turned = |at| {
                    format!("transform='translate({at:.1} {}) rotate(-45)' text-anchor='end'>{name}", bottom + 16.0)
                };
                tick(index as f64, &turned);
            }
            return;
        }
        let mut xs: Vec<f64> = self.series.iter().flat_map(|series| &series.points).map(|point| point.0).collect();
        xs.sort_by(f64::total_cmp);
        // Values that come by way of radians differ in their last digits.
        xs.dedup_by(|a, b| (*a - *b).abs() < 1.0e-6);
        let xs = if self.log_x && xs.len() <= 10 { xs } else { ticks(scale.x.0, scale.x.1) };
        for x in xs {
            let value = (x * 1.0e6).round() / 1.0e6;
            tick(x, &|at| format!("x='{at:.1}' y='{}' text-anchor='middle'>{value}", bottom + 18.0));
        }
    }
}

fn curve((index, has_line): (usize, bool), series: &Series, scale: &Scale, svg: &mut String) {
    let (colour, dash) = (COLOURS[index % COLOURS.len()], DASHES[index % DASHES.len()]);
    let stroke = format!("fill='none' stroke='{colour}' stroke-width='2' stroke-dasharray='{dash}'");
    let place = |&(x, y, _): &(f64, f64, f64)| (scale.x_px(x), scale.y_px(y));
    let line: Vec<String> = series.points.iter().map(place).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    if has_line {
        let _ = writeln!(svg, "<polyline points='{}' {stroke}/>", line.join(" "));
    }
    // A line of many points needs no marks.
    let is_marked = series.points.len() <= 40;
    for point in series.points.iter().filter(|_| is_marked) {
        let (x, y) = place(point);
        if point.2 > 0.0 {
            let (low, high) = (scale.y_px(point.1 - point.2), scale.y_px(point.1 + point.2));
            let _ = writeln!(
                svg,
                "<path d='M{x:.1} {low:.1}V{high:.1}M{0:.1} {low:.1}h8M{0:.1} {high:.1}h8' stroke='{colour}'/>",
                x - 4.0
            );
        }
        svg.push_str(&mark(index, x, y, colour));
    }
    let y = AREA.1 + 18.0 * index as f64;
    let x = AREA.2 + 14.0;
    if has_line {
        let _ = writeln!(svg, "<path d='M{x} {y}h30' {stroke}/>");
    }
    if is_marked {
        svg.push_str(&mark(index, x + 15.0, y, colour));
    }
    let _ = writeln!(svg, "<text x='{}' y='{}'>{}</text>", x + 38.0, y + 4.0, escaped(&series.name));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(0.0, 10.0), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(-0.3, 1.05), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn curves_differ_by_mark_and_dash_and_names_are_escaped() {
        let series = |name: &str| Series { name: name.into(), points: vec![(10.0, 1.0, 0.2), (100.0, 2.0, 0.0)] };
        let plot = Plot { series: vec![series("a < b"), series("c")], log_x: true, ..Plot::default() };
        let svg = plot.to_svg();
        assert!(svg.contains("a &lt; b") && svg.contains("<circle") && svg.contains("<rect x="), "{svg}");
        assert!(svg.contains("stroke-dasharray=''") && svg.contains("stroke-dasharray='8 3'"), "{svg}");
        assert_eq!(svg.matches("h8M").count(), 2, "one bar a curve: the other points have none");
    }

    #[test]
    fn named_values_have_no_line_between_them() {
        let series = vec![Series { name: "a".into(), points: vec![(0.0, 1.0, 0.1), (1.0, 2.0, 0.1)] }];
        let names = vec!["neck".to_owned(), "knee".to_owned()];
        let svg = Plot { series: series.clone(), x_names: names, ..Plot::default() }.to_svg();
        assert!(svg.contains("neck") && svg.contains("rotate(-45)") && !svg.contains("<polyline"), "{svg}");
        assert!(Plot { series, ..Plot::default() }.to_svg().contains("<polyline"));
    }

    #[test]
    fn the_origin_of_y_is_zero_and_x_is_logarithmic_where_asked() {
        let points = vec![(10.0, 1.0, 0.0), (100.0, 4.0, 0.0), (1000.0, 2.0, 0.0)];
        let plot = Plot { series: vec![Series { name: String::new(), points }], log_x: true, ..Plot::default() };
        let scale = Scale::of(&plot);
        assert_eq!(scale.y_px(0.0), AREA.3);
        let [a, b, c] = [10.0, 100.0, 1000.0].map(|x| scale.x_px(x));
        assert!(((b - a) - (c - b)).abs() < 1.0e-6 && a > AREA.0 && c < AREA.2);
    }
}
