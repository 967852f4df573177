//! Whether the first clouds of a run can be those of a person, in metres and in the camera's axes.

use super::inputs::BodyInputs;
use crate::body::first_points::{FirstPoints, UNIT_REMEDY};
use crate::error::Result;

/// Refuses clouds in other units or axes; looks at no more than `most` clouds. Warns of a person
/// who lies along the line of sight where an upright one is looked for.
pub(super) fn check_points(inputs: &mut BodyInputs, most: usize) -> Result<()> {
    let mut first = FirstPoints::default();
    for frame in inputs.clouds.frames.iter().take(most) {
        let Ok(cloud) = inputs.source.read_noting(&frame.path, |_| ()) else { continue };
        first.add(cloud);
        if first.is_complete() {
            break;
        }
    }
    let remedy = match inputs.source.camera {
        Some(_) => "give `depth_scale` of the camera's file as metres of a unit, or units of a metre",
        None => UNIT_REMEDY,
    };
    let of = format!(" of `{}`", inputs.files.clouds.display());
    first.check(&of, remedy)?;
    if inputs.first_rad.is_none() {
        inputs.warnings.extend(first.lies_along_sight(&of));
    }
    Ok(())
}
