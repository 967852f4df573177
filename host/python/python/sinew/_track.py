"""Tracking of whole recordings."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._angles import Angles
from ._arrays import FloatArray, floats, is_path, positive
from ._model import Model, native_model
from ._track_result import CyclicTrack


def track_cyclic(
    angles: Any,
    model: str | os.PathLike[str] | Model = "walking",
    *,
    rate_hz: float | None = None,
    time_s: npt.ArrayLike | None = None,
    sigma_deg: float | None = None,
    online: bool = False,
) -> CyclicTrack:
    """Track a cyclic motion: position in the cycle, cadence, and angles without noise and gaps.

    The numbers are those of ``sinew track cyclic --report``.

    Parameters
    ----------
    angles : Angles, array_like of shape (n, 13), or path
        What :func:`angles` returns; or radians in the order of :data:`sinew.ANGLE_NAMES`, one row a
        frame, NaN where one is missing; or the path of an angle table.
    model : str, path or Model
        A name of :func:`models`, or a file that ``sinew train cyclic`` wrote.
    rate_hz : float, optional
        Frames per second. Needed for an array unless ``time_s`` is given.
    time_s : array_like, shape (n,), optional
        When each row of an array was seen, seconds. Frames have to be even in time; some may be
        left out.
    sigma_deg : float, optional
        Standard deviation of a measured angle, degrees. By default the recording shows it; 6 where
        it does not, or with ``online``.
    online : bool
        Estimate each frame from those before it alone, as firmware does.

    Returns
    -------
    CyclicTrack

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        No angle was seen, or the table breaks a rule.
    OSError
        The table cannot be read.
    """
    native = native_model(model)
    rate = None if rate_hz is None else positive(rate_hz, "rate_hz")
    sigma = None if sigma_deg is None else positive(sigma_deg, "sigma_deg")
    if isinstance(angles, Angles) or is_path(angles):
        if time_s is not None:
            raise ValueError("`time_s` is for arrays; a table and `Angles` have their own times: leave it out")
        if isinstance(angles, Angles):
            return CyclicTrack(_sinew.track_angles(angles._native, native, rate, sigma, bool(online)))
        return CyclicTrack(_sinew.track_file(angles, native, rate, sigma, bool(online)))
    rows = floats(angles, "angles")
    if rows.ndim != 2 or rows.shape[1] != 13:
        raise ValueError(f"`angles` has to have the shape (n, 13), not {rows.shape}")
    if len(rows) == 0:
        raise ValueError("`angles` need at least one frame")
    if np.isinf(rows).any():
        raise ValueError("`angles` have to be finite; NaN is a missing one")
    if time_s is None and rate is None:
        raise ValueError("`rate_hz` has to be given for an array (frames per second), or `time_s`")
    frame, times = np.arange(len(rows), dtype=np.int64), None
    if time_s is not None:
        times = floats(time_s, "time_s")
        frame, rate = _frames(times, len(rows), rate)
    return CyclicTrack(_sinew.track_array(rows, frame, native, rate, sigma, bool(online)), times)


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
