//! A person's colour as a table that classifies a pixel by one look.

use crate::FoundFace;
use sinew_core::vision::objects::person_colour::PersonColour;
use sinew_core::vision::skin::{PIXELS_PER_WORD, SkinClassifier};

/// Bits of a channel that are looked at: with five, three in a hundred palms more are missed.
const BITS: u32 = 6;
/// Words of the table: one bit a colour.
const WORDS: usize = 1 << (3 * BITS - 5);

/// The skin of one person.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonSkin {
    colour: PersonColour,
    words: Vec<u32>,
}

impl PersonSkin {
    /// The table of a colour.
    #[must_use]
    pub fn new(colour: PersonColour) -> Self {
        let middle = |key: usize, channel: u32| {
            let level = key >> (BITS * channel) & ((1 << BITS) - 1);
            (level << (8 - BITS) | 1 << (7 - BITS)) as u8
        };
        let is_skin = |key: usize| colour.is_skin([middle(key, 2), middle(key, 1), middle(key, 0)]);
        let word = |index: usize| (0..32).fold(0, |word, bit| word | u32::from(is_skin(32 * index + bit)) << bit);
        Self { colour, words: (0..WORDS).map(word).collect() }
    }

    /// Takes the colour of a face: the first one as it is, a later one in part.
    pub fn learn(skin: &mut Option<Self>, face: &FoundFace) {
        let colour = match (&skin, face.colour) {
            (Some(skin), Some(colour)) => skin.colour.moved_to(&colour),
            (None, colour) => colour,
            (Some(_), None) => None,
        };
        if let Some(colour) = colour {
            *skin = Some(Self::new(colour));
        }
    }

    /// The colour.
    #[must_use]
    pub fn colour(&self) -> &PersonColour {
        &self.colour
    }
}

impl SkinClassifier for PersonSkin {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        bits.fill(0);
        for (word, pixels) in bits.iter_mut().zip(rgb.as_chunks::<3>().0.chunks(PIXELS_PER_WORD)) {
            for (place, pixel) in pixels.iter().enumerate() {
                let [r, g, b] = pixel.map(|channel| usize::from(channel >> (8 - BITS)));
                let key = (r << BITS | g) << BITS | b;
                *word |= (self.words[key / 32] >> (key % 32) & 1) << place;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_decides_as_the_colour_does() {
        let face: Vec<[u8; 3]> = (0..200).map(|i| [190 + (i % 13) as u8, 140 + (i % 11) as u8, 120]).collect();
        let skin = PersonSkin::new(PersonColour::of_face(&face).unwrap());
        // Colours in the middle of their cells.
        let line: Vec<u8> = (0..64 * 3).map(|i| ((i * 37) % 256) as u8 & 0xfc | 2).collect();
        let mut bits = [0; 2];
        skin.classify_line(&line, &mut bits);
        for (index, pixel) in line.as_chunks::<3>().0.iter().enumerate() {
            assert_eq!(bits[index / 32] >> (index % 32) & 1 == 1, skin.colour().is_skin(*pixel), "{pixel:?}");
        }
        skin.classify_line(&[195, 145, 120].repeat(40), &mut bits);
        assert_eq!(bits, [u32::MAX, 0xff]);
    }
}
