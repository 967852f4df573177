//! Whether a JPEG file reaches its end: decoders fill what is missing with grey, which a tracker
//! must not take for a picture.

/// Start of image, ITU-T T.81 table B.1.
const START_OF_IMAGE: u8 = 0xD8;
/// End of image.
const END_OF_IMAGE: u8 = 0xD9;
/// Start of scan: entropy-coded data follow its header.
const START_OF_SCAN: u8 = 0xDA;

/// Whether the markers of a JPEG stream (ITU-T T.81 annex B) reach the end-of-image marker.
///
/// Thumbnails inside application segments are stepped over; bytes after the end are allowed.
#[must_use]
pub fn reaches_end_of_image(bytes: &[u8]) -> bool {
    if bytes.len() < 2 || bytes[0] != 0xFF || bytes[1] != START_OF_IMAGE {
        return false;
    }
    let mut at = 2;
    while let Some(found) = next_marker(bytes, at) {
        match bytes[found] {
            END_OF_IMAGE => return true,
            START_OF_SCAN | 0xC0..=0xCF | 0xDB..=0xEF | 0xFE => {
                let Some(length) = bytes.get(found + 1..found + 3) else { return false };
                at = found + 1 + usize::from(u16::from_be_bytes([length[0], length[1]]));
            }
            _ => at = found + 1,
        }
    }
    false
}

/// Index of the code byte of the first marker at or after `at`; stuffed zeros and restart markers
/// are data.
fn next_marker(bytes: &[u8], at: usize) -> Option<usize> {
    let code_is_marker = |code: u8| code != 0 && code != 0xFF && !(0xD0..=0xD7).contains(&code);
    (at..bytes.len().saturating_sub(1)).find(|&i| bytes[i] == 0xFF && code_is_marker(bytes[i + 1])).map(|i| i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, RgbImage};
    use std::io::Cursor;

    fn encoded() -> Vec<u8> {
        let image = RgbImage::from_fn(40, 30, |x, y| image::Rgb([(x * y) as u8, (x * 7) as u8, (y * 13) as u8]));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_whole_stream_reaches_its_end_also_with_trailing_bytes() {
        let mut bytes = encoded();
        assert!(reaches_end_of_image(&bytes));
        bytes.extend([1, 2, 3]);
        assert!(reaches_end_of_image(&bytes));
    }

    #[test]
    fn no_proper_prefix_reaches_its_end() {
        let bytes = encoded();
        for length in 0..bytes.len() {
            assert!(!reaches_end_of_image(&bytes[..length]), "prefix of {length} bytes");
        }
    }

    #[test]
    fn an_end_marker_inside_an_application_segment_does_not_count() {
        let mut bytes = vec![0xFF, 0xD8, 0xFF, 0xE1, 0x00, 0x06, 0xFF, 0xD9, 0xFF, 0xD9];
        assert!(!reaches_end_of_image(&bytes));
        bytes.extend([0xFF, 0xD9]);
        assert!(reaches_end_of_image(&bytes));
    }
}
