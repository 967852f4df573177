"""The extension module; `sinew` is what to import."""

import os
from typing import Any

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.int64]
_Size = tuple[float, float]
_Image = npt.NDArray[np.uint8]
_Rectangle = tuple[int, int, int, int]

VERSION: str
ANGLES: list[str]
BLOB_COLUMNS: list[str]
FLEXIONS: list[str]

class SinewError(ValueError):
    """A recording, table or model that cannot be used."""

class Model:
    def __init__(self, name: str) -> None: ...
    @staticmethod
    def from_json(name: str, text: str) -> Model: ...
    def to_json(self) -> str: ...
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
def track_array(
    angles: _Floats, frames: _Ints, model: Model, rate_hz: float | None, sigma_deg: float | None, online: bool
) -> dict[str, Any]: ...
def track_angles(
    angles: Angles, model: Model, rate_hz: float | None, sigma_deg: float | None, online: bool
) -> dict[str, Any]: ...
def track_file(
    path: str | os.PathLike[str], model: Model, rate_hz: float | None, sigma_deg: float | None, online: bool
) -> dict[str, Any]: ...
