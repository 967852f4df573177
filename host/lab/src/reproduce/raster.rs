//! SVG documents as pictures of print quality (feature `png`).

use anyhow::{Context, Result};
use image::RgbImage;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// Width of a picture, pixels: 18 cm, the width of a printed page, at 300 dots an inch.
const WIDTH_PX: f32 = 2126.0;

/// Draws `svg` on white, with the letters that the binary holds.
///
/// # Errors
/// No valid SVG, or one without an extent.
pub fn to_picture(svg: &str) -> Result<RgbImage> {
    let mut options = Options { font_family: "Ubuntu".into(), ..Options::default() };
    let fonts = options.fontdb_mut();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let tree = Tree::from_str(svg, &options).context("no valid SVG")?;
    let size = tree.size();
    let scale = WIDTH_PX / size.width();
    let (width, height) = (WIDTH_PX as u32, (scale * size.height()).ceil() as u32);
    let mut map = Pixmap::new(width, height).context("an SVG without extent")?;
    map.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut map.as_mut());
    let rgb: Vec<u8> = map.data().chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    RgbImage::from_raw(width, height, rgb).context("a picture whose bytes are not three a pixel")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::plot::{Plot, Series};
    use image::Rgb;

    #[test]
    fn a_plot_becomes_a_picture_with_curves_and_letters() {
        let points = vec![(1.0, 1.0, 0.2), (2.0, 2.0, 0.0)];
        let plot = |title: &str| Plot {
            title: title.into(),
            series: vec![Series { name: "a".into(), points: points.clone() }],
            ..Plot::default()
        };
        let [plain, titled] = ["", "Figure 13: error"].map(|title| to_picture(&plot(title).to_svg()).unwrap());
        assert_eq!(plain.width(), 2126);
        assert_eq!(*plain.get_pixel(0, 0), Rgb([255; 3]));
        let ink = |picture: &RgbImage| picture.pixels().filter(|pixel| pixel.0.iter().all(|c| *c < 100)).count();
        // Nothing but the title differs: letters of some thousand pixels.
        let letters = ink(&titled) - ink(&plain);
        assert!((1_000..60_000).contains(&letters), "{letters} pixels");
        // The curve's blue.
        assert!(plain.pixels().any(|pixel| *pixel == Rgb([0x00, 0x72, 0xb2])));
        assert!(to_picture("<svg").is_err());
    }
}
