//! Rounded numbers, which keep the text of the page short.

/// Rounds to tenths.
pub fn tenths<const N: usize>(numbers: [f32; N]) -> [f32; N] {
    numbers.map(|number| (10.0 * number).round() / 10.0)
}

/// Rounds to hundredths.
pub fn hundredths(number: f32) -> f32 {
    (100.0 * number).round() / 100.0
}
