"""Training of motion models."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import _sinew
from ._angle_rows import angle_rows
from ._angles import Angles
from ._arrays import MAX_WHOLE, is_path, positive, whole
from ._model import Model, trained


def train_cyclic(
    recordings: Any,
    *,
    cycles: Sequence[Sequence[tuple[int, int]]] | None = None,
    people: Sequence[str] | None = None,
    rate_hz: float | None = None,
    length: int = 100,
    mirror: bool = False,
) -> Model:
    """Train a model of a cyclic motion.

    Parameters
    ----------
    recordings : sequence of Angles or array_like of shape (n, 13), or path
        Recordings of one motion; or a list of cycles as ``sinew cut`` writes it (CSV with the
        columns file, start_frame, end_frame, and person if known).
    cycles : sequence, optional
        For each recording the first frame of each cycle and the frame after its last. Found as
        ``sinew cut`` finds them where not given.
    people : sequence of str, optional
        Whose each recording is: each person gets the same weight. Without it each cycle does.
    rate_hz : float, optional
        Frames per second of arrays, and of recordings that do not say.
    length : int
        Positions of the reference cycle, 10 to 1000.
    mirror : bool
        Use each cycle also with left and right exchanged, half a cycle later: for walking and
        running.

    Returns
    -------
    Model
        The same as that of ``sinew train cyclic``; :meth:`Model.save` writes its file.

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        A recording has no cycle, or the cycles give no model.
    OSError
        The list or a table cannot be read.
    """
    rate = None if rate_hz is None else positive(rate_hz, "rate_hz")
    positions = whole(length, "length", 10, 1000)
    if is_path(recordings):
        for name, given in (("cycles", cycles), ("people", people)):
            if given is not None:
                raise ValueError(f"`{name}` is for recordings in memory; the list has its own: leave it out")
        return trained(_sinew.train_file(recordings, positions, rate, bool(mirror)))
    if isinstance(recordings, Angles):
        recordings = [recordings]
    native = [_native(recording, rate, index) for index, recording in enumerate(recordings)]
    for name, given in (("cycles", cycles), ("people", people)):
        if given is not None and len(given) != len(native):
            raise ValueError(f"`{name}` has to have {len(native)} entries, one a recording, not {len(given)}")
    frames = [None] * len(native) if cycles is None else [_frames(of_one) for of_one in cycles]
    persons = [None] * len(native) if people is None else [str(person) for person in people]
    return trained(_sinew.train_angles(list(zip(native, frames, persons)), positions, rate, bool(mirror)))


def _native(recording: Any, rate_hz: float | None, index: int) -> _sinew.Angles:
    if isinstance(recording, Angles):
        return recording._native
    return angle_rows(recording, None, rate_hz, f"recordings[{index}]")[0]


def _frames(cycles: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    return [(whole(start, "cycles", 0, MAX_WHOLE), whole(end, "cycles", 0, MAX_WHOLE)) for start, end in cycles]
