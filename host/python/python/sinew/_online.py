"""Tracking frame by frame."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from . import _sinew
from ._arrays import MAX_WHOLE, FloatArray, floats, positive, whole
from ._columns import by_name
from ._model import Model, native_model


@dataclass(frozen=True)
class CyclicEstimate:
    """What is known of a frame from those up to it."""

    frame: int
    """Number of the frame, counted from 0."""
    angles_rad: FloatArray
    """Estimated angles, (13,) radians, unwrapped along time."""
    std_rad: FloatArray
    """Their standard deviations, (13,) radians."""
    cycle_position: float
    """Position in the cycle, [0, 1)."""
    cycle_position_std: float
    """Its standard deviation, cycles."""
    cycles: float
    """Cycles since the first frame with an angle."""
    cadence_per_min: float
    """Cycles per minute at this frame."""
    cadence_std_per_min: float
    """Its standard deviation."""
    log_likelihood: float
    """Log-likelihood of the frame's measurement."""
    outlier: bool
    """Whether the measurement did not belong to the prediction."""
    misfit: bool
    """Whether the motion was not the model's."""


class CyclicTracker:
    """A tracker that answers each frame from those before it.

    The answers are those of :func:`track_cyclic` with ``smooth=False``. It can be pickled at any
    frame and goes on where it was.

    Parameters
    ----------
    model : str, path or Model
        A name of :func:`models`, or a file that ``sinew train cyclic`` wrote.
    rate_hz : float
        Frames per second.
    sigma_deg : float
        Standard deviation of a measured angle, degrees.
    """

    __slots__ = ("_model", "_native", "_sigma_deg")

    def __init__(
        self,
        model: str | os.PathLike[str] | Model = "walking",
        *,
        rate_hz: float,
        sigma_deg: float = 6.0,
    ) -> None:
        self._model = model if isinstance(model, Model) else Model(model)
        self._sigma_deg = positive(sigma_deg, "sigma_deg")
        rate = positive(rate_hz, "rate_hz")
        self._native = _sinew.Tracker(native_model(self._model), rate, self._sigma_deg)

    def update(self, z: Any, dt_frames: int = 1) -> CyclicEstimate | None:
        """Answer the next frame.

        Parameters
        ----------
        z : array_like, shape (13,)
            Measured angles, radians; NaN where one is missing. A series is read by its names.
        dt_frames : int
            Frames since the last call; more than 1 where some were left out.

        Returns
        -------
        CyclicEstimate or None
            None before the first frame with an angle.
        """
        row = floats(by_name(z, _sinew.ANGLES, "z", "_rad"), "z")
        if row.shape != (13,):
            raise ValueError(f"`z` has to have the shape (13,), not {row.shape}")
        answer = self._native.update(row, whole(dt_frames, "dt_frames", 1, MAX_WHOLE))
        return None if answer is None else CyclicEstimate(**answer)

    @property
    def model(self) -> Model:
        """The motion model."""
        return self._model

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return self._native.rate_hz

    @property
    def frame(self) -> int | None:
        """Number of the last frame; None before the first one."""
        return self._native.frame

    @property
    def covariance_rad2(self) -> FloatArray:
        """Covariance of the last frame's angles, (13, 13) rad^2; NaN while the phase is unknown."""
        return self._native.covariance_rad2().reshape(13, 13)

    def __repr__(self) -> str:
        return f"CyclicTracker({self.model.name!r}, rate_hz={self.rate_hz:g})"

    def __reduce__(self) -> tuple[Any, ...]:
        native = self._native
        return _restored, (self._model, native.rate_hz, self._sigma_deg, *native.saved())


def _restored(model: Model, rate_hz: float, sigma_deg: float, frame: int | None, state: str | None) -> CyclicTracker:
    tracker = CyclicTracker(model, rate_hz=rate_hz, sigma_deg=sigma_deg)
    tracker._native.restore(frame, state)
    return tracker
