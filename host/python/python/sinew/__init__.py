"""Human motion tracking: numpy in, numpy out.

A recording of keypoints becomes joint angles, and these become cycles, cadence and gait::

    import sinew

    walk = sinew.simulate_keypoints(seconds=6.0)
    angles = sinew.angles(walk.keypoints, layout=walk.layout, fps=walk.rate_hz)
    track = sinew.track_cyclic(angles, model="walking")
    print(track.cadence_per_min, track.flexion_deg["l_knee_flexion"].max())

Angles are radians unless a name ends in ``_deg``. Missing numbers are NaN.
"""

from ._angles import Angles, angles, layouts
from ._batch import BatchResult, batch
from ._batch.sweep import SweepResult, sweep
from ._model import Model, models
from ._online import CyclicEstimate, CyclicTracker
from ._simulate import SimulatedKeypoints, simulate_keypoints
from ._sinew import ANGLES as ANGLE_NAMES
from ._sinew import FLEXIONS as FLEXION_NAMES
from ._sinew import VERSION as __version__
from ._sinew import SinewError
from ._track import track_cyclic
from ._track_result import CyclicTrack

__all__ = [
    "ANGLE_NAMES",
    "FLEXION_NAMES",
    "Angles",
    "BatchResult",
    "CyclicEstimate",
    "CyclicTrack",
    "CyclicTracker",
    "Model",
    "SimulatedKeypoints",
    "SinewError",
    "SweepResult",
    "__version__",
    "angles",
    "batch",
    "layouts",
    "models",
    "simulate_keypoints",
    "sweep",
    "track_cyclic",
]
