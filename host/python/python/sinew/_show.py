"""Tables and plots of a tracked recording."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np

from ._sinew import FLEXIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._track_result import CyclicTrack

HIPS_AND_KNEES = ["l_hip_flexion", "r_hip_flexion", "l_knee_flexion", "r_knee_flexion"]


def cadence(track: CyclicTrack) -> str:
    """Cycles and cadence in words."""
    cycles = f"{track.summary['cycles']:.1f} cycles"
    if track.cadence_per_min is None:
        return f"{cycles}, no cadence"
    spread = track.cadence_std_per_min
    return f"{cycles} at {track.cadence_per_min:.1f}{'' if spread is None else f' +- {spread:.1f}'} a minute"


def html(track: CyclicTrack) -> str:
    """A table with cadence, ranges and doubts for a notebook."""
    rows = [
        ("recording", f"{len(track)} rows, {track.summary['duration_s']:.1f} s at {track.rate_hz:g} Hz"),
        ("motion", cadence(track)),
    ]
    for name, values in track.flexion_deg.items():
        if np.isfinite(values).any():
            low, high = np.nanmin(values), np.nanmax(values)
            rows.append((name.replace("_", " "), f"{low:.0f} to {high:.0f} degrees"))
    rows += [("doubt", doubt) for doubt in track.doubts]
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows)
    return f"<table><caption>sinew.CyclicTrack</caption><tbody>{cells}</tbody></table>"


def plot(track: CyclicTrack, names: list[str] | None, ax: Axes | None) -> Axes:
    """See `CyclicTrack.plot`."""
    names = HIPS_AND_KNEES if names is None else list(names)
    for name in names:
        if name not in track.flexion_deg:
            raise ValueError(f"`names` has to hold names of {', '.join(FLEXIONS)}, not {name!r}")
    if ax is None:
        try:
            from matplotlib import pyplot
        except ImportError as error:
            raise ImportError("`plot` needs matplotlib: pip install matplotlib") from error
        ax = pyplot.subplots()[1]
    for name in names:
        ax.plot(track.time_s, track.flexion_deg[name], label=name.replace("_", " "))
    for start_s in track.summary["cycle_starts_s"]:
        ax.axvline(track.time_s[0] + start_s, color="0.85", linewidth=1, zorder=0)
    ax.set(xlabel="time (s)", ylabel="angle (degrees)", title=cadence(track))
    ax.legend(loc="upper right", fontsize="small")
    return ax
