//! Image files of a folder in natural order, and one file as 8-bit RGB.

use super::jpeg::reaches_end_of_image;
use super::video::is_video;
use crate::file::{FileError, read_bytes};
use crate::limits::{MAX_DECODE_BYTES, MAX_FILE_BYTES, MAX_SIDE_PX};
use crate::registry::{Kind, extensions, find};
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, RgbImage};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A folder or file that cannot be an input of a run.
#[derive(Debug, Error)]
pub enum InputError {
    /// Nothing is there.
    #[error("`{}`: there is no such folder or file; give a folder of images ({}) or a video ({})", .0.display(), extension_list(), extensions(&[Kind::Video]))]
    Missing(PathBuf),
    /// A file stands where a folder was needed.
    #[error("`{}` is not a folder; give the folder that holds the images", .0.display())]
    NotAFolder(PathBuf),
    /// The folder holds nothing at all.
    #[error("`{}` is empty; put images there ({})", .0.display(), extension_list())]
    Empty(PathBuf),
    /// The folder holds files, but none with an extension that is read.
    #[error("`{}` holds no image; files that end in {} are read, and it holds {found}", .folder.display(), extension_list())]
    NoImage {
        /// The folder.
        folder: PathBuf,
        /// What was found instead, in words.
        found: String,
    },
    /// Two images of one name, of which each could be the frame.
    #[error("`{}` holds `{}` and `{}`, which may be one frame twice; keep one of the kinds", .folder.display(), .names[0], .names[1])]
    Twins {
        /// The folder.
        folder: PathBuf,
        /// Their file names.
        names: [String; 2],
    },
    /// A single file whose extension is not read.
    #[error("`{}` is not an image that can be read; give one ({}), a folder of them, or a video", .0.display(), extension_list())]
    NotAnImage(PathBuf),
    /// The operating system refused to list the folder.
    #[error("`{}` cannot be listed: {source}; check its permissions", .folder.display())]
    Unlistable {
        /// The folder.
        folder: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
}

/// One image file that could not be read.
#[derive(Debug, Error)]
#[error("`{}` cannot be read as an image: {reason}", .path.display())]
pub struct ImageFileError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub reason: String,
    /// What the operating system refused; `None` for a file whose content is no picture.
    pub io: Option<ErrorKind>,
}

impl ImageFileError {
    /// Whether the operating system refused the file, whatever its content.
    #[must_use]
    pub fn is_io(&self) -> bool {
        self.io.is_some()
    }
}

/// What a command was given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ImageInput {
    /// A folder of images or one image: the files in natural order; never empty.
    Files(Vec<PathBuf>),
    /// A video.
    Video(PathBuf),
}

impl ImageInput {
    /// Accepts a folder (its images), a single image file, or a video.
    ///
    /// # Errors
    /// [`InputError`] as for [`list_images`], or if a single file's extension is not read.
    pub fn open(path: &Path) -> Result<Self, InputError> {
        if is_video(path) {
            return Ok(Self::Video(path.to_path_buf()));
        }
        if path.is_file() {
            if !has_image_extension(path) {
                return Err(InputError::NotAnImage(path.to_path_buf()));
            }
            return Ok(Self::Files(vec![path.to_path_buf()]));
        }
        Ok(Self::Files(list_images(path)?))
    }
}

/// Lists the images directly in `folder` in natural order (`frame_2` before `frame_10`).
///
/// Hidden files, folders and files with other extensions are passed over.
///
/// # Errors
/// [`InputError`] if the folder is missing, not a folder, empty, cannot be listed, holds no image,
/// or two of one name.
pub fn list_images(folder: &Path) -> Result<Vec<PathBuf>, InputError> {
    if !folder.exists() {
        return Err(InputError::Missing(folder.to_path_buf()));
    }
    if !folder.is_dir() {
        return Err(InputError::NotAFolder(folder.to_path_buf()));
    }
    let unlistable = |source| InputError::Unlistable { folder: folder.to_path_buf(), source };
    let mut images = Vec::new();
    let mut others: BTreeMap<String, usize> = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(unlistable)? {
        let path = entry.map_err(unlistable)?.path();
        if is_hidden(&path) {
            continue;
        }
        if path.is_file() && has_image_extension(&path) {
            images.push(path);
        } else {
            *others.entry(kind_in_words(&path)).or_default() += 1;
        }
    }
    if !images.is_empty() {
        images.sort_by(|a, b| natural_order(a, b));
        return match twins(&images) {
            Some(names) => Err(InputError::Twins { folder: folder.to_path_buf(), names }),
            None => Ok(images),
        };
    }
    if others.is_empty() {
        return Err(InputError::Empty(folder.to_path_buf()));
    }
    let found = others.iter().map(|(kind, count)| format!("{count} {kind}")).collect::<Vec<_>>().join(", ");
    Err(InputError::NoImage { folder: folder.to_path_buf(), found })
}

