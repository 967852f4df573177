//! Heels and toes beside the stick figure, which ends at the ankles.

/// Heel and toe of the left and the right foot in an image plane: x right, y down.
pub type Feet = [[Option<[f64; 2]>; 2]; 2];

/// Names of the points in the order of [`Feet`].
pub const FOOT_POINTS: [&str; 4] = ["l_heel", "l_toe", "r_heel", "r_toe"];

/// The same with the sign of x changed.
#[must_use]
pub fn x_negated(feet: &Feet) -> Feet {
    feet.map(|foot| foot.map(|point| point.map(|[x, y]| [-x, y])))
}

/// The same with the names of left and right exchanged.
#[must_use]
pub const fn sides_swapped(feet: &Feet) -> Feet {
    [feet[1], feet[0]]
}

/// Whether any point was seen.
#[must_use]
pub fn is_seen(feet: &Feet) -> bool {
    feet.as_flattened().iter().any(Option::is_some)
}

/// Columns of an angle table: where each point is in the image, in `unit`.
pub fn columns(unit: &str) -> impl Iterator<Item = String> {
    FOOT_POINTS.into_iter().flat_map(move |point| ["u", "v"].map(|axis| format!("{point}_{axis}_{unit}")))
}

/// Cells of [`columns`]; `side` is -1 for a person who faced left and was mirrored.
pub fn cells(feet: &Feet, side: f64) -> impl Iterator<Item = String> {
    let cell = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    let points = feet.as_flattened().to_vec();
    points.into_iter().flat_map(move |point| [point.map(|[x, _]| side * x), point.map(|[_, y]| y)].map(cell))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_where_the_points_were_in_the_image() {
        let feet: Feet = [[Some([1.0, 2.0]), None], [None, Some([3.0, 4.5])]];
        let names: Vec<String> = columns("px").collect();
        assert_eq!((names.len(), names[3].as_str(), names[4].as_str()), (8, "l_toe_v_px", "r_heel_u_px"));
        let mirrored: Vec<String> = cells(&x_negated(&feet), -1.0).collect();
        assert_eq!(mirrored, ["1.000", "2.000", "", "", "", "", "3.000", "4.500"]);
        assert_eq!(sides_swapped(&feet)[0][1], Some([3.0, 4.5]));
        assert!(is_seen(&feet) && !is_seen(&Feet::default()));
    }
}
