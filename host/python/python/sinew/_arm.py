"""Tracking arms frame by frame."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arm_estimate import ArmEstimate, ArmPair, ArmParticles
from ._arrays import is_path, number, positive, whole
from ._hands import hand_rows, head_box
from ._images import MAX_SIDE_PX, rectangle, rgb, skin_name

_FACES = {True: "found", False: "unknown", "given": "given"}


class ArmTracker:
    """A tracker of shoulder, elbow and hand before one camera, frame by frame.

    The answers are those of ``sinew track arm`` with the same options, bit for bit. It can be
    pickled at any frame, and goes on where it was. One thread at a time may use it; trackers in
    different threads run at the same time.

    Parameters
    ----------
    side : {"right", "left", "both"}
        Which arms; left is the person's left.
    variant : str, optional
        Which tracker; by default that of ``config``, or ``pik``.
    particles : int, optional
        Particles of each arm; by default those of ``config``, or 50.
    seed : int
        Seed of all that is random.
    rate_hz : float
        Frames per second of the camera.
    skin : str or path
        ``gaussian``, ``histogram``, or a file that ``sinew train skin`` wrote.
    calibrate : tuple of int, optional
        x, y, width and height in pixels of a rectangle of skin in the first image. No face is
        looked for then.
    front_end : {"pictures", "lines"}
        Whole pictures, or lines of at most 320 x 240 pixels as firmware reads them.
    face : bool or "given"
        Whether a face is looked for, which gives skin, shoulders and hands over time. With
        ``"given"`` faces come from ``head`` alone.
    config : path or dict, optional
        Camera, person and thresholds: a TOML file of ``sinew track arm --print-config``, or a
        dictionary with its sections.
    size_px : tuple of int, optional
        Width and height of the images; by default those of the first one. Needed where the first
        frame has none.

    Raises
    ------
    ValueError
        A parameter breaks its rule; the message names both.
    SinewError
        The configuration or the skin model breaks a rule.
    OSError
        The configuration cannot be read.

    Examples
    --------
    >>> tracker = sinew.ArmTracker(rate_hz=30.0)
    >>> for image in camera:
    ...     estimate = tracker.update(image)
    ...     print(estimate.status, estimate.hand_m)
    """

    __slots__ = ("_native",)

    def __init__(
        self,
        *,
        side: str = "right",
        variant: str | None = None,
        particles: int | None = None,
        seed: int = 1,
        rate_hz: float = 15.0,
        skin: str | os.PathLike[str] = "gaussian",
        calibrate: tuple[int, int, int, int] | None = None,
        front_end: str = "pictures",
        face: bool | str = True,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        size_px: tuple[int, int] | None = None,
    ) -> None:
        if not (isinstance(face, (bool, np.bool_)) or face == "given"):
            raise ValueError(f'`face` has to be True, False or "given", not {face!r}')
        file, text = _config(config)
        self._native = _sinew.ArmTracker(
            _word(side, "side"),
            None if variant is None else _word(variant, "variant"),
            None if particles is None else whole(particles, "particles", 1, 5000),
            whole(seed, "seed", 0, 2**64 - 1),
            positive(rate_hz, "rate_hz"),
            skin_name(skin),
            rectangle(calibrate),
            _word(front_end, "front_end"),
            _FACES[face if isinstance(face, str) else bool(face)],
            file,
            text,
            None if size_px is None else _size(size_px),
        )

    def update(
        self,
        image: npt.ArrayLike | None = None,
        *,
        hands: Any = None,
        head: Any = None,
        time_s: float | None = None,
    ) -> ArmEstimate | ArmPair:
        """Answer the next frame.

        Parameters
        ----------
        image : array_like of uint8, shape (height, width, 3), optional
            Red, green and blue; a missing frame where not given. One that is contiguous is not
            copied, and must not be changed meanwhile. Of OpenCV's order,
            ``cv2.cvtColor(image, cv2.COLOR_BGR2RGB)`` makes it faster than ``image[..., ::-1]``.
        hands : array_like or list of dict, optional
            Hands that any detector found, in place of blobs: a structured array or dictionaries
            with ``u_px``, ``v_px`` (middle), ``size_px`` (diameter), ``probability`` and where it
            is known ``side``, or a data frame with these columns; or an array (n, 4), or (n, 5)
            with 0 for left, 1 for right and NaN.
        head : array_like of shape (3,) or dict, optional
            The person's face that any detector found: ``u_px``, ``v_px``, and ``size_px``, the
            width of its box.
        time_s : float, optional
            When the frame was taken, seconds from any beginning: for all frames or for none, which
            are then even at ``rate_hz``.

        Returns
        -------
        ArmEstimate or ArmPair
            With ``side="both"`` the pair of left and right.

        Raises
        ------
        ValueError
            A parameter breaks its rule. The frame does not count then.
        """
        pixels = None if image is None else rgb(image)
        rows, has_sides = (None, False) if hands is None else hand_rows(hands)
        box = None if head is None else head_box(head)
        time = None if time_s is None else number(time_s, "time_s")
        answers = [ArmEstimate(**arm) for arm in self._native.update(pixels, rows, has_sides, box, time)]
        return ArmPair(*answers) if len(answers) == 2 else answers[0]

    def particles(self) -> list[ArmParticles]:
        """The particles after the last frame, one entry an arm, left first; none before a frame."""
        return [ArmParticles(**arm) for arm in self._native.particles()]

    @property
    def side(self) -> str:
        """Which arms: ``left``, ``right`` or ``both``."""
        return self._native.side

    @property
    def rate_hz(self) -> float:
        """Frames per second."""
        return self._native.rate_hz

    @property
    def frame(self) -> int | None:
        """Number of the last frame; None before the first one."""
        return self._native.frame

    @property
    def size_px(self) -> tuple[int, int] | None:
        """Width and height of the images; None while they are not known."""
        return self._native.size_px

    @property
    def config(self) -> dict[str, Any]:
        """Camera, person, tracker and thresholds, with all defaults."""
        config: dict[str, Any] = json.loads(self._native.config_json)
        return config

    @property
    def state_crc32(self) -> int | None:
        """CRC-32 of the trackers' state, as in the command's ``run.json``; None while there is none.

        Runs with the same number have the same bits.
        """
        return self._native.state_crc32

    def __repr__(self) -> str:
        return f"ArmTracker(side={self.side!r}, rate_hz={self.rate_hz:g}, frame={self.frame})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._native.saved(),)


def _restored(saved: str) -> ArmTracker:
    tracker = ArmTracker.__new__(ArmTracker)
    tracker._native = _sinew.ArmTracker.restored(saved)
    return tracker


def _word(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise ValueError(f"`{name}` has to be a word, not {type(value).__name__}")
    return value


def _size(size_px: Any) -> tuple[int, int]:
    try:
        width, height = size_px
    except (TypeError, ValueError):
        raise ValueError(f"`size_px` has to be width and height in pixels, not {size_px!r}") from None
    return whole(width, "size_px", 1, MAX_SIDE_PX), whole(height, "size_px", 1, MAX_SIDE_PX)


def _config(config: Any) -> tuple[str | None, str | None]:
    """File or JSON text of a parameter `config`."""
    if config is None:
        return None, None
    if is_path(config):
        return os.fspath(config), None
    if not isinstance(config, Mapping):
        raise ValueError(f"`config` has to be a path or a dictionary, not {type(config).__name__}")
    try:
        return None, json.dumps(config, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise ValueError(f"`config` has to hold finite numbers, words and lists: {error}") from None


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and other mappings, as JSON has them."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} is neither")
