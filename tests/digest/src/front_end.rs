//! The front end on made-up camera lines: discs of skin before a wall with noise.

use super::SEED;
use super::bits::Bits;
use sinew_core::error::ParameterError;
use sinew_core::random::Stream;
use sinew_core::vision::components::BoundingBox;
use sinew_core::vision::front_end::calibration::SkinSample;
use sinew_core::vision::front_end::edge_lines::EdgeSteps;
use sinew_core::vision::front_end::pixel_format::{PixelFormat, Rgb565, Yuyv};
use sinew_core::vision::front_end::skin_table::SkinTable;
use sinew_core::vision::front_end::{FrameLines, LineFrontEnd};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::skin::GaussianSkin;

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
/// Room for 160 x 120 pixels; noise makes more edges than fit.
type FrontEnd = LineFrontEnd<5, 20, 12, 6, 256, 60>;

/// A colour of a format: both pixels of a pair, and what noise may change of each.
#[derive(Debug, Clone, Copy)]
struct Palette {
    skin: [u16; 2],
    walls: [[u16; 2]; 4],
    noise: u16,
}

/// R, G, B of skin about (200, 140, 103), walls from dark to light.
const RGB565: Palette =
    Palette { skin: [0xcc6c; 2], walls: [[0x39c7; 2], [0x6b6d; 2], [0x4a89; 2], [0x8c71; 2]], noise: 0x0821 };
/// The same as Y with U on the left and V on the right.
const YUYV: Palette = Palette {
    skin: [0x6f91, 0xa691],
    walls: [[0x8038, 0x8038], [0x806a, 0x806a], [0x7c4c, 0x8050], [0x808c, 0x808c]],
    noise: 0x0003,
};

/// Digest of blobs, edges and losses; half of the frames in each format, the tables adapted to the
/// scene on the way.
pub fn digest(frames: u32) -> Result<u64, ParameterError> {
    let mut bits = Bits::new();
    read::<Rgb565>(frames / 2, &RGB565, |seen| take(&mut bits, seen))?;
    read::<Yuyv>(frames - frames / 2, &YUYV, |seen| take(&mut bits, seen))?;
    Ok(bits.digest())
}

/// Reads frames of one format and hands on what each shows. What the table learns shows in the
/// blobs.
fn read<F: PixelFormat>(
    frames: u32,
    palette: &Palette,
    mut sink: impl FnMut(&FrameLines<'_>),
) -> Result<(), ParameterError> {
    let trained = GaussianSkin::new(0.45, 0.316, [0.0017, 0.0, 0.0002], 2.25, 215)?;
    let mut skin = SkinTable::<F>::new();
    skin.learn(&trained);
    let mut front_end = FrontEnd::new((WIDTH, HEIGHT), HandLikelihood::default(), EdgeSteps::default())?;
    for frame in 0..frames {
        let discs = discs(frame);
        let [u, v, radius] = discs[0].map(|value| value as u16);
        let inside =
            BoundingBox { min_u: u - radius / 2, min_v: v - radius / 2, max_u: u + radius / 2, max_v: v + radius / 2 };
        let mut sample = (frame % 100 == 50).then(|| SkinSample::<F, 128>::new(inside));
        front_end.begin_frame();
        for v in 0..HEIGHT {
            if frame % 40 == 7 && v % 31 == 5 {
                continue;
            }
            let line = line(palette, &discs, frame, v);
            front_end.line(v, &line, &skin);
            if let Some(sample) = &mut sample {
                sample.line(v, &line);
            }
        }
        sink(&front_end.end_frame());
        if let Some(sample) = sample {
            skin.learn(&sample.adapted(&trained)?);
        }
    }
    Ok(())
}

/// Column, row and radius of two hands and a face; the hands go to and fro.
fn discs(frame: u32) -> [[i32; 3]; 3] {
    let to_and_fro = |step: u32, way: u32| {
        let at = frame * step % (2 * way);
        at.min(2 * way - at) as i32
    };
    [[30 + to_and_fro(3, 100), 80 + to_and_fro(1, 20), 14], [130 - to_and_fro(2, 90), 60, 11], [80, 26, 17]]
}

/// Line `v` of a frame.
fn line(palette: &Palette, discs: &[[i32; 3]; 3], frame: u32, v: usize) -> [u16; WIDTH] {
    let mut stream = Stream::new(SEED, u64::from(frame), v as u32);
    let mut line = [0; WIDTH];
    let (mut wall, mut noise) = (palette.walls[0], 0);
    for (u, pixel) in line.iter_mut().enumerate() {
        if u % 8 == 0 {
            wall = palette.walls[(u / 16 + v / 12 + frame as usize / 60) % palette.walls.len()];
            noise = stream.bits();
        }
        *pixel = wall[u & 1] ^ (noise as u16 & palette.noise);
        noise = noise.rotate_right(3);
    }
    for &[cu, cv, radius] in discs {
        let square = radius * radius - (v as i32 - cv) * (v as i32 - cv);
        let half = (0..=radius).take_while(|half| half * half <= square).last().unwrap_or(-1);
        for u in cu - half..=cu + half {
            if let Some(pixel) = line.get_mut(u as usize) {
                *pixel = palette.skin[u as usize & 1] ^ (*pixel & palette.noise);
            }
        }
    }
    line
}

fn take(bits: &mut Bits, seen: &FrameLines<'_>) {
    for blob in seen.blobs {
        bits.word(blob.area_px);
        bits.pixel(blob.centroid);
        bits.numbers(&blob.moments_px2);
        bits.numbers(&[blob.perimeter_px, blob.moment_likelihood]);
        let corners =
            [blob.bounding_box.min_u, blob.bounding_box.min_v, blob.bounding_box.max_u, blob.bounding_box.max_v];
        corners.iter().for_each(|&corner| bits.word(u32::from(corner)));
    }
    seen.edges.iter().for_each(|edge| bits.word(u32::from(edge.u) << 16 | u32::from(edge.v)));
    bits.count(seen.candidates.len());
    let losses = seen.losses;
    bits.word(losses.dropped_components);
    bits.word(losses.dropped_px);
    bits.word(losses.dropped_blobs);
    bits.word(losses.dropped_edges);
    bits.word(losses.missing_lines);
    bits.word(losses.ignored_lines);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shows<F: PixelFormat>(palette: &Palette) {
        let (mut blobs, mut edges) = (0, 0);
        read::<F>(120, palette, |seen| (blobs, edges) = (blobs + seen.blobs.len(), edges + seen.edges.len())).unwrap();
        assert!((240..480).contains(&blobs) && edges > 120 * 20, "{blobs} blobs, {edges} edges");
    }

    #[test]
    fn the_stream_shows_discs_that_move() {
        shows::<Rgb565>(&RGB565);
        shows::<Yuyv>(&YUYV);
    }
}
