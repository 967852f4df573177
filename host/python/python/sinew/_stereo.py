"""A body before a stereo camera, to try things without one."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import number, positive, whole
from ._points import PointArray

Path = str | os.PathLike[str]


@dataclass(frozen=True, eq=False)
class SimulatedStereo:
    """Clouds of a moving body, and what is true of it; metres in camera axes."""

    clouds: list[PointArray]
    """Points of each of n frames, (m, 3)."""
    rate_hz: float
    """Frames per second."""
    joints_m: PointArray
    """True joints in the order of :data:`sinew.BODY_JOINT_NAMES`, (n, 17, 3), NaN missing."""
    markers_m: PointArray
    """True places on the skin, (n, 30, 3), NaN missing."""
    stick_m: PointArray | None
    """Ends of the stick of ``"stick-wave"``, (n, 2, 3)."""
    measures: dict[str, Any]
    """The person, for ``measures`` of :class:`sinew.BodyTracker`."""
    first_pose: npt.NDArray[np.float32]
    """The pose of the first frame, (30,), for ``first_pose`` of :class:`sinew.BodyTracker`."""
    camera: dict[str, Any]
    """Picture, focal length, baseline and noise of the camera."""
    floor_y_m: float
    """The floor."""
    notes: list[str]
    """What a user should know of the motion, one sentence each."""

    def __len__(self) -> int:
        return len(self.clouds)

    def __repr__(self) -> str:
        return f"<sinew.SimulatedStereo: {len(self)} clouds at {self.rate_hz:g} Hz>"


def simulate_stereo(
    motion: Path = "stick-wave",
    *,
    skeleton: Path | None = None,
    motion_rate_hz: float | None = None,
    between_s: tuple[float, float] | None = None,
    partial: bool = False,
    distance_m: float = 3.0,
    heading_deg: float = 0.0,
    rate_hz: float = 15.0,
    part: str = "whole",
    points: int = 2000,
    outliers: float = 0.1,
    patches: int = 4,
    hide: Sequence[str] = (),
    hard: bool = False,
    seed: int = 1,
) -> SimulatedStereo:
    """Points that a stereo camera measures on a moving body, as ``sinew simulate stereo`` does.

    Parameters
    ----------
    motion : {"stick-wave", "pelvic-lift"} or path
        A motion that is built in, or a file that :func:`read_motion` reads.
    skeleton : path, optional
        Skeleton of an AMC file; the only .asf beside it where not given.
    motion_rate_hz : float, optional
        Frames per second of a motion file that does not say.
    between_s : (float, float), optional
        Part of the motion that is used, seconds from its beginning.
    partial : bool
        Take a motion with fewer frames than its header promises.
    distance_m : float
        Mean distance of the pelvis; larger if the person would come too near or leave the picture.
    heading_deg : float
        Turn of the person to their left; 0 faces the camera on the mean.
    rate_hz : float
        Frames per second of the camera.
    part : {"whole", "upper"}
        How much of the body the camera sees.
    points : int
        Points in a frame, outliers included.
    outliers : float
        Share of the points that are outliers, [0, 1].
    patches : int
        Patches of the picture in which no point is found.
    hide : sequence of str
        Limbs without points from one frame to another, such as ``"l_arm:30-44"``.
    hard : bool
        Radii, lengths and first pose with errors, false matches, background, motion blur, as
        ``--hard`` of the command.
    seed : int
        Seed of all that is random; the command makes the same points of it.

    Returns
    -------
    SimulatedStereo

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        The motion cannot be used.
    OSError
        The motion cannot be read.
    """
    if isinstance(hide, str):
        raise ValueError("`hide` has to be a list of texts such as \"l_arm:30-44\"")
    between = None
    if between_s is not None:
        if len(between_s) != 2:
            raise ValueError(f"`between_s` has to be two numbers, not {between_s!r}")
        between = number(between_s[0], "between_s"), number(between_s[1], "between_s")
    found = _sinew.simulate_stereo(
        motion,
        skeleton,
        None if motion_rate_hz is None else positive(motion_rate_hz, "motion_rate_hz"),
        between,
        bool(partial),
        number(distance_m, "distance_m"),
        number(heading_deg, "heading_deg"),
        positive(rate_hz, "rate_hz"),
        str(part),
        whole(points, "points", 0, 2**63 - 1),
        number(outliers, "outliers"),
        whole(patches, "patches", 0, 2**32 - 1),
        [str(text) for text in hide],
        bool(hard),
        whole(seed, "seed", 0, 2**64 - 1),
    )
    found["measures"] = json.loads(found.pop("measures_json"))
    found["camera"] = json.loads(found.pop("camera_json"))
    return SimulatedStereo(**found)
