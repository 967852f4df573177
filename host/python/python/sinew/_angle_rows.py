"""Angles of an array with the times of its rows."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import FloatArray, floats
from ._columns import by_name


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
        frame, rate_hz = _frames(times, len(rows), rate_hz)
    return _sinew.Angles.of_array(rows, frame, rate_hz), times


def _frames(times: FloatArray, rows: int, rate_hz: float | None) -> tuple[npt.NDArray[np.int64], float]:
    """Frame numbers of times, and frames per second: those given, else those of the times."""
    if times.shape != (rows,):
        raise ValueError(f"`time_s` has to have the shape ({rows},) of the rows, not {times.shape}")
    steps = np.diff(times)
    if not np.isfinite(times).all() or (steps <= 0.0).any():
        raise ValueError("`time_s` has to be finite and to rise from row to row")
    if len(steps) == 0:
        if rate_hz is None:
            raise ValueError("`rate_hz` has to be given for a single row")
        return np.zeros(1, dtype=np.int64), rate_hz
    # Step by step, so that rounded times do not add up to a frame.
    median_s = float(np.median(steps)) if rate_hz is None else 1.0 / rate_hz
    frames = np.concatenate([[0], np.cumsum(np.maximum(np.rint(steps / median_s), 1.0))])
    found_hz = float(frames[-1] / (times[-1] - times[0]))
    if rate_hz is not None and abs(found_hz / rate_hz - 1.0) > 0.05:
        raise ValueError(f"`time_s` says {found_hz:.3g} frames per second, `rate_hz` {rate_hz:g}: leave one out")
    rate = found_hz if rate_hz is None else rate_hz
    if np.abs((times - times[0]) - frames / found_hz).max() * found_hz > 0.5:
        raise ValueError("`time_s` has to be even: a frame is more than half a frame from where the rate puts it")
    return frames.astype(np.int64), rate
