"""Recorded motion."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import numpy as np

from . import _sinew
from ._arrays import positive
from ._points import PointArray

Path = str | os.PathLike[str]


@dataclass(frozen=True, eq=False)
class Motion:
    """Named points of a person over time; made by :func:`read_motion`."""

    rate_hz: float
    """Frames per second."""
    names: list[str]
    """Names of the k points, in the file's order."""
    joints_m: PointArray
    """Places, (n, k, 3) metres, NaN where a point was not seen."""
    parents: list[int] | None
    """Index of each point's parent, -1 of a root; None where the file has no skeleton."""
    up: str | None
    """The axis along which the person stands, such as ``"y"`` or ``"-z"``; None where nothing tells."""
    is_on_skin: bool
    """Whether the points are markers on the skin. Joints if not."""
    is_scale_assumed: bool
    """Whether lengths are assumed, since the file gives no unit."""
    notes: list[str]
    """What a user should know of the file, one sentence each."""

    def in_camera_axes(self, up: str | None = None) -> Motion:
        """The same motion in the axes of a camera before the person: y down, x to the right.

        The points are turned about a coordinate axis and not shifted. Of a file with y up this
        gives (x, -y, -z).

        Parameters
        ----------
        up : {"x", "y", "z", "-x", "-y", "-z"}, optional
            The axis of :attr:`joints_m` that points up; :attr:`up` where not given.

        Raises
        ------
        ValueError
            Nothing tells which way is up, or ``up`` is no axis.
        """
        axis = self.up if up is None else up
        if axis is None:
            raise ValueError("`up` has to be given: no neck and hips tell which way is up")
        turn = np.array(_sinew.turn_of_up(axis), dtype=np.float32)
        return replace(self, joints_m=self.joints_m @ turn.T, up="-y")

    def joint(self, name: str) -> PointArray:
        """Places of one point, (n, 3) metres.

        Raises
        ------
        KeyError
            There is no point of this name.
        """
        if name not in self.names:
            raise KeyError(f"no point {name!r}; there are {', '.join(self.names)}")
        return self.joints_m[:, self.names.index(name)]

    def __len__(self) -> int:
        return len(self.joints_m)

    def __repr__(self) -> str:
        return f"<sinew.Motion: {len(self)} frames of {len(self.names)} points at {self.rate_hz:g} Hz>"


def read_motion(
    path: Path,
    *,
    skeleton: Path | None = None,
    rate_hz: float | None = None,
    metres_per_unit: float | None = None,
    names: Path | None = None,
    partial: bool = False,
) -> Motion:
    """Read a motion: BVH, AMC with its ASF, exponential maps, TRC or C3D.

    Parameters
    ----------
    path : path
        The file; its ending says the format.
    skeleton : path, optional
        Skeleton of an AMC file; the only .asf beside it where not given.
    rate_hz : float, optional
        Frames per second, in the place of what the file says; 120 of a file that does not say.
    metres_per_unit : float, optional
        Length unit of a BVH file; found from the arms where not given.
    names : path, optional
        File of names for points, lines as ``left_hip,NAME``; each becomes one more point.
    partial : bool
        Take a file with fewer frames than its header promises.

    Returns
    -------
    Motion
        In the axes of the file; :meth:`Motion.in_camera_axes` turns it.

    Raises
    ------
    SinewError
        The file breaks a rule of its format.
    OSError
        The file cannot be read.
    """
    rate = None if rate_hz is None else positive(rate_hz, "rate_hz")
    unit = None if metres_per_unit is None else positive(metres_per_unit, "metres_per_unit")
    return Motion(**_sinew.read_motion(path, skeleton, rate, unit, names, bool(partial)))
