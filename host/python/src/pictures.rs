//! Images: arrays of lines, pixels and red, green and blue.

use crate::errors::{exception, wrong};
use crate::process::detached;
use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray3};
use pyo3::prelude::*;
use sinew::blob_rows::{BlobRow, COLUMNS, blobs_alone};
use sinew::error::{Error, Result};
use sinew::frames::FrameReader;
use sinew::images::load_rgb;
use sinew::pixels::PictureView;
use sinew::skin::{BitImage, Rectangle, SkinModel};
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use std::path::PathBuf;

/// A parameter that is an image.
pub type Image<'py> = PyReadonlyArray3<'py, u8>;

/// The pixels of an array, which Python has made contiguous, without a copy.
pub fn picture<'a>(image: &'a Image<'_>) -> PyResult<PictureView<'a>> {
    let [height, width, channels] = *image.as_array().shape() else {
        return Err(wrong("image", "has to have the shape (height, width, 3)"));
    };
    let sides = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let pixels = image.as_slice().ok().zip(sides).filter(|_| channels == 3);
    let view = pixels.and_then(|(pixels, (width, height))| PictureView::from_raw(width, height, pixels));
    view.ok_or_else(|| wrong("image", "has to have the shape (height, width, 3), without gaps"))
}

/// A rectangle of pixels: column, row, width and height.
pub fn rectangle(calibrate: Option<[u32; 4]>) -> PyResult<Option<Rectangle>> {
    match calibrate {
        Some([_, _, 0, _] | [_, _, _, 0]) => Err(wrong("calibrate", "has no pixels: give x, y, width and height")),
        Some([x_px, y_px, width_px, height_px]) => Ok(Some(Rectangle { x_px, y_px, width_px, height_px })),
        None => Ok(None),
    }
}

/// The pixels of an image file.
#[pyfunction]
pub fn read_image(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray3<u8>>> {
    let image = detached(py, || load_rgb(&path))?.map_err(|error| exception(&error.into()))?;
    let shape = (image.height() as usize, image.width() as usize, 3);
    // As many bytes as the image has.
    Ok(Array3::from_shape_vec(shape, image.into_raw()).unwrap_or_default().into_pyarray(py))
}

/// Does what `sinew segment` does with one image.
#[pyfunction]
pub fn segment_skin<'py>(
    py: Python<'py>,
    image: Image<'py>,
    skin: &str,
    calibrate: Option<[u32; 4]>,
    raw: bool,
) -> PyResult<Bound<'py, PyArray2<bool>>> {
    let (picture, rectangle) = (picture(&image)?, rectangle(calibrate)?);
    let mask = || -> Result<BitImage> {
        let mut mask = model(skin, &picture, rectangle)?.classify(&picture)?;
        if !raw {
            mask.clean()?;
        }
        Ok(mask)
    };
    let mask = detached(py, mask)?.map_err(|error| exception(&error))?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let rows = mask.words().chunks_exact(mask.words().len() / height);
    let bits = |row: &[u32]| -> Vec<bool> { (0..width).map(|u| row[u / 32] >> (u % 32) & 1 == 1).collect() };
    let mask = Array2::from_shape_vec((height, width), rows.flat_map(bits).collect()).unwrap_or_default();
    Ok(mask.into_pyarray(py))
}

/// Names of the columns of [`find_blobs`].
pub fn blob_columns() -> &'static [&'static str] {
    &COLUMNS[2..]
}

/// Does what `sinew blobs` does with one image: a row a blob, and how many were left out.
#[pyfunction]
pub fn find_blobs<'py>(
    py: Python<'py>,
    image: Image<'py>,
    skin: &str,
    calibrate: Option<[u32; 4]>,
) -> PyResult<(Bound<'py, PyArray2<f64>>, u32)> {
    const CELLS: usize = COLUMNS.len() - 2;
    let (picture, rectangle) = (picture(&image)?, rectangle(calibrate)?);
    let rows = || -> Result<(Vec<[f64; CELLS]>, u32)> {
        let (model, likelihood) = (model(skin, &picture, rectangle)?, HandLikelihood::default());
        let mut reader = FrameReader::new(likelihood, EdgeDetector::default())?;
        let view = blobs_alone(&mut reader, &model, &picture)?;
        let area_px = picture.width() * picture.height();
        let blobs = view.blobs.iter().enumerate();
        let rows = blobs.map(|(number, blob)| BlobRow::new(("", number), blob, likelihood, area_px).numbers());
        Ok((rows.collect(), view.dropped_blobs))
    };
    let (rows, dropped) = detached(py, rows)?.map_err(|error| exception(&error))?;
    Ok((crate::arrays::array(py, rows.into_iter()), dropped))
}

/// The skin model of a name or file, adapted to an image if that is asked for.
fn model(skin: &str, image: &PictureView<'_>, rectangle: Option<Rectangle>) -> Result<SkinModel> {
    let model = SkinModel::from_option(skin)?;
    rectangle.map_or(Ok(model.clone()), |rectangle| model.calibrated(image, rectangle).map_err(calibration))
}

/// A rectangle that an image does not fit is a wrong parameter.
pub fn calibration(error: Error) -> Error {
    Error::Option(error.chain())
}
