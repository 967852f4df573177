"""A made-up person before a camera."""

from __future__ import annotations

import json
import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import is_path, positive, whole
from ._images import ImageArray

_JOINTS = ("shoulder", "elbow", "hand")
TRUTH_DTYPE = np.dtype(
    [("frame", np.int64), ("time_s", np.float64), ("side", "U5")]
    + [(f"{joint}_{axis}_m", np.float64) for joint in _JOINTS for axis in "xyz"]
    + [(f"{joint}_{axis}_px", np.float64) for joint in _JOINTS for axis in "uv"]
    + [("hand_visible", np.bool_), ("false_blob", np.bool_)]
)


class SimulatedArm(NamedTuple):
    """Frames of a made-up person, with what is true in them."""

    frames: ImageArray
    """Pictures, (n, 480, 640, 3), red, green and blue."""
    truth: npt.NDArray[np.void]
    """A row for each frame and moving arm, with the columns of the command's ``truth.csv``."""
    config: dict[str, Any]
    """Camera and person, for ``config`` of :class:`sinew.ArmTracker`."""
    side: str
    """Which arms move."""
    rate_hz: float
    """Frames per second."""
    notes: list[str]
    """What is to be known of the motion."""


def simulate_arm(
    motion: str | os.PathLike[str] = "builtin",
    *,
    frames: int | None = None,
    rate_hz: float = 15.0,
    side: str = "right",
    seed: int = 1,
    false_blob: float = 0.5,
    hidden: float = 0.1,
    away: tuple[int, int] | None = None,
    noise_std: float = 2.5,
) -> SimulatedArm:
    """Render a person before a webcam whose arms move, as ``sinew simulate arm`` does.

    Parameters
    ----------
    motion : str or path
        ``builtin`` for random reaches, or a motion file such as a .bvh.
    frames : int, optional
        Number of frames; by default 250 of ``builtin``, or the length of the motion. A frame takes
        0.9 MB.
    rate_hz : float
        Frames per second.
    side : {"right", "left", "both"}
        Which arms move; left is the person's left.
    seed : int
        Seed of all that is random.
    false_blob : float
        Share of the frames in which face and neck show skin.
    hidden : float
        Share of the frames in which a hand is hidden.
    away : tuple of int, optional
        Frames in which the hand is behind the back, first and one past the last.
    noise_std : float
        Standard deviation of the sensor noise, levels of 255.

    Returns
    -------
    SimulatedArm

    Raises
    ------
    ValueError
        A parameter breaks its rule.
    SinewError
        The motion breaks a rule.
    OSError
        The motion cannot be read.

    Examples
    --------
    >>> filmed = sinew.simulate_arm(frames=30)
    >>> tracker = sinew.ArmTracker(side=filmed.side, rate_hz=filmed.rate_hz, config=filmed.config)
    >>> estimates = [tracker.update(image) for image in filmed.frames]
    """
    if not is_path(motion):
        raise ValueError(f"`motion` has to be a name or a path, not {type(motion).__name__}")
    if away is not None:
        try:
            first, end = away
        except (TypeError, ValueError):
            raise ValueError(f"`away` has to be a first frame and one past the last, not {away!r}") from None
        away = whole(first, "away", 0, 2**53), whole(end, "away", 0, 2**53)
    pixels, rows, config, notes = _sinew.simulate_arm(
        motion,
        None if frames is None else whole(frames, "frames", 1, 2**53),
        positive(rate_hz, "rate_hz"),
        side,
        whole(seed, "seed", 0, 2**64 - 1),
        float(false_blob),
        float(hidden),
        away,
        float(noise_std),
    )
    truth = np.empty(len(rows), dtype=TRUTH_DTYPE)
    for column, name in enumerate(TRUTH_DTYPE.names or ()):
        truth[name] = np.where(rows[:, column] == 1.0, "right", "left") if name == "side" else rows[:, column]
    return SimulatedArm(pixels, truth, json.loads(config), side, float(rate_hz), notes)
