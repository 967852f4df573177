"""Joint angles of keypoints and of files."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import FloatArray, floats, is_path, positive


def layouts() -> list[str]:
    """Names of the layouts of keypoints that :func:`angles` takes."""
    return _sinew.layouts()


class Angles:
    """Joint angles of a recording; made by :func:`angles`."""

    __slots__ = ("_native", "angles_rad", "frame")

    def __init__(self, native: _sinew.Angles) -> None:
        self._native = native
        self.angles_rad: FloatArray = native.angles_rad
        """Angle of each segment in the image (x right, y down), (n, 13) radians, NaN missing."""
        self.frame: npt.NDArray[np.int64] = native.frame
        """Number of each frame, (n,)."""

    @property
    def rate_hz(self) -> float | None:
        """Frames per second; None where nothing says."""
        return self._native.rate_hz

    @property
    def facing(self) -> str | None:
        """Which way the person faces in the image, ``"left"`` or ``"right"``."""
        return self._native.facing

    @property
    def layout(self) -> str | None:
        """The detector's order of points; None for a motion in space."""
        return self._native.layout

    @property
    def notes(self) -> list[str]:
        """What a user should know, one sentence each."""
        return self._native.notes

    @property
    def doubts(self) -> list[str]:
        """What speaks against the angles, one sentence each."""
        return self._native.doubts

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write an angle table (CSV) that the command ``sinew`` reads, six decimals an angle."""
        self._native.save(path)

    def __reduce__(self) -> tuple[Any, ...]:
        return _of_parts, self._native.parts()

    def __len__(self) -> int:
        return len(self.frame)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self.angles_rad, dtype=dtype) if copy or dtype else self.angles_rad

    def __repr__(self) -> str:
        rate = "unknown rate" if self.rate_hz is None else f"{self.rate_hz:g} Hz"
        missing = 100.0 * float(np.isnan(self.angles_rad).mean())
        return f"<sinew.Angles: {len(self)} frames at {rate}, {missing:.1f} % missing>"


def _of_parts(*parts: Any) -> Angles:
    return Angles(_sinew.Angles.of_parts(*parts))


def angles(
    keypoints: Any,
    layout: str = "coco17",
    *,
    fps: float | None = None,
    image_size_px: tuple[float, float] | None = None,
    min_confidence: float = 0.3,
    facing: str | None = None,
    person: str | int = "largest",
) -> Angles:
    """Joint angles of a person in 2D keypoints, or of a file.

    Parameters
    ----------
    keypoints : array_like, shape (n, k, 3) or (n, k, 2), or path
        x, y and confidence of k points in n frames, pixels or shares of the picture, y down. A
        point is missing where a number is NaN, or x and y are zero. Without a third column every
        point is sure. Or any file or folder that ``sinew angles`` reads: keypoints of OpenPose,
        COCO or CSV, motions as BVH, C3D, TRC, AMC and others.
    layout : str
        Order of the points of an array, one of :func:`layouts`. A file shows its own.
    fps : float
        Frames per second. Needed for an array; for a file where that does not say.
    image_size_px : (float, float), optional
        Width and height of the picture, pixels; needed where coordinates are shares of it.
    min_confidence : float
        Points of which the detector was less sure are missing.
    facing : {"left", "right"}, optional
        Which way the person faces; found where not given.
    person : {"largest", "longest"} or int
        Which of several people in a file, or a number from 1.

    Returns
    -------
    Angles
        The angles of the 13 segments in :data:`sinew.ANGLE_NAMES`; of a person who faces left
        those of the mirror image.

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        No person is seen, or a file breaks a rule.
    OSError
        The file cannot be read.
    """
    size = _size(image_size_px)
    rate_hz = None if fps is None else positive(fps, "fps")
    if is_path(keypoints):
        if layout != "coco17":
            raise ValueError("`layout` is for arrays; a file shows its own: leave it out")
        return Angles(_sinew.angles_of_file(keypoints, rate_hz, size, min_confidence, facing, str(person)))
    if rate_hz is None:
        raise ValueError("`fps` has to be given for an array: its frames per second")
    if person != "largest":
        raise ValueError("`person` is for files; an array has one person: leave it out")
    points = floats(keypoints, "keypoints")
    if points.ndim != 3 or points.shape[2] not in (2, 3):
        raise ValueError(f"`keypoints` has to have the shape (n, k, 3) or (n, k, 2), not {points.shape}")
    if points.shape[0] == 0:
        raise ValueError("`keypoints` need at least one frame")
    if points.shape[2] == 2:
        points = np.concatenate([points, np.ones((*points.shape[:2], 1))], axis=2)
    return Angles(_sinew.angles_of_array(points, layout, rate_hz, size, min_confidence, facing))


def _size(image_size_px: Any) -> tuple[float, float] | None:
    if image_size_px is None:
        return None
    size = floats(image_size_px, "image_size_px")
    if size.shape != (2,):
        raise ValueError(f"`image_size_px` has to be width and height, not of shape {size.shape}")
    return float(size[0]), float(size[1])
