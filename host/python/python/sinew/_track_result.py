"""What a tracked recording comes to."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _show
from ._arrays import FloatArray
from ._sinew import ANGLES, FLEXIONS

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from matplotlib.axes import Axes

ROW_COLUMNS = ("cycle_position", "cycles", "is_known", "outlier", "misfit")


class CyclicTrack:
    """A tracked recording of n rows; made by :func:`sinew.track_cyclic`.

    Rows in which nothing is known of the person are NaN in all arrays of numbers. It holds numpy
    arrays and plain Python objects alone, so it can be pickled.
    """

    def __init__(
        self, found: dict[str, Any], time_s: FloatArray | None = None, notes: list[str] | None = None
    ) -> None:
        self._json: str = found["json"]
        self.rate_hz: float = found["rate_hz"]
        """Frames per second."""
        self.frame: npt.NDArray[np.int64] = found["frame"]
        """Number of each row's frame, (n,)."""
        self.time_s: FloatArray = self.frame / self.rate_hz if time_s is None else time_s
        """Time of each row, (n,) seconds."""
        self.angles_rad: FloatArray = found["angles_rad"]
        """Estimated angles, (n, 13) radians, unwrapped along time."""
        self.std_rad: FloatArray = found["std_rad"]
        """Standard deviations of the angles, (n, 13) radians."""
        covariance = found["covariance_rad2"]
        self.covariance_rad2: FloatArray | None = None if covariance is None else covariance.reshape(-1, 13, 13)
        """Covariance of the filter's angles, (n, 13, 13) rad^2, if it was asked for; NaN where the
        phase was unknown."""
        self.is_known: npt.NDArray[np.bool_] = found["is_known"]
        """Whether anything is known of the person, (n,)."""
        self.outlier: npt.NDArray[np.bool_] = found["outlier"]
        """Whether a measurement of the row did not belong to the motion, (n,)."""
        self.misfit: npt.NDArray[np.bool_] = found["misfit"]
        """Whether the motion was not the model's, (n,)."""
        self.cycle_position: FloatArray = found["cycle_position"]
        """Position in the cycle, (n,) in [0, 1)."""
        self.cycles: FloatArray = found["cycles"]
        """Cycles since the first row, (n,)."""
        self.flexion_deg: dict[str, FloatArray] = dict(zip(FLEXIONS, found["flexion_deg"].T.copy()))
        """Anatomical angles by name, each (n,) degrees; NaN where the joint was never measured."""
        self.notes: list[str] = list(notes or [])
        """What a user should know of the recording, one sentence each."""
        self.doubts: list[str] = found["doubts"]
        """What speaks against the recording or the result, one sentence each."""
        self.sigma_deg: float = found["sigma_deg"]
        """Standard deviation of a measured angle that was used, degrees."""

    @cached_property
    def _said(self) -> list[Any]:
        """Summary, symmetries and gait: read when one of them is asked for."""
        said: list[Any] = json.loads(self._json)
        return said

    @property
    def summary(self) -> dict[str, Any]:
        """Cycles, cadence, outliers: ``summary`` of the command's ``--json``."""
        summary: dict[str, Any] = self._said[0]
        return summary

    @property
    def symmetries(self) -> list[dict[str, Any]]:
        """Left against right, one entry a joint."""
        symmetries: list[dict[str, Any]] = self._said[1]
        return symmetries

    @property
    def gait(self) -> dict[str, Any] | None:
        """Foot strikes, toe-offs, strides and means; None where the feet do not walk or run."""
        gait: dict[str, Any] | None = self._said[2]
        return gait

    @property
    def cadence_per_min(self) -> float | None:
        """Cycles per minute over the recording; None for less than two cycles."""
        cadence: float | None = self.summary["cadence_per_min"]
        return cadence

    @property
    def cadence_std_per_min(self) -> float | None:
        """Standard deviation of the cadence from cycle to cycle; None for less than three."""
        std: float | None = self.summary["cadence_std_per_min"]
        return std

    @property
    def events(self) -> list[dict[str, Any]]:
        """Foot strikes and toe-offs by time: frame, time_s, foot, event, from (point used)."""
        events: list[dict[str, Any]] = []
        for foot, of_foot in (self.gait["events"] if self.gait else {}).items():
            for event, key in (("foot_strike", "strikes"), ("toe_off", "toe_offs")):
                events += [
                    {
                        "frame": frame,
                        "time_s": frame / self.rate_hz,
                        "foot": foot,
                        "event": event,
                        "from": of_foot[key + "_from"],
                    }
                    for frame in of_foot[key]
                ]
        return sorted(events, key=lambda event: event["frame"])

    @property
    def strides(self) -> list[dict[str, Any]]:
        """Strides of both feet in the order of time; shares in [0, 1], times in seconds."""
        return self.gait["strides"] if self.gait else []

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame: an index ``frame``, and the command's columns.

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError("`to_pandas` needs pandas: pip install pandas") from error
        return pandas.DataFrame(self._columns(), index=pandas.Index(self.frame, name="frame"))

    def to_arrow(self) -> pyarrow.Table:
        """The rows as a table of Arrow: the columns of :meth:`to_pandas`, ``frame`` first.

        Raises
        ------
        ImportError
            pyarrow is not installed.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("`to_arrow` needs pyarrow: pip install pyarrow") from error
        return pyarrow.table({"frame": self.frame, **self._columns()})

    def _columns(self) -> dict[str, npt.NDArray[Any]]:
        columns: dict[str, npt.NDArray[Any]] = {"time_s": self.time_s}
        columns |= {f"{name}_rad": self.angles_rad[:, i] for i, name in enumerate(ANGLES)}
        columns |= {f"{name}_std_rad": self.std_rad[:, i] for i, name in enumerate(ANGLES)}
        columns |= {f"{name}_deg": values for name, values in self.flexion_deg.items()}
        return columns | {name: getattr(self, name) for name in ROW_COLUMNS}

    def plot(self, names: list[str] | None = None, ax: Axes | None = None) -> Axes:
        """Draw flexion angles over time, with a line where each cycle begins.

        Parameters
        ----------
        names : list of str, optional
            Names of :attr:`flexion_deg`; hips and knees where not given.
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure where not given.

        Raises
        ------
        ImportError
            matplotlib is not installed.
        ValueError
            There is no angle of such a name.
        """
        return _show.plot(self, names, ax)

    def __len__(self) -> int:
        return len(self.frame)

    def __repr__(self) -> str:
        return f"<sinew.CyclicTrack: {len(self)} rows, {_show.cadence(self)}>"

    def _repr_html_(self) -> str:
        return _show.html(self)
