//! How large a file, and what is in it, may be. `docs/limits.md` lists these limits.

/// Largest binary file that is read, and largest content of a compressed one, bytes. Chosen: ten
/// times the largest point cloud of a frame; any value from 100 MB serves.
pub const MAX_FILE_BYTES: u64 = 1 << 30;
/// Largest text file that is read, bytes. Chosen: an hour of motion as BVH takes some 200 MB.
pub const MAX_TEXT_BYTES: u64 = 1 << 28;
/// Longest line of a text file that is read line by line, bytes. Chosen: a row of 1000 markers
/// takes 40 kB.
pub const MAX_LINE_BYTES: usize = 1 << 20;
/// Largest amount of a number in a file of motion or keypoints, in the file's own units. Chosen:
/// 1000 km in millimetres; squares of such numbers are finite in single precision.
pub const MAX_NUMBER: f32 = 1.0e9;
/// Largest number of joints between a skeleton's root and its ends. Chosen: bodies with fingers
/// have 12; any value up to 1000 serves.
pub const MAX_SKELETON_DEPTH: usize = 256;
/// Largest number of joints or bones of a skeleton. Chosen: bodies with hands and
/// face have 300.
pub const MAX_JOINTS: usize = 4096;
/// Longest name of a joint in a skeleton, bytes. Chosen: names with namespaces have 60.
pub const MAX_NAME_BYTES: usize = 256;
/// Positions (joints times frames) that a motion may have beyond one for each byte of its file. A
/// frame gives a number and a space for each joint, but joints at ends need none. Chosen: any small
/// motion is within.
pub const FREE_POSITIONS: usize = 100_000;
/// Largest width or height of a picture that is decoded, pixels: what a mask of the core can hold.
pub const MAX_SIDE_PX: u32 = sinew_core::vision::mask::MAX_SIDE_PX as u32;
/// Largest memory that decoding one picture may take, bytes: 8192 x 8192 pixels of 4 channels of
/// 16 bits take half of it.
pub const MAX_DECODE_BYTES: u64 = 1 << 30;
/// Largest number of pixels of a depth image. Chosen: stereo cameras have 2.7 million, others less.
pub const MAX_DEPTH_PIXELS: u32 = 1 << 22;
/// Most characters that a message quotes of a file.
pub const MAX_QUOTED_CHARS: usize = 80;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_limits_states_them() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/limits.md");
        // The page is not part of the published crate.
        let Ok(page) = std::fs::read_to_string(page) else { return };
        for (what, limit) in [
            ("binary file", format!("{} MiB", MAX_FILE_BYTES >> 20)),
            ("text file", format!("{} MiB", MAX_TEXT_BYTES >> 20)),
            ("line of", format!("{} MiB", MAX_LINE_BYTES >> 20)),
            ("picture, width", format!("{MAX_SIDE_PX} pixels")),
            ("memory for decoding", format!("{} MiB", MAX_DECODE_BYTES >> 20)),
            ("pixels of a depth image", MAX_DEPTH_PIXELS.to_string()),
            ("number", format!("{MAX_NUMBER:e}")),
            ("joints or bones of", MAX_JOINTS.to_string()),
            ("depth of a skeleton", MAX_SKELETON_DEPTH.to_string()),
            ("name of a joint", format!("{MAX_NAME_BYTES} bytes")),
            ("joints times frames", format!("{FREE_POSITIONS}")),
            ("text of a file that", format!("{MAX_QUOTED_CHARS} characters")),
        ] {
            let row = page.lines().find(|line| line.starts_with(&format!("| {what}")));
            let row = row.unwrap_or_else(|| panic!("no row of {what}"));
            assert!(row.contains(&limit), "{row} does not state {limit}");
        }
    }
}
