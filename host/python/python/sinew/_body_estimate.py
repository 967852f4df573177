"""What is known of a body in one frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._points import PointArray

_SHIFTS = 3
_COORDINATES = {"whole": list(range(30)), "upper": _sinew.UPPER_BODY_COORDINATES}


class FirstPose(NamedTuple):
    """The pose of a body in its first cloud, and how sure it is which way they face."""

    pose: npt.NDArray[np.float32]
    """Coordinates in the order of :data:`sinew.BODY_COORDINATE_NAMES`, (30,) metres and radians."""
    facing_margin: float
    """Log-likelihood of a point, on the mean, over that with the person facing the other way."""
    is_facing_doubtful: bool
    """Whether that is so little that the person may face the other way."""


@dataclass(frozen=True, eq=False)
class BodyEstimate:
    """What is known of a frame from those up to it; k is 17 joints, or 9 of an upper body."""

    frame: int
    """Number of the frame, counted from 0."""
    time_s: float
    """Its time, seconds: as given, or frames since the last given one over the rate."""
    part: str
    """``"whole"`` or ``"upper"``."""
    pose: npt.NDArray[np.float32]
    """Coordinates in the order of :data:`sinew.BODY_COORDINATE_NAMES`, (30,) metres and radians."""
    joints_m: PointArray
    """Ends of the bones in the order of :data:`sinew.BODY_JOINT_NAMES`, (k, 3), camera axes."""
    spread_m: npt.NDArray[np.float32]
    """Standard deviation of each end over the particles, (k,) metres."""
    observed: npt.NDArray[np.bool_]
    """Whether points show the bone that ends there, (k,)."""
    ambiguous: npt.NDArray[np.float32]
    """Weight of the particles that put it more than 10 cm from ``joints_m``, (k,), [0, 1]."""
    effective_sample_size: float
    """How many particles carry the weight."""
    log_evidence: float
    """Log-likelihood of the points under the prediction."""
    tempering: float
    """Exponent of the likelihood, (0, 1]; below 1 where few particles would carry all weight."""
    is_degenerate: bool
    """Whether no particle fitted: the frame counts as one without points."""
    points: int
    """Points that were weighed."""
    skipped_points: int
    """Points left out: not finite, within 1 cm of the camera, or farther than 1 km."""
    points_over_cap: int
    """Points left out at random, since a frame had more than 20,000."""

    @property
    def root_m(self) -> npt.NDArray[np.float32]:
        """Place of the pelvis, (3,) metres."""
        return self.pose[:_SHIFTS]

    @property
    def angles_rad(self) -> dict[str, float]:
        """Angles by name, radians; those of the tracked part."""
        names, pose = _sinew.BODY_COORDINATES, self.pose
        return {names[index]: float(pose[index]) for index in _COORDINATES[self.part][_SHIFTS:]}

    def to_pose(self) -> dict[str, float]:
        """All coordinates by name, as ``first_pose.json`` and ``first_pose`` have them."""
        return dict(zip(_sinew.BODY_COORDINATES, self.pose.tolist()))
