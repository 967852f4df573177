"""Tracking a body from point clouds, frame by frame."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import is_path, number, positive, whole
from ._body_estimate import BodyEstimate, FirstPose
from ._columns import entries
from ._points import points32

Path = str | os.PathLike[str]


class BodyTracker:
    """A tracker that answers each cloud of points from those before it.

    The answers are those of ``sinew track body`` with the same options, bit for bit, on any number
    of threads. It can be pickled at any frame and goes on where it was. One thread at a time may
    call it; several trackers run side by side, since the interpreter's lock is released.

    Parameters
    ----------
    height_m : float, optional
        Height of a person who is not measured, metres; 1.75 where neither this nor ``measures`` is
        given, which is noted. :meth:`estimate_measures` finds more.
    measures : path or dict, optional
        The person: a ``body.json`` or what it holds, or a motion or skeleton file to measure.
    part : {"whole", "upper"}
        How much of the body is tracked; ``"upper"`` for a camera that sees no legs.
    model : str
        How particles move: ``"guided"``, ``"modes"``, ``"end-effector"``, ``"angular"``,
        ``"stick"``, ``"pelvic-lift"``, ``"end-effector-paper"`` or ``"angular-paper"``.
    particles : int, optional
        Number of particles; 30 of guided, 8 of modes (the most that are followed) and
        500 of the others where not given.
    seed : int
        Seed of all that is random.
    rate_hz : float
        Frames per second.
    first_pose : path, dict or array_like of shape (30,), optional
        Pose of the first frame: a ``first_pose.json``, coordinates by name (others are zero), or
        all in the order of :data:`sinew.BODY_COORDINATE_NAMES`. Without it someone who stands
        or walks is fitted to the first points.
    floor_y_m : float, optional
        The floor of ``"pelvic-lift"``, camera axes.
    threads : int, optional
        Number of threads; all where not given. Results do not depend on it.
    config : path or dict, optional
        Numbers of the models: a TOML file, or nested keys and values, as ``--config`` takes it.

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        Measures, pose or config break a rule.
    OSError
        A file cannot be read.
    """

    __slots__ = ("_native",)

    def __init__(
        self,
        *,
        height_m: float | None = None,
        measures: Path | dict[str, Any] | None = None,
        part: str = "whole",
        model: str = "guided",
        particles: int | None = None,
        seed: int = 1,
        rate_hz: float = 15.0,
        first_pose: Path | dict[str, float] | npt.ArrayLike | None = None,
        floor_y_m: float | None = None,
        threads: int | None = None,
        config: Path | dict[str, Any] | None = None,
    ) -> None:
        if height_m is not None and measures is not None:
            raise ValueError("`height_m` is for a person who is not measured: leave it or `measures` out")
        self._native = _sinew.Body(
            None if height_m is None else positive(height_m, "height_m"),
            _given(measures, "measures"),
            _word(part, "part"),
            _word(model, "model"),
            None if particles is None else whole(particles, "particles", 1, 2**63 - 1),
            whole(seed, "seed", 0, 2**64 - 1),
            positive(rate_hz, "rate_hz"),
            _given(_named(first_pose), "first_pose"),
            None if floor_y_m is None else number(floor_y_m, "floor_y_m"),
            None if threads is None else whole(threads, "threads", 1, 2**63 - 1),
            _given(config, "config"),
        )

    def update(
        self, points: npt.ArrayLike | None, *, time_s: float | None = None, stick: npt.ArrayLike | None = None
    ) -> BodyEstimate | None:
        """Answer the next frame.

        Parameters
        ----------
        points : array_like of shape (n, 3), or None
            Points in metres, camera axes: x right, y down, z forward. None or no row is a frame in
            which nothing is seen; its answer is a prediction. Rows that are not finite, at the
            camera or farther than 1 km are left out, and so are all beyond 20,000, drawn by the
            seed. float32 in C order is not copied before it is checked. Columns x, y, z of a data
            frame are found by name.
        time_s : float, optional
            When the frame was taken, seconds, on any clock; it has to rise from frame to frame.
            One frame after the last one where not given.
        stick : array_like of shape (2, 3), optional
            Ends of the stick in metres, the one at the person's left hand first; for
            ``model="stick"``. Not given, or NaN, where it is not seen.

        Returns
        -------
        BodyEstimate or None
            None where no first pose is given and no cloud had 30 points yet. The first answer is
            the first pose, with a look at the points from there.

        Raises
        ------
        ValueError
            A parameter breaks its rule; the message names both. So do first points in other units
            or axes.
        """
        native = self._native
        cloud = None if points is None else points32(points, "points")
        time = None if time_s is None else number(time_s, "time_s")
        answer = native.update(cloud, time, None if stick is None else self._ends(stick))
        return BodyEstimate(part=native.part, **answer) if "pose" in answer else None

    def estimate_measures(self, clouds: Iterable[npt.ArrayLike | None]) -> dict[str, Any] | None:
        """Estimate the measures of a person from their first three seconds.

        The tracker's own measures are where it begins; the tracker stays as it is. A tracker with
        the measures found gives the answers of ``sinew track body --size estimated``.

        Parameters
        ----------
        clouds : iterable of array_like of shape (n, 3), or None
            Points of the first frames, as :meth:`update` takes them. No more of them are read than
            hold three seconds with points.

        Returns
        -------
        dict or None
            Measures as a ``body.json`` has them; None where no others make the points likelier.

        Raises
        ------
        ValueError
            A parameter breaks its rule, or the tracker has answered a frame.

        Examples
        --------
        >>> scene = sinew.simulate_stereo(rate_hz=4.0, points=300)
        >>> person = sinew.BodyTracker(rate_hz=scene.rate_hz)
        >>> measures = person.estimate_measures(scene.clouds)
        >>> tracker = sinew.BodyTracker(rate_hz=scene.rate_hz, measures=measures or person.measures)
        """
        found = self._native.estimated_measures(_with_points(clouds, self._native.size_frames))
        return None if found is None else json.loads(found)

    def find_first_pose(self, clouds: Iterable[npt.ArrayLike | None]) -> FirstPose:
        """Find a person's pose in their first cloud; the next half second says which way they face.

        Someone who stands or walks is found. The tracker stays as it is; one that is given this
        pose answers as ``sinew track body`` does without ``--init``. Without it a tracker begins
        with the first cloud alone, and faces the wrong way twice as often.

        Parameters
        ----------
        clouds : iterable of array_like of shape (n, 3), or None
            Points of the first frames, as :meth:`update` takes them. No more of them are read than
            hold half a second with points, and eight at least.

        Returns
        -------
        FirstPose

        Raises
        ------
        ValueError
            A parameter breaks its rule.

        Examples
        --------
        >>> scene = sinew.simulate_stereo(rate_hz=4.0, points=300)
        >>> person = sinew.BodyTracker(measures=scene.measures)
        >>> first = person.find_first_pose(scene.clouds)
        >>> tracker = sinew.BodyTracker(measures=scene.measures, first_pose=first.pose)
        """
        pose, margin, is_doubtful = self._native.found_first_pose(_with_points(clouds, self._native.decision_frames))
        return FirstPose(np.array(pose, np.float32), margin, is_doubtful)

    def _ends(self, stick: npt.ArrayLike) -> list[list[float]]:
        if self.model != "stick":
            raise ValueError(f"`stick` is for model=\"stick\", not {self.model!r}: leave it out")
        ends = points32(stick, "stick", shape=(2, 3))
        return ends.tolist()

    @property
    def part(self) -> str:
        """``"whole"`` or ``"upper"``."""
        return self._native.part

    @property
    def model(self) -> str:
        """Name of the motion model."""
        return self._native.model

    @property
    def particles(self) -> int:
        """Number of particles."""
        return self._native.particles

    @property
    def seed(self) -> int:
        """Seed of all that is random."""
        return self._native.seed

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return self._native.rate_hz

    @property
    def measures(self) -> dict[str, Any]:
        """The person, as ``body.json`` has it: lengths in metres."""
        measures: dict[str, Any] = json.loads(self._native.measures_json)
        return measures

    @property
    def frame(self) -> int | None:
        """Number of the last frame; None before the first one."""
        return self._native.frame

    @property
    def notes(self) -> list[str]:
        """What was chosen where the parameters say nothing, one sentence each."""
        return self._native.notes

    @property
    def state_crc32(self) -> int:
        """CRC-32 of the tracker's state: ``state_crc32`` of the command's run.json."""
        return self._native.state_crc32

    def __repr__(self) -> str:
        frame = "" if self.frame is None else f", at frame {self.frame}"
        return f"<sinew.BodyTracker: {self.model}, {self.particles} particles, {self.rate_hz:g} Hz{frame}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._native.saved(), self.notes)


def _restored(saved: str, notes: list[str]) -> BodyTracker:
    tracker = BodyTracker.__new__(BodyTracker)
    tracker._native = _sinew.Body.restored(saved, notes)
    return tracker


def _given(value: Any, name: str) -> str | bytes | None:
    """A path, or a dictionary as JSON."""
    if value is None:
        return None
    if is_path(value):
        return os.fspath(value)
    if not isinstance(value, dict):
        raise ValueError(f"`{name}` has to be a path or a dict, not {type(value).__name__}")
    try:
        return json.dumps(value, default=_plain).encode()
    except (TypeError, ValueError) as error:
        raise ValueError(f"`{name}` has to hold plain numbers: {error}") from None


def _plain(value: Any) -> Any:
    """A number or an array of numpy as JSON takes it."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is none")


def _with_points(clouds: Iterable[npt.ArrayLike | None], most: int) -> list[tuple[int, npt.NDArray[np.float32]]]:
    """The first clouds that have as many points as a pose has numbers, with their numbers."""
    seen: list[tuple[int, npt.NDArray[np.float32]]] = []
    least = len(_sinew.BODY_COORDINATES)
    for frame, cloud in enumerate(clouds):
        if cloud is not None and len(points := points32(cloud, "clouds")) >= least:
            seen.append((frame, points))
            if len(seen) == most:
                break
    return seen


def _named(pose: Any) -> Any:
    """A pose that is an array by the names of its coordinates."""
    if pose is None or is_path(pose) or isinstance(pose, dict):
        return pose
    if (rows := entries(pose)) is not None and len(rows) == 1:
        return rows[0]
    row = points32(pose, "first_pose", shape=(30,))
    return dict(zip(_sinew.BODY_COORDINATES, row.tolist()))


def _word(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise ValueError(f"`{name}` has to be a name, not {type(value).__name__}")
    return value
