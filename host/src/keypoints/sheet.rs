//! How a table writes cells: what separates them, and the decimal sign.

use crate::csv_text::separated_reader;

/// Form of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sheet {
    /// What separates cells: comma, semicolon or tab.
    pub separator: u8,
    /// Numbers have a comma before the decimals. Only where the separator is another sign.
    pub has_decimal_comma: bool,
}

/// How many lines show the form. Chosen: beyond headers of four rows, and before a long table.
const LOOKED_AT: usize = 50;

impl Sheet {
    /// The form of `text`: the separator is what its first line has most of.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let first = text.lines().next().unwrap_or("");
        let count = |separator: u8| first.bytes().filter(|byte| *byte == separator).count();
        let separator = [b',', b';', b'\t'].into_iter().rev().max_by_key(|separator| count(*separator)).unwrap_or(b',');
        let separator = if count(separator) == 0 { b',' } else { separator };
        let is_number = |cell: &str| {
            let mut parts = cell.trim().trim_start_matches('-').split(',');
            let whole = |part: Option<&str>| part.is_some_and(|part| part.bytes().all(|byte| byte.is_ascii_digit()));
            whole(parts.next()) && whole(parts.next()) && parts.next().is_none()
        };
        let mut cells = text.lines().skip(1).take(LOOKED_AT).flat_map(|line| line.split(char::from(separator)));
        Self { separator, has_decimal_comma: separator != b',' && cells.any(is_number) }
    }

    /// Records of `text`, the header's among them.
    pub(super) fn reader<'a>(&self, text: &'a str) -> csv::Reader<&'a [u8]> {
        separated_reader(text, self.separator)
    }

    /// The number in a cell: `Ok(None)` where it is empty or NaN.
    ///
    /// # Errors
    /// The cell is no finite number.
    pub fn number(&self, cell: &str) -> Result<Option<f64>, ()> {
        if cell.is_empty() || ["nan", "none", "null", "na", "n/a"].iter().any(|word| cell.eq_ignore_ascii_case(word)) {
            return Ok(None);
        }
        let parsed =
            if self.has_decimal_comma { cell.replacen(',', ".", 1).parse::<f64>() } else { cell.parse::<f64>() };
        parsed.ok().filter(|value| value.is_finite()).map(Some).ok_or(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separator_and_decimal_sign_follow_from_the_first_lines() {
        let comma = Sheet { separator: b',', has_decimal_comma: false };
        assert_eq!(Sheet::of("a,b\n1,2\n"), comma);
        assert_eq!(Sheet::of("a\n1\n"), comma);
        assert_eq!(Sheet::of("a;b\n1.5;2\n"), Sheet { separator: b';', has_decimal_comma: false });
        let decimal = Sheet::of("a;b\n1;\n-1,5;2\n");
        assert_eq!(decimal, Sheet { separator: b';', has_decimal_comma: true });
        assert_eq!(Sheet::of("a\tb\n1\t2\n").separator, b'\t');
        assert_eq!(decimal.number("-1,5"), Ok(Some(-1.5)));
        assert_eq!((decimal.number(""), decimal.number("NaN"), decimal.number("x")), (Ok(None), Ok(None), Err(())));
        assert_eq!((comma.number("inf"), comma.number("1e3")), (Err(()), Ok(Some(1000.0))));
    }
}
