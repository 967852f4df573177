//! The places of markers in the frames of a C3D file.

use super::layout::Layout;
use sinew_core::math::Vec3;

impl Layout {
    /// Where `point` is in `frame`, in the file's unit. `None` has a negative residual, which
    /// stands for a marker that was not seen.
    pub fn place(&self, bytes: &[u8], frame: usize, point: usize) -> Option<Vec3> {
        let at = self.data_at + frame * self.frame_bytes + point * 4 * self.number_bytes;
        if self.number_bytes == 2 { self.scaled(bytes, at) } else { self.real(bytes, at) }
    }

    /// Three whole numbers in steps of the scale. The sign of a fourth one and its lower byte hold
    /// the residual.
    fn scaled(&self, bytes: &[u8], at: usize) -> Option<Vec3> {
        let number = |index: usize| Some(self.words.u16(bytes, at + 2 * index)?.cast_signed());
        let residual = number(3)?;
        if residual < 0 && low_byte(residual) < 0 {
            return None;
        }
        let scale = self.scale.abs();
        Some(Vec3::new(f32::from(number(0)?) * scale, f32::from(number(1)?) * scale, f32::from(number(2)?) * scale))
    }

    /// Three reals; the whole part of a fourth one holds the residual in steps of the scale.
    fn real(&self, bytes: &[u8], at: usize) -> Option<Vec3> {
        let number = |index: usize| self.words.f32(bytes, at + 4 * index);
        let is_missing = self.scale != 0.0 && low_byte(number(3)? as i16) < 0;
        if is_missing { None } else { Some(Vec3::new(number(0)?, number(1)?, number(2)?)) }
    }
}

fn low_byte(word: i16) -> i8 {
    word.to_le_bytes()[0].cast_signed()
}
