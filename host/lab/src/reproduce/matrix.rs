//! A matrix as SVG, its signs by colour and by stroke.

use std::fmt::Write;

/// Side of a cell, units of the view box.
const CELL: f64 = 18.0;
/// Room for names, left and above.
const NAMES: f64 = 130.0;
/// Entries of less size have no stroke.
/// Chosen: below it the colour is white to the eye.
const LEAST_SHOWN: f64 = 0.03;

/// Draws `rows`, whose entries are from -1 to 1, with `names` and lines between blocks of as many
/// rows as `blocks` says.
#[must_use]
pub fn matrix(names: &[&str], rows: &[Vec<f64>], blocks: &[usize]) -> String {
    let side = NAMES + CELL * rows.len() as f64;
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' font-family='sans-serif' font-size='11'>\
         <rect width='100%' height='100%' fill='white'/>\n",
        side + 10.0,
        side + 40.0
    );
    let at = |index: usize| NAMES + CELL * index as f64;
    for (index, name) in names.iter().enumerate().take(rows.len()) {
        let middle = at(index) + 0.5 * CELL + 4.0;
        let _ = writeln!(
            svg,
            "<text x='{}' y='{middle:.1}' text-anchor='end'>{name}</text>\
             <text transform='translate({middle:.1} {}) rotate(-90)'>{name}</text>",
            NAMES - 5.0,
            NAMES - 5.0
        );
    }
    for (i, row) in rows.iter().enumerate() {
        row.iter().enumerate().for_each(|(j, entry)| cell(&mut svg, (at(j), at(i)), *entry));
    }
    let mut begin = 0;
    for end in blocks.iter().scan(0, |sum, rows| {
        *sum += rows;
        Some(*sum)
    }) {
        let (low, size) = (at(begin), at(end) - at(begin));
        let _ = writeln!(svg, "<rect x='{low}' y='{low}' width='{size}' height='{size}' fill='none' stroke='black'/>");
        begin = end;
    }
    let size = side - NAMES;
    let _ = writeln!(svg, "<rect x='{NAMES}' y='{NAMES}' width='{size}' height='{size}' fill='none' stroke='black'/>");
    let y = side + 14.0;
    let mut x = 10.0;
    for (entry, name) in [(1.0, "1"), (0.3, "0.3"), (-0.3, "-0.3"), (-1.0, "-1 (negative: with a stroke)")] {
        cell(&mut svg, (x, y), entry);
        let _ = writeln!(svg, "<text x='{}' y='{}'>{name}</text>", x + CELL + 5.0, y + 13.0);
        x += 70.0;
    }
    svg.push_str("</svg>\n");
    svg
}

/// One entry: blue above zero, orange with a stroke below.
fn cell(svg: &mut String, (x, y): (f64, f64), entry: f64) {
    let colour = if entry < 0.0 { "#d55e00" } else { "#0072b2" };
    let _ = writeln!(
        svg,
        "<rect x='{x}' y='{y}' width='{CELL}' height='{CELL}' fill='{colour}' fill-opacity='{:.3}' stroke='#ddd'/>",
        entry.abs().min(1.0)
    );
    if entry < -LEAST_SHOWN {
        let _ = writeln!(svg, "<path d='M{} {}h{}' stroke='black'/>", x + 5.0, y + 0.5 * CELL, CELL - 10.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_entries_have_a_stroke_and_blocks_a_frame() {
        let rows = [vec![1.0, -0.5, 0.0], vec![-0.5, 1.0, 0.2], vec![0.0, 0.2, 1.0]];
        let svg = matrix(&["a", "b", "c"], &rows, &[2, 1]);
        // Two of the matrix and two of the legend.
        assert_eq!(svg.matches("h8' stroke='black'").count(), 4);
        assert_eq!(svg.matches("fill='none' stroke='black'").count(), 3, "two blocks and the whole");
        assert_eq!(svg.matches(">b</text>").count(), 2);
        assert!(svg.contains("fill-opacity='0.200'"));
    }
}
