//! What messages quote of a file, cut to a length that a person reads.

use crate::limits::MAX_QUOTED_CHARS;
use std::borrow::Cow;

/// Longest part of a message outside of quotes, characters. It is longer than any sentence here, so
/// what exceeds it is text of a file that has a backquote.
const MAX_PLAIN_CHARS: usize = 500;
/// Longest message, characters.
const MAX_MESSAGE_CHARS: usize = 2000;
/// Most names that a message lists.
const MAX_NAMES: usize = 40;

/// The beginning of `text`, at most [`MAX_QUOTED_CHARS`] characters, with the number of the others.
#[must_use]
pub fn excerpt(text: &str) -> Cow<'_, str> {
    cut(text, MAX_QUOTED_CHARS)
}

/// `message` with an [`excerpt`] of each part between backquotes.
#[must_use]
pub fn with_short_quotes(message: &str) -> String {
    let part = |(index, part)| cut(part, if index % 2 == 1 { MAX_QUOTED_CHARS } else { MAX_PLAIN_CHARS });
    let parts: Vec<Cow<'_, str>> = message.split('`').enumerate().map(part).collect();
    cut(&parts.join("`"), MAX_MESSAGE_CHARS).into_owned()
}

/// The first of `names` with commas between them, and how many more there are.
#[must_use]
pub fn listed(names: &[String]) -> String {
    let shown: Vec<Cow<'_, str>> = names.iter().take(MAX_NAMES).map(|name| excerpt(name)).collect();
    let more = names.len().saturating_sub(MAX_NAMES);
    let list = shown.join(", ");
    if more > 0 { format!("{list} and {more} more") } else { list }
}

fn cut(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}... ({} more)", &text[..end], text[end..].chars().count()).into(),
        None => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_texts_stay_and_long_ones_are_cut_between_characters() {
        assert_eq!(excerpt("left_wrist"), "left_wrist");
        assert_eq!(excerpt(&"ä".repeat(80)), "ä".repeat(80));
        assert_eq!(excerpt(&"ä".repeat(81)), format!("{}... (1 more)", "ä".repeat(80)));
    }

    #[test]
    fn only_quotes_of_a_message_are_cut() {
        let word = "x".repeat(50_000);
        assert_eq!(
            with_short_quotes(&format!("a number was expected, found `{word}`")),
            format!("a number was expected, found `{}... (49920 more)`", "x".repeat(80))
        );
        // A quote with a quote in it.
        assert!(with_short_quotes(&format!("found `{word}`{word}`")).chars().count() < 700);
        assert!(with_short_quotes(&"`a".repeat(50_000)).chars().count() < 2100);
    }

    #[test]
    fn lists_of_names_end() {
        let names: Vec<String> = (0..45).map(|index| format!("j{index}")).collect();
        assert_eq!(listed(&names[..2]), "j0, j1");
        assert!(listed(&names).ends_with("j39 and 5 more"));
    }
}
