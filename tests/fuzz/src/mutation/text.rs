//! Changes of words, numbers and lines.

use super::repeated;
use crate::random::Random;
use std::ops::Range;

/// What is put in the place of a word.
const WORDS: [&[u8]; 38] = [
    b"",
    b"-1",
    b"0",
    b"-0",
    b"1",
    b"1e308",
    b"-1e38",
    b"3.4e38",
    b"1e-45",
    b"1e9",
    b"-1000000000",
    b"inf",
    b"-inf",
    b"NaN",
    b"99999999999999999999",
    b"18446744073709551615",
    b"4294967295",
    b"2147483648",
    b"65536",
    b"100000",
    b"1.",
    b".5",
    b"1e999999999",
    b"}",
    b"{",
    b"]",
    b"[[",
    b"null",
    b"true",
    b"\"x\"",
    b"=",
    b"\n\n",
    b"\r",
    b"\t",
    b"\0",
    b"\xef\xbb\xbf",
    b"\xff",
    "\u{e9}\u{1f600}".as_bytes(),
];
/// Most repetitions of a line or word.
const MAX_REPETITIONS: usize = 300;

/// Changes `input`; `other` is another valid input.
pub fn change(input: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    match random.below(8) {
        0 | 1 => {
            let place = one_word(input, random);
            input.splice(place, random.choose(&WORDS).iter().copied());
        }
        2 => {
            let digits = number(random);
            let place = one_word(input, random);
            input.splice(place, digits);
        }
        3 => {
            let source = if random.one_in(2) { input.as_slice() } else { other };
            let word = source[one_word(source, random)].to_vec();
            let place = one_word(input, random);
            input.splice(place, word);
        }
        4 => {
            let place = one_line(input, random);
            drop(input.drain(place));
        }
        5 => {
            let place = one_line(input, random);
            let times = if random.one_in(4) { random.below(MAX_REPETITIONS) } else { 1 };
            let copies = repeated(&input[place.clone()], times);
            input.splice(place.end..place.end, copies);
        }
        6 => {
            let line = other[one_line(other, random)].to_vec();
            let place = one_line(input, random);
            input.splice(place.start..place.start, line);
        }
        _ => {
            let place = one_word(input, random);
            let copies = repeated(&input[place.clone()], random.below(MAX_REPETITIONS));
            input.splice(place.end..place.end, copies);
        }
    }
}

/// A number of any size in digits.
fn number(random: &mut Random) -> Vec<u8> {
    let bits = random.bits();
    let text = match random.below(5) {
        0 => format!("{}", bits % 10),
        1 => format!("{}", (bits >> random.below(64)).cast_signed()),
        2 => format!("{:?}", f32::from_bits(bits as u32)),
        3 => format!("{:?}", (bits >> 40) as f32 / 1000.0 - 8000.0),
        _ => format!("{:e}", f64::from_bits(bits)),
    };
    text.into_bytes()
}

/// Where a word lies: letters, digits and what is part of numbers.
fn one_word(text: &[u8], random: &mut Random) -> Range<usize> {
    let is_inside = |byte: &u8| byte.is_ascii_alphanumeric() || b"+-._".contains(byte);
    let mut at = random.below(text.len());
    // From between two words to the next one.
    at += text.iter().skip(at).take_while(|byte| !is_inside(byte)).count();
    let before = text[..at].iter().rev().take_while(|byte| is_inside(byte)).count();
    let after = text[at..].iter().take_while(|byte| is_inside(byte)).count();
    at - before..at + after
}

/// Where a line lies, with its end.
fn one_line(text: &[u8], random: &mut Random) -> Range<usize> {
    let at = random.below(text.len());
    let start = text[..at].iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let end = text[at..].iter().position(|byte| *byte == b'\n').map_or(text.len(), |end| at + end + 1);
    start..end
}
