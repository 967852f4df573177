"""Made-up recordings, to try things without a video."""

from __future__ import annotations

import os
from typing import NamedTuple

from . import _sinew
from ._arrays import FloatArray
from ._model import Model, native_model


class SimulatedKeypoints(NamedTuple):
    """Keypoints of a made-up person."""

    keypoints: FloatArray
    """x, y and confidence of each point, (n, 14, 3) pixels, NaN missing."""
    layout: str
    """Their layout, for :func:`sinew.angles`."""
    rate_hz: float
    """Frames per second."""
    image_size_px: tuple[int, int]
    """Width and height of the picture, pixels."""
    cadence_per_min: float
    """The person's cycles per minute."""


def simulate_keypoints(
    model: str | os.PathLike[str] | Model = "walking",
    *,
    seconds: float = 6.0,
    rate_hz: float = 30.0,
    facing: str = "right",
    height_px: float = 400.0,
    sigma_px: float = 1.5,
    missing: float = 0.0,
    seed: int = 1,
) -> SimulatedKeypoints:
    """Keypoints of a made-up person who passes a camera, as a pose detector would give them.

    Parameters
    ----------
    model : str, path or Model
        Motion of the person, who has a pace and a style of their own.
    seconds, rate_hz : float
        Length of the recording, and frames per second.
    facing : {"right", "left"}
        Which way the person goes.
    height_px : float
        Height of the person in the picture, pixels.
    sigma_px : float
        Standard deviation of each coordinate, pixels.
    missing : float
        Share of the keypoints that are missing, [0, 1).
    seed : int
        Seed of all that is random.

    Returns
    -------
    SimulatedKeypoints
    """
    if not 0 <= seed < 2**64:
        raise ValueError(f"`seed` has to be a whole number from 0 to 2^64 - 1, not {seed!r}")
    keypoints, size, cadence = _sinew.simulate_keypoints(
        native_model(model), seconds, rate_hz, facing, height_px, sigma_px, missing, seed
    )
    return SimulatedKeypoints(keypoints, "stick14", float(rate_hz), (size[0], size[1]), cadence)
