"""Frame numbers and rate of rows by their times."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import FloatArray

MAX_OFF_FRAMES = 0.25
"""How far times may be from even ones, root mean square, in frames.

Chosen: times at random are 0.29 off, and those of 60 frames a second in two decimals 0.17.
"""
MAX_RATE_ERROR = 0.05
"""How far the rate of times may be from the one that is given, as a share of it."""
MIN_RATE_HZ = 1.0
"""Lowest rate of times. Chosen: slower frames show no motion, and milliseconds look like them."""
_FIRST_ROWS = 32
"""Rows in which frames are counted by the first guess of the step, which may be 1 % off. Chosen."""


def frames_of_times(times: FloatArray, rows: int, rate_hz: float | None) -> tuple[npt.NDArray[np.int64], float]:
    """Frame numbers of times, and frames per second: those given, else those of the times.

    Raises
    ------
    ValueError
        Times break a rule; the message names it.
    """
    if times.shape != (rows,):
        raise ValueError(f"`time_s` has to have the shape ({rows},) of the rows, not {times.shape}")
    steps = np.diff(times)
    if not np.isfinite(times).all() or (steps <= 0.0).any():
        raise ValueError("`time_s` has to be finite and to rise from row to row")
    if rows == 1:
        if rate_hz is None:
            raise ValueError("`rate_hz` has to be given for a single row")
        return np.zeros(1, dtype=np.int64), rate_hz
    median_s = np.quantile(steps, 0.5, method="lower")
    if median_s * MIN_RATE_HZ > 1.0:
        raise ValueError(
            f"`time_s` has to be in seconds, and puts {median_s:.3g} s between frames: divide milliseconds by 1000"
        )
    # Jitter and rounding change a step by half of it; longer ones are of missing frames.
    single = steps[np.abs(steps - median_s) < 0.55 * median_s]
    guesses = [np.mean(single), np.mean(steps)] if rate_hz is None else [1.0 / rate_hz]
    frames, found_hz, off = min((_fitted(times, float(step_s)) for step_s in guesses), key=lambda fit: fit[2])
    if rate_hz is not None and abs(found_hz / rate_hz - 1.0) > MAX_RATE_ERROR:
        raise ValueError(f"`time_s` says {found_hz:.3g} frames per second, `rate_hz` {rate_hz:g}: leave one out")
    if off > MAX_OFF_FRAMES:
        raise ValueError(
            f"`time_s` has to be even: its times are {off:.2f} of a frame off {found_hz:.4g} frames per second "
            f"(root mean square), and {MAX_OFF_FRAMES} is the most"
        )
    return frames, found_hz if rate_hz is None else rate_hz


def _fitted(times: FloatArray, step_s: float) -> tuple[npt.NDArray[np.int64], float, float]:
    """Frame numbers, rate and how far times are off, from a guess of the step.

    A line through the first rows puts twice as many on their frames.
    """
    start_s, rows = times[0], _FIRST_ROWS
    while True:
        some = times[:rows]
        step_s, start_s = np.polyfit(_nearest((some - start_s) / step_s), some, 1)
        if rows >= len(times):
            break
        rows *= 2
    places = (times - start_s) / step_s
    frames = _nearest(places)
    return frames - frames[0], float(1.0 / step_s), float(np.sqrt(np.mean((places - frames) ** 2)))


def _nearest(places: FloatArray) -> npt.NDArray[np.int64]:
    """The nearest whole numbers that rise."""
    frames = np.rint(places).astype(np.int64)
    if (np.diff(frames) > 0).all():
        return frames
    rows = np.arange(len(places))
    return rows + np.rint(_isotonic(places - rows)).astype(np.int64)


def _isotonic(values: FloatArray) -> FloatArray:
    """The nearest numbers that do not fall, by pooling adjacent violators."""
    pools: list[tuple[float, int]] = []
    for value in values.tolist():
        pools.append((value, 1))
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (before, many), (after, more) = pools[-2:]
            pools[-2:] = [((before * many + after * more) / (many + more), many + more)]
    means, counts = zip(*pools)
    return np.repeat(means, counts)
