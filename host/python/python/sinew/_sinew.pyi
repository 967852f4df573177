"""The extension module; `sinew` is what to import."""

import os
from typing import Any

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_Size = tuple[float, float]
_Points = npt.NDArray[np.float32]
_Path = str | os.PathLike[str]
_Given = str | bytes | None
_Image = npt.NDArray[np.uint8]
_Rectangle = tuple[int, int, int, int]

VERSION: str
ANGLES: list[str]
BLOB_COLUMNS: list[str]
FLEXIONS: list[str]
BODY_JOINTS: list[str]
BODY_COORDINATES: list[str]
BODY_PARENTS: list[int]
UPPER_BODY_COORDINATES: list[int]
MAX_CLOUD_POINTS: int

class SinewError(ValueError):
    """A recording, table or model that cannot be used."""

class Model:
    def __init__(self, name: str) -> None: ...
    @staticmethod
    def from_json(name: str, text: str) -> Model: ...
    def to_json(self) -> str: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def rate_hz(self) -> float: ...
    @property
    def cadence_per_min(self) -> float: ...
    @property
    def trained_cycles(self) -> int: ...
    @property
    def mean_cycle_rad(self) -> _Floats: ...

class Angles:
    @property
    def angles_rad(self) -> _Floats: ...
    @property
    def frame(self) -> _Ints: ...
    @property
    def rate_hz(self) -> float | None: ...
    @property
    def facing(self) -> str | None: ...
    @property
    def layout(self) -> str | None: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def doubts(self) -> list[str]: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    @staticmethod
    def of_array(angles: _Floats, frames: _Ints, rate_hz: float | None) -> Angles: ...
    def parts(self) -> tuple[Any, ...]: ...
    @staticmethod
    def of_parts(
        angles: _Floats, frames: _Ints, side: _Floats | None, other: tuple[list[str], list[list[str]]], about: str
    ) -> Angles: ...

class Body:
    def __init__(
        self,
        height_m: float | None,
        measures: _Given,
        part: str,
        model: str,
        particles: int | None,
        seed: int,
        rate_hz: float,
        first_pose: _Given,
        floor_y_m: float | None,
        threads: int | None,
        config: _Given,
    ) -> None: ...
    def update(
        self, points: _Points | None, time_s: float | None, stick: list[list[float]] | None
    ) -> dict[str, Any]: ...
    @property
    def frame(self) -> int | None: ...
    @property
    def part(self) -> str: ...
    @property
    def model(self) -> str: ...
    @property
    def particles(self) -> int: ...
    @property
    def seed(self) -> int: ...
    @property
    def rate_hz(self) -> float: ...
    @property
    def measures_json(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def state_crc32(self) -> int: ...
    def saved(self) -> str: ...
    @staticmethod
    def restored(saved: str, notes: list[str]) -> Body: ...

class ArmTracker:
    def __init__(
        self,
        side: str,
        variant: str | None,
        particles: int | None,
        seed: int,
        rate_hz: float,
        skin: str,
        calibrate: _Rectangle | None,
        front_end: str,
        face: str,
        config_file: str | None,
        config_json: str | None,
        size_px: tuple[int, int] | None,
    ) -> None: ...
    def update(
        self,
        image: _Image | None,
        hands: _Floats | None,
        has_sides: bool,
        head: tuple[float, float, float] | None,
        time_s: float | None,
    ) -> list[dict[str, Any]]: ...
    def particles(self) -> list[dict[str, Any]]: ...
    @property
    def state_crc32(self) -> int | None: ...
    @property
    def frame(self) -> int | None: ...
    @property
    def side(self) -> str: ...
    @property
    def rate_hz(self) -> float: ...
    @property
    def size_px(self) -> tuple[int, int] | None: ...
    @property
    def config_json(self) -> str: ...
    def saved(self) -> str: ...
    @staticmethod
    def restored(saved: str) -> ArmTracker: ...

class Tracker:
    def __init__(self, model: Model, rate_hz: float, sigma_deg: float | None) -> None: ...
    def update(self, angles_rad: _Floats, dt_frames: int) -> dict[str, Any] | None: ...
    @property
    def frame(self) -> int | None: ...
    @property
    def rate_hz(self) -> float: ...
    def covariance_rad2(self) -> _Floats: ...
    def saved(self) -> tuple[int | None, str | None]: ...
    def restore(self, frame: int | None, state: str | None) -> None: ...

def models() -> list[str]: ...
def layouts() -> list[str]: ...
def angles_of_array(
    keypoints: _Floats, layout: str, fps: float, image_size_px: _Size | None, min_confidence: float, facing: str | None
) -> Angles: ...
def angles_of_file(
    path: str | os.PathLike[str],
    fps: float | None,
    image_size_px: _Size | None,
    min_confidence: float,
    facing: str | None,
    person: str,
) -> Angles: ...
def find_blobs(image: _Image, skin: str, calibrate: _Rectangle | None) -> tuple[_Floats, int]: ...
def read_image(path: str | os.PathLike[str]) -> _Image: ...
def segment_skin(image: _Image, skin: str, calibrate: _Rectangle | None, raw: bool) -> npt.NDArray[np.bool_]: ...
def simulate_arm(
    motion: str | os.PathLike[str],
    frames: int | None,
    rate_hz: float,
    side: str,
    seed: int,
    false_blob: float,
    hidden: float,
    away: tuple[int, int] | None,
    noise_std: float,
) -> tuple[_Image, _Floats, str, list[str]]: ...
def simulate_keypoints(
    model: Model,
    seconds: float,
    rate_hz: float,
    facing: str,
    height_px: float,
    sigma_px: float,
    missing: float,
    seed: int,
) -> tuple[_Floats, list[int], float]: ...
def track_angles(angles: Angles, model: Model, how: dict[str, Any]) -> dict[str, Any]: ...
def track_file(
    path: str | os.PathLike[str], model: Model, how: dict[str, Any]
) -> tuple[dict[str, Any], list[str]]: ...
def train_file(
    cuts: str | os.PathLike[str], length: int, rate_hz: float | None, mirror: bool
) -> Model: ...
def train_angles(
    recordings: list[tuple[Angles, list[tuple[int, int]] | None, str | None]],
    length: int,
    rate_hz: float | None,
    mirror: bool,
) -> Model: ...
def read_cloud(path: _Path) -> _Points: ...
def read_motion(
    path: _Path,
    skeleton: _Path | None,
    rate_hz: float | None,
    metres_per_unit: float | None,
    names: _Path | None,
    partial: bool,
) -> dict[str, Any]: ...
def turn_of_up(up: str) -> list[list[float]]: ...
def simulate_stereo(
    motion: _Path,
    skeleton: _Path | None,
    motion_rate_hz: float | None,
    between_s: tuple[float, float] | None,
    partial: bool,
    distance_m: float,
    heading_deg: float,
    rate_hz: float,
    part: str,
    points: int,
    outliers: float,
    patches: int,
    hide: list[str],
    seed: int,
) -> dict[str, Any]: ...
