//! The blobs of an image that is taken alone, as rows of a table.

use crate::error::Result;
use crate::frames::{FrameReader, FrameView};
use crate::pixels::{Picture, Pixels};
use crate::skin::SkinModel;
use serde::Serialize;
use sinew_core::vision::blobs::LikelyBlob;
use sinew_core::vision::hand_likelihood::{HandLikelihood, LikelihoodForm};

/// One blob: a row of the table, the most likely blob of an image first.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct BlobRow<'a> {
    /// File name of the image.
    pub image: &'a str,
    /// Number of the blob in its image, from 0.
    pub blob: usize,
    /// That it is a hand, 0..=1.
    pub hand_likelihood: f32,
    /// Hand likelihood in the form printed in the paper.
    pub paper_likelihood: f32,
    /// Number of pixels.
    pub area_px: u32,
    /// Mean column.
    pub centroid_u_px: f32,
    /// Mean row.
    pub centroid_v_px: f32,
    /// First column.
    pub left_px: u16,
    /// First row.
    pub top_px: u16,
    /// Columns of the bounding box.
    pub width_px: u32,
    /// Rows of the bounding box.
    pub height_px: u32,
    /// Length of the outline.
    pub perimeter_px: f32,
    /// Largest distance of a pixel from the outline.
    pub dt_max_px: f32,
    /// How round it is, from area, perimeter and that distance.
    pub centrality: f32,
    /// Overlap with the ellipse of its moments, 0..=1.
    pub ellipse_iou: f32,
    /// As `area_px`, with holes filled.
    pub filled_area_px: f32,
    /// As `perimeter_px`, with holes filled.
    pub filled_perimeter_px: f32,
    /// As `dt_max_px`, with holes filled.
    pub filled_dt_max_px: f32,
    /// As `centrality`, with holes filled.
    pub filled_centrality: f32,
    /// As `ellipse_iou`, with holes filled.
    pub filled_ellipse_iou: f32,
    /// Column of the palm's middle.
    pub palm_u_px: f32,
    /// Row of the palm's middle.
    pub palm_v_px: f32,
    /// Variance of the columns.
    pub moment_uu_px2: f32,
    /// Covariance of columns and rows.
    pub moment_uv_px2: f32,
    /// Variance of the rows.
    pub moment_vv_px2: f32,
}

/// Columns of the table, which has a header even if there is no blob.
pub const COLUMNS: [&str; 25] = [
    "image",
    "blob",
    "hand_likelihood",
    "paper_likelihood",
    "area_px",
    "centroid_u_px",
    "centroid_v_px",
    "left_px",
    "top_px",
    "width_px",
    "height_px",
    "perimeter_px",
    "dt_max_px",
    "centrality",
    "ellipse_iou",
    "filled_area_px",
    "filled_perimeter_px",
    "filled_dt_max_px",
    "filled_centrality",
    "filled_ellipse_iou",
    "palm_u_px",
    "palm_v_px",
    "moment_uu_px2",
    "moment_uv_px2",
    "moment_vv_px2",
];

/// What `image` shows without regard to others, in whose light `model` is used.
///
/// # Errors
/// An image with a side above the core's limit.
pub fn blobs_alone(reader: &mut FrameReader, model: &SkinModel, image: &Picture<impl Pixels>) -> Result<FrameView> {
    reader.forget_last_frame();
    reader.read(image, &*model.for_image(image)?)
}

impl<'a> BlobRow<'a> {
    /// The row of a blob: name of the image and number in it, and the area of the whole image.
    #[must_use]
    pub fn new(
        (image, number): (&'a str, usize),
        entry: &LikelyBlob,
        likelihood: HandLikelihood,
        image_area_px: u32,
    ) -> Self {
        let blob = &entry.blob;
        let (bounds, palm) = (blob.bounding_box, blob.palm_centre());
        Self {
            image,
            blob: number,
            hand_likelihood: entry.likelihood,
            paper_likelihood: likelihood.with_form(LikelihoodForm::Paper).evaluate(blob, image_area_px as f32),
            area_px: blob.area_px,
            centroid_u_px: blob.centroid.u_px,
            centroid_v_px: blob.centroid.v_px,
            left_px: bounds.min_u,
            top_px: bounds.min_v,
            width_px: bounds.width_px(),
            height_px: bounds.height_px(),
            perimeter_px: blob.plain.perimeter_px,
            dt_max_px: blob.plain.dt_max_px,
            centrality: blob.plain.centrality(),
            ellipse_iou: blob.plain.ellipse_iou,
            filled_area_px: blob.filled.area_px,
            filled_perimeter_px: blob.filled.perimeter_px,
            filled_dt_max_px: blob.filled.dt_max_px,
            filled_centrality: blob.filled.centrality(),
            filled_ellipse_iou: blob.filled.ellipse_iou,
            palm_u_px: palm.u_px,
            palm_v_px: palm.v_px,
            moment_uu_px2: blob.moments_px2[0],
            moment_uv_px2: blob.moments_px2[1],
            moment_vv_px2: blob.moments_px2[2],
        }
    }

    /// The cells of the row after `image` and `blob`, in the order of [`COLUMNS`].
    #[must_use]
    pub fn numbers(&self) -> [f64; COLUMNS.len() - 2] {
        [
            self.hand_likelihood.into(),
            self.paper_likelihood.into(),
            self.area_px.into(),
            self.centroid_u_px.into(),
            self.centroid_v_px.into(),
            self.left_px.into(),
            self.top_px.into(),
            self.width_px.into(),
            self.height_px.into(),
            self.perimeter_px.into(),
            self.dt_max_px.into(),
            self.centrality.into(),
            self.ellipse_iou.into(),
            self.filled_area_px.into(),
            self.filled_perimeter_px.into(),
            self.filled_dt_max_px.into(),
            self.filled_centrality.into(),
            self.filled_ellipse_iou.into(),
            self.palm_u_px.into(),
            self.palm_v_px.into(),
            self.moment_uu_px2.into(),
            self.moment_uv_px2.into(),
            self.moment_vv_px2.into(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbImage;
    use sinew_core::vision::edges::EdgeDetector;

    #[test]
    fn the_header_names_the_fields_in_order() {
        let blob = LikelyBlob { likelihood: 0.5, ..a_blob() };
        let row = BlobRow::new(("a.png", 0), &blob, HandLikelihood::default(), 10_000);
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.serialize(row).unwrap();
        let text = String::from_utf8(writer.into_inner().unwrap()).unwrap();
        assert_eq!(text.lines().next().unwrap(), COLUMNS.join(","));
        let cells = text.lines().nth(1).unwrap().split(',').skip(2);
        let printed: Vec<f32> = cells.map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(printed, row.numbers().map(|number| number as f32));
    }

    fn a_blob() -> LikelyBlob {
        let mut reader = FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap();
        let skin = SkinModel::from_option("gaussian").unwrap();
        let image = RgbImage::from_fn(90, 90, |u, v| {
            image::Rgb(if (20..60).contains(&u) && (20..60).contains(&v) { [196, 140, 115] } else { [90, 120, 200] })
        });
        blobs_alone(&mut reader, &skin, &image).unwrap().blobs[0]
    }
}
