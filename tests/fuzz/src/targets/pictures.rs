//! Readers of pictures.

use crate::Target;
use crate::file::file;
use crate::numbers::Numbers;
use image::{DynamicImage, GrayImage, ImageFormat, Rgb, RgbImage, RgbaImage};
use sinew_core::checksum::crc32;
use sinew_formats::images::load_rgb;
use sinew_formats::limits::MAX_SIDE_PX;
use std::io::Cursor;

/// PNG, JPEG and the PNM family.
pub const TARGETS: &[Target] = &[
    Target { name: "png", run: png, seeds: || pictures(ImageFormat::Png) },
    Target { name: "jpeg", run: load, seeds: || pictures(ImageFormat::Jpeg) },
    Target { name: "pnm", run: load, seeds: pnms },
];

fn drawn() -> RgbImage {
    RgbImage::from_fn(24, 17, |x, y| Rgb([(x * y) as u8, (x * 7) as u8, (y * 13) as u8]))
}

fn written(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("memory takes it");
    bytes.into_inner()
}

fn pictures(format: ImageFormat) -> Vec<Vec<u8>> {
    let colour = DynamicImage::ImageRgb8(drawn());
    let grey = DynamicImage::ImageLuma8(GrayImage::from_fn(9, 40, |x, y| image::Luma([(x * y) as u8])));
    let mut all = vec![written(&colour, format), written(&grey, format)];
    if format == ImageFormat::Png {
        all.push(written(&DynamicImage::ImageRgba8(RgbaImage::new(5, 5)), format));
        all.push(written(&DynamicImage::ImageRgb16(colour.to_rgb16()), format));
    }
    all
}

fn pnms() -> Vec<Vec<u8>> {
    let texts = ["P1\n3 2\n1 0 1\n0 1 0\n", "P2\n# grey\n3 2 255\n1 2 3\n4 5 6\n", "P3 1 2 255\n1 2 3 4 5 6\n"];
    let raw: [&[u8]; 4] = [
        b"P4\n9 2\n\xa0\x80\x50\x00",
        b"P5 3 2 255\nabcdef",
        b"P6\n1 2\n65535\nabcdefabcdef",
        b"P7\nWIDTH 1\nHEIGHT 2\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\nabcdef",
    ];
    texts.iter().map(|text| text.as_bytes().to_vec()).chain(raw.map(<[u8]>::to_vec)).collect()
}

fn load(bytes: &[u8]) {
    // The reader goes by the content, not by the name.
    let Ok(image) = load_rgb(&file("picture.png", bytes)) else { return };
    assert!((1..=MAX_SIDE_PX).contains(&image.width()) && (1..=MAX_SIDE_PX).contains(&image.height()));
}

/// As it is, and with sound checksums: otherwise nothing gets past them.
fn png(bytes: &[u8]) {
    load(bytes);
    load(&with_checksums(bytes));
}

fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut png = bytes.to_vec();
    let mut at = 8;
    while let Some(length) = png.get(at..at + 4) {
        let length = u32::from_be_bytes(length.try_into().unwrap_or_default()) as usize;
        let Some(chunk) = png.get(at + 4..at + 8 + length) else { break };
        let sum = crc32(chunk).to_be_bytes();
        let end = at + 8 + length;
        let Some(place) = png.get_mut(end..end + 4) else { break };
        place.copy_from_slice(&sum);
        at = end + 4;
    }
    png
}

/// A small picture whose blocks of 4 x 4 pixels have colours from `numbers`: skin, grey or any.
pub fn picture(numbers: &mut Numbers<'_>) -> RgbImage {
    let (width, height) = (1 + numbers.below(64) as u32, 1 + numbers.below(64) as u32);
    let blocks: Vec<[u8; 3]> = (0..width.div_ceil(4) * height.div_ceil(4))
        .map(|_| match numbers.byte() {
            0..=99 => [60, 90, 140],
            100..=199 => [180, 124, 96],
            _ => [numbers.byte(), numbers.byte(), numbers.byte()],
        })
        .collect();
    RgbImage::from_fn(width, height, |x, y| Rgb(blocks[(y / 4 * width.div_ceil(4) + x / 4) as usize]))
}
