"""Angles of an array with the times of its rows."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import FloatArray, floats
from ._columns import by_name
from ._times import frames_of_times


def angle_rows(
    angles: Any, time_s: npt.ArrayLike | None, rate_hz: float | None, name: str = "angles"
) -> tuple[_sinew.Angles, FloatArray | None]:
    """The extension's angles of an array, and the times of its rows if they are given.

    Raises
    ------
    ValueError
        Shape, numbers, times or rate break a rule; the message names it.
    """
    rows = floats(by_name(angles, _sinew.ANGLES, name, "_rad"), name)
    if rows.ndim != 2 or rows.shape[1] != 13:
        raise ValueError(f"`{name}` has to have the shape (n, 13), not {rows.shape}")
    if len(rows) == 0:
        raise ValueError(f"`{name}` need at least one frame")
    if np.isinf(rows).any():
        raise ValueError(f"`{name}` have to be finite; NaN is a missing one")
    if time_s is None and rate_hz is None:
        raise ValueError("`rate_hz` has to be given for an array (frames per second), or `time_s`")
    frame, times = np.arange(len(rows), dtype=np.int64), None
    if time_s is not None:
        times = floats(time_s, "time_s")
        frame, rate_hz = frames_of_times(times, len(rows), rate_hz)
    return _sinew.Angles.of_array(rows, frame, rate_hz), times
