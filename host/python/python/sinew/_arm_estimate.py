"""What an arm tracker answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ._arrays import FloatArray


@dataclass(frozen=True)
class ArmEstimate:
    """One arm in one frame: a row of the command's ``track.csv``.

    Axes are the camera's: x to the right, y down, z forward. Places and angles of a lost arm are
    NaN.
    """

    frame: int
    """Number of the frame, counted from 0."""
    time_s: float
    """When it was taken, seconds."""
    side: str
    """The person's own side, ``left`` or ``right``."""
    status: str
    """``tracking``: a blob that is likely a hand carries the estimate; ``uncertain``: another one
    does; ``predicted``: none does; ``lost``: none did for long."""
    shoulder_m: FloatArray
    """Shoulder, (3,) metres."""
    elbow_m: FloatArray
    """Elbow, (3,) metres."""
    hand_m: FloatArray
    """Middle of the hand, (3,) metres."""
    shoulder_px: FloatArray
    """Column and row of the shoulder, (2,) pixels."""
    elbow_px: FloatArray
    """Column and row of the elbow, (2,) pixels."""
    hand_px: FloatArray
    """Column and row of the hand, (2,) pixels."""
    angles_rad: FloatArray
    """Elevation, deviation, rotation and flexion, (4,) radians."""
    hand_std_m: float
    """Standard deviation of the hand, metres."""
    hand_likelihood: float
    """Likelihood of the blob that carries the estimate; 0 without one."""
    effective_sample_size: float
    """Effective sample size of the particles."""
    log_evidence: float
    """This frame's part of the log evidence."""
    degenerate: bool
    """Whether all weights were zero."""
    blob_count: int | None
    """Candidates for a hand in the frame; None where it is missing."""
    dropped_blobs: int
    """Blobs that found no room."""


class ArmPair(NamedTuple):
    """Both arms in one frame."""

    left: ArmEstimate
    """The person's left arm."""
    right: ArmEstimate
    """The person's right arm."""


@dataclass(frozen=True)
class ArmParticles:
    """The particles of one arm after a frame."""

    side: str
    """The person's own side."""
    weight: FloatArray
    """Weights, (n,), with the sum 1."""
    angles_rad: FloatArray
    """Elevation, deviation, rotation and flexion, (n, 4) radians."""
    elbow_m: FloatArray
    """Elbows, (n, 3) metres."""
    hand_m: FloatArray
    """Hands, (n, 3) metres."""
    driver_blob: npt.NDArray[np.int64]
    """Number of the blob that drove the particle, (n,), -1 without."""