/// Decodes one image to 8-bit RGB; 16-bit samples are scaled, grey is spread, alpha is dropped. A
/// picture that a camera took sideways is turned upright by its EXIF orientation.
///
/// The format is found from the file's content, so a JPEG named `.png` is read too.
///
/// # Errors
/// [`ImageFileError`] if the file cannot be opened, is truncated, is not an image, or is larger
/// than [`MAX_SIDE_PX`].
pub fn load_rgb(path: &Path) -> Result<RgbImage, ImageFileError> {
    let failed = |reason: String| ImageFileError { path: path.to_path_buf(), reason, io: None };
    let bytes = read_bytes(path, MAX_FILE_BYTES).map_err(|error| match error {
        FileError::Io(refusal) => ImageFileError { io: Some(refusal.kind()), ..failed(refusal.to_string()) },
        other => failed(other.to_string()),
    })?;
    let mut reader =
        ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(|error| failed(error.to_string()))?;
    if reader.format() == Some(ImageFormat::Jpeg) && !reaches_end_of_image(&bytes) {
        return Err(failed("it is truncated: its end-of-image marker is missing".to_owned()));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE_PX);
    limits.max_image_height = Some(MAX_SIDE_PX);
    limits.max_alloc = Some(MAX_DECODE_BYTES);
    reader.limits(limits);
    let image = upright(reader).map_err(|error| failed(error.to_string()))?.into_rgb8();
    if image.width() == 0 || image.height() == 0 {
        return Err(failed("it has no pixels".to_owned()));
    }
    Ok(image)
}

/// Decodes a picture and turns it as its EXIF orientation says.
fn upright(reader: ImageReader<Cursor<&Vec<u8>>>) -> image::ImageResult<DynamicImage> {
    let mut decoder = reader.into_decoder()?;
    let orientation = decoder.orientation()?;
    let mut image = DynamicImage::from_decoder(decoder)?;
    image.apply_orientation(orientation);
    Ok(image)
}

/// Width and height by the file's header, upright, pixels; `None` where even that cannot be read.
#[must_use]
pub fn size_by_header(path: &Path) -> Option<(u32, u32)> {
    let mut decoder = ImageReader::open(path).ok()?.with_guessed_format().ok()?.into_decoder().ok()?;
    let (width, height) = decoder.dimensions();
    let is_turned = matches!(
        decoder.orientation().ok()?,
        Orientation::Rotate90 | Orientation::Rotate270 | Orientation::Rotate90FlipH | Orientation::Rotate270FlipH
    );
    Some(if is_turned { (height, width) } else { (width, height) })
}

/// Whether the name ends as that of an image, in any case.
#[must_use]
pub fn has_image_extension(path: &Path) -> bool {
    find(path, &[Kind::Image]).is_some()
}

/// The first two names that differ in nothing but their extensions.
fn twins(images: &[PathBuf]) -> Option<[String; 2]> {
    let mut by_stem: BTreeMap<_, &PathBuf> = BTreeMap::new();
    images.iter().find_map(|image| {
        let other = by_stem.insert(image.file_stem(), image)?;
        Some([other, image].map(|path| path.file_name().unwrap_or_default().to_string_lossy().into_owned()))
    })
}

