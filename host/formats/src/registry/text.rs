//! Lists of endings for help, errors and other texts.

use super::format::Kind;
use super::lookup::{endings, formats};

/// The endings of `kinds`: `.png, .jpg, .jpeg`.
#[must_use]
pub fn extensions(kinds: &[Kind]) -> String {
    dotted(kinds).join(", ")
}

/// The endings of `kinds` with their notes: `.bvh, .amc, .txt (exponential maps)`.
#[must_use]
pub fn described(kinds: &[Kind]) -> String {
    with_notes(kinds).join(", ")
}

/// As [`described`], for one of them: `.bvh, .amc or .txt (exponential maps)`.
#[must_use]
pub fn choice(kinds: &[Kind]) -> String {
    let all = with_notes(kinds);
    match all.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

fn dotted(kinds: &[Kind]) -> Vec<String> {
    endings(kinds).map(|extension| format!(".{extension}")).collect()
}

fn with_notes(kinds: &[Kind]) -> Vec<String> {
    let noted = |extension: &str, note: &str| match note {
        "" => format!(".{extension}"),
        note => format!(".{extension} ({note})"),
    };
    formats(kinds)
        .flat_map(|format| format.extensions.iter().map(move |extension| noted(extension, format.note)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::lookup::MOTION;
    use super::*;

    #[test]
    fn lists_read_as_sentences_need_them() {
        assert_eq!(extensions(&[Kind::Image]), ".png, .jpg, .jpeg, .ppm, .pgm, .pnm, .pbm");
        assert_eq!(described(MOTION), ".bvh, .amc, .txt (exponential maps), .trc, .c3d");
        assert_eq!(choice(&[Kind::JointMotion]), ".bvh, .amc or .txt (exponential maps)");
        assert_eq!(choice(&[Kind::Skeleton]), ".asf");
        assert_eq!(choice(&[]), "");
    }
}
