"""Tracking of whole recordings."""

from __future__ import annotations

import os
from typing import Any

import numpy.typing as npt

from . import _sinew
from ._angle_rows import angle_rows
from ._angles import Angles
from ._arrays import MAX_WHOLE, is_path, positive, whole
from ._model import Model, native_model
from ._track_result import CyclicTrack


def track_cyclic(
    angles: Any,
    model: str | os.PathLike[str] | Model = "walking",
    *,
    rate_hz: float | None = None,
    time_s: npt.ArrayLike | None = None,
    sigma_deg: float | None = None,
    smooth: bool = True,
    filter: str = "coupled",
    particles: int = 10_000,
    seed: int = 1,
    covariance: bool = False,
) -> CyclicTrack:
    """Track a cyclic motion: position in the cycle, cadence, and angles without noise and gaps.

    The numbers are those of ``sinew track cyclic --report``.

    Parameters
    ----------
    angles : Angles, array_like of shape (n, 13), or path
        What :func:`angles` returns; or radians in the order of :data:`sinew.ANGLE_NAMES`, one row a
        frame, NaN where one is missing; or the path of an angle table. The columns of a data frame
        are found by name.
    model : str, path or Model
        A name of :func:`models`, a file that ``sinew train cyclic`` wrote, or what
        :func:`train_cyclic` returns.
    rate_hz : float, optional
        Frames per second. Needed for an array unless ``time_s`` is given.
    time_s : array_like, shape (n,), optional
        When each row of an array was seen, seconds. Frames have to be even in time but for jitter;
        some may be left out.
    sigma_deg : float, optional
        Standard deviation of a measured angle, degrees. By default the recording shows it; 6 where
        it does not, or with ``smooth=False``.
    smooth : bool
        Estimate each frame from the whole recording. False: from the frames before it alone, as
        firmware and ``sinew track cyclic --online`` do.
    filter : {"coupled", "paper", "paper-cut", "particle"}
        Which filter; all but the first are those of the paper.
    particles, seed : int
        For the particle filter.
    covariance : bool
        Also keep the covariance of the filter's angles, with ``smooth=False``.

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
    if covariance and smooth:
        raise ValueError("`covariance` is the filter's: give `smooth=False` with it")
    native = native_model(model)
    how = {
        "rate_hz": None if rate_hz is None else positive(rate_hz, "rate_hz"),
        "sigma_deg": None if sigma_deg is None else positive(sigma_deg, "sigma_deg"),
        "smooth": bool(smooth),
        "filter": str(filter),
        "particles": whole(particles, "particles", 1, MAX_WHOLE),
        "seed": whole(seed, "seed", 0, 2**64 - 1),
        "covariance": bool(covariance),
    }
    if isinstance(angles, Angles) or is_path(angles):
        if time_s is not None:
            raise ValueError("`time_s` is for arrays; a table and `Angles` have their own times: leave it out")
        if isinstance(angles, Angles):
            return CyclicTrack(_sinew.track_angles(angles._native, native, how), notes=angles.notes)
        found, notes = _sinew.track_file(angles, native, how)
        return CyclicTrack(found, notes=notes)
    rows, times = angle_rows(angles, time_s, how["rate_hz"])
    return CyclicTrack(_sinew.track_angles(rows, native, {**how, "rate_hz": rows.rate_hz}), times)
