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
from ._arm import ArmTracker
from ._arm_estimate import ArmEstimate, ArmPair, ArmParticles
from ._batch import BatchResult, batch
from ._batch.sweep import SweepResult, sweep
from ._body import BodyTracker
from ._body_estimate import BodyEstimate, FirstPose
from ._images import find_blobs, read_image, segment_skin
from ._model import Model, models
from ._motion import Motion, read_motion
from ._online import CyclicEstimate, CyclicTracker
from ._points import read_cloud
from ._simulate import SimulatedKeypoints, simulate_keypoints
from ._simulate_arm import SimulatedArm, simulate_arm
from ._sinew import ANGLES as ANGLE_NAMES
from ._sinew import BODY_COORDINATES as BODY_COORDINATE_NAMES
from ._sinew import BODY_JOINTS as BODY_JOINT_NAMES
from ._sinew import BODY_PARENTS
from ._sinew import FLEXIONS as FLEXION_NAMES
from ._sinew import VERSION as __version__
from ._sinew import SinewError
from ._stereo import SimulatedStereo, simulate_stereo
from ._track import track_cyclic
from ._track_result import CyclicTrack
from ._train import train_cyclic

__all__ = [
    "ANGLE_NAMES",
    "BODY_COORDINATE_NAMES",
    "BODY_JOINT_NAMES",
    "BODY_PARENTS",
    "FLEXION_NAMES",
    "Angles",
    "ArmEstimate",
    "ArmPair",
    "ArmParticles",
    "ArmTracker",
    "BatchResult",
    "BodyEstimate",
    "BodyTracker",
    "CyclicEstimate",
    "CyclicTrack",
    "CyclicTracker",
    "FirstPose",
    "Model",
    "Motion",
    "SimulatedArm",
    "SimulatedKeypoints",
    "SimulatedStereo",
    "SinewError",
    "SweepResult",
    "__version__",
    "angles",
    "batch",
    "find_blobs",
    "layouts",
    "models",
    "read_cloud",
    "read_image",
    "read_motion",
    "segment_skin",
    "simulate_arm",
    "simulate_keypoints",
    "simulate_stereo",
    "sweep",
    "track_cyclic",
    "train_cyclic",
]