fn natural_order(a: &Path, b: &Path) -> std::cmp::Ordering {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    natord::compare(&name(a), &name(b)).then_with(|| a.cmp(b))
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

fn kind_in_words(path: &Path) -> String {
    if path.is_dir() {
        return "folder(s)".to_owned();
    }
    path.extension().map_or_else(
        || "file(s) without extension".to_owned(),
        |extension| format!("*.{} file(s)", extension.to_string_lossy()),
    )
}

fn extension_list() -> String {
    extensions(&[Kind::Image])
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, GrayImage, ImageBuffer, Luma, Rgba, RgbaImage};

    fn names(files: &[PathBuf]) -> Vec<String> {
        files.iter().map(|file| file.file_name().unwrap().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn order_is_natural_and_other_files_are_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["frame_10.png", "frame_2.PNG", "frame_1.jpeg", ".hidden.png", "notes.txt", "a.PpM"] {
            fs::write(folder.path().join(name), b"").unwrap();
        }
        fs::create_dir(folder.path().join("folder.png")).unwrap();
        let files = list_images(folder.path()).unwrap();
        assert_eq!(names(&files), ["a.PpM", "frame_1.jpeg", "frame_2.PNG", "frame_10.png"]);
    }

    #[test]
    fn two_images_of_one_name_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["frame_0.png", "frame_1.png", "frame_1.jpg"] {
            fs::write(folder.path().join(name), b"").unwrap();
        }
        let message = list_images(folder.path()).unwrap_err().to_string();
        assert!(message.contains("`frame_1.jpg` and `frame_1.png`"), "{message}");
    }

    #[test]
    fn a_picture_is_turned_as_its_orientation_says() {
        // An application segment of EXIF with one entry: orientation (0x0112), a SHORT, 6: the
        // picture has to be turned by 90 degrees clockwise.
        let exif: [u8; 36] = [
            0xff, 0xe1, 0, 34, b'E', b'x', b'i', b'f', 0, 0, b'M', b'M', 0, 42, 0, 0, 0, 8, 0, 1, 0x01, 0x12, 0, 3, 0,
            0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0,
        ];
        let image = RgbImage::from_fn(64, 32, |x, _| image::Rgb([if x < 32 { 250 } else { 5 }; 3]));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        let mut bytes = bytes.into_inner();
        bytes.splice(2..2, exif);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sideways.jpg");
        fs::write(&path, bytes).unwrap();
        assert_eq!(size_by_header(&path), Some((32, 64)));
        let upright = load_rgb(&path).unwrap();
        assert_eq!(upright.dimensions(), (32, 64));
        assert!(upright.get_pixel(16, 4)[0] > 200 && upright.get_pixel(16, 60)[0] < 50, "left has become the top");
    }

    #[test]
    fn each_bad_folder_says_what_is_wrong() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| list_images(path).unwrap_err().to_string();
        assert!(message(&folder.path().join("nowhere")).contains("no such folder"));
        assert!(message(folder.path()).contains("is empty"));
        let text = folder.path().join("notes.TXT");
        fs::write(&text, b"words").unwrap();
        assert!(message(&text).contains("not a folder"));
        let found = message(folder.path());
        assert!(found.contains("1 *.TXT file(s)") && found.contains(".jpeg"), "{found}");
        assert!(ImageInput::open(&text).unwrap_err().to_string().contains("not an image"));
    }

    #[test]
    fn sixteen_bits_grey_and_alpha_become_rgb8() {
        let folder = tempfile::tempdir().unwrap();
        let deep: ImageBuffer<Luma<u16>, Vec<u16>> = ImageBuffer::from_pixel(3, 2, Luma([0x8080]));
        let cases = [
            ("deep.png", DynamicImage::ImageLuma16(deep), [128, 128, 128]),
            ("grey.pgm", DynamicImage::ImageLuma8(GrayImage::from_pixel(3, 2, Luma([7]))), [7, 7, 7]),
            ("clear.png", DynamicImage::ImageRgba8(RgbaImage::from_pixel(3, 2, Rgba([1, 2, 3, 0]))), [1, 2, 3]),
        ];
        for (name, image, expected) in cases {
            let path = folder.path().join(name);
            image.save(&path).unwrap();
            let rgb = load_rgb(&path).unwrap();
            assert_eq!(rgb.dimensions(), (3, 2));
            assert!(rgb.pixels().all(|pixel| pixel.0 == expected), "{name}");
        }
    }

    #[test]
    fn a_truncated_file_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["cut.png", "cut.jpg"] {
            let path = folder.path().join(name);
            let noisy = RgbImage::from_fn(64, 64, |x, y| image::Rgb([(x * y) as u8, (x * 7) as u8, (y * 13) as u8]));
            noisy.save(&path).unwrap();
            let bytes = fs::read(&path).unwrap();
            fs::write(&path, &bytes[..bytes.len() / 3]).unwrap();
            match load_rgb(&path) {
                Err(error) => assert!(error.to_string().contains(name)),
                Ok(_) => panic!("{name} was read in spite of missing bytes"),
            }
        }
        fs::write(folder.path().join("empty.png"), b"").unwrap();
        assert!(!load_rgb(&folder.path().join("empty.png")).unwrap_err().is_io());
        assert!(load_rgb(&folder.path().join("missing.png")).unwrap_err().is_io());
        assert!(load_rgb(folder.path()).unwrap_err().is_io());
    }

    #[test]
    fn a_picture_beyond_the_limits_is_refused_by_its_header() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wide.png");
        GrayImage::new(MAX_SIDE_PX + 1, 1).save(&path).unwrap();
        let error = load_rgb(&path).unwrap_err();
        assert!(!error.is_io() && error.to_string().contains("wide.png"), "{error}");
        GrayImage::new(MAX_SIDE_PX, 1).save(&path).unwrap();
        assert!(load_rgb(&path).is_ok());
    }
}
