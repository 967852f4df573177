//! Skin by either of two persons' tables: that of the face, and that of a click.

use crate::frame::MAX_SIDE_PX;
use sinew_core::vision::mask::words_per_row;
use sinew_core::vision::skin::SkinClassifier;
use sinew_face::PersonSkin;

/// Skin is what one of both takes for it.
#[derive(Debug)]
pub struct EitherSkin<'a> {
    /// That of the face.
    pub of_face: &'a PersonSkin,
    /// That of a click on the hand.
    pub of_click: Option<&'a PersonSkin>,
}

impl SkinClassifier for EitherSkin<'_> {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        self.of_face.classify_line(rgb, bits);
        let Some(of_click) = self.of_click else { return };
        let mut others = [0; words_per_row(MAX_SIDE_PX)];
        of_click.classify_line(rgb, &mut others);
        bits.iter_mut().zip(others).for_each(|(word, other)| *word |= other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_core::vision::objects::person_colour::PersonColour;

    #[test]
    fn skin_is_what_either_takes_for_it() {
        let [face, glove] = [[200, 150, 125], [200, 60, 60]]
            .map(|colour| PersonSkin::new(PersonColour::of_face(&[colour; 60]).unwrap()));
        // Of the face, a wall, a red glove.
        let line = [200, 150, 125, 70, 90, 110, 200, 60, 60];
        for (of_click, expected) in [(Some(&glove), 0b101), (None, 0b001)] {
            let mut bits = [7];
            EitherSkin { of_face: &face, of_click }.classify_line(&line, &mut bits);
            assert_eq!(bits, [expected]);
        }
    }
}
