"""Images, skin and blobs."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._arrays import is_path, whole

ImageArray = npt.NDArray[np.uint8]
MAX_SIDE_PX = 8192

_WHOLE = {"area_px", "left_px", "top_px", "width_px", "height_px"}
BLOB_DTYPE = np.dtype([(name, np.int64 if name in _WHOLE else np.float32) for name in _sinew.BLOB_COLUMNS])


def rgb(value: Any, name: str = "image") -> ImageArray:
    """An image as the extension takes it; one that is not contiguous is copied.

    Raises
    ------
    ValueError
        It has another shape or type, or no pixel.
    """
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"`{name}` has to be an array of pixels: {error}") from None
    if array.ndim != 3 or array.shape[2] != 3:
        remedy = "; np.stack([grey] * 3, axis=2) makes it of a grey one" if array.ndim == 2 else ""
        raise ValueError(f"`{name}` has to have the shape (height, width, 3), not {array.shape}{remedy}")
    # Numbers of lists have no type of their own.
    if isinstance(value, (list, tuple)) and array.dtype == np.int64 and ((array >= 0) & (array <= 255)).all():
        array = array.astype(np.uint8)
    if array.dtype != np.uint8:
        raise ValueError(f"`{name}` has to hold uint8 (0 to 255), not {array.dtype}")
    height, width = array.shape[:2]
    if not (1 <= height <= MAX_SIDE_PX and 1 <= width <= MAX_SIDE_PX):
        raise ValueError(f"`{name}` has to have sides from 1 to {MAX_SIDE_PX} pixels, not {width}x{height}")
    return np.ascontiguousarray(array)


def skin_name(skin: Any) -> str:
    """The name or path of a parameter `skin`."""
    if not is_path(skin):
        raise ValueError(f"`skin` has to be a name or a path, not {type(skin).__name__}")
    return os.fspath(skin)


def rectangle(calibrate: Any) -> tuple[int, int, int, int] | None:
    """The rectangle of a parameter `calibrate`."""
    if calibrate is None:
        return None
    try:
        x, y, width, height = calibrate
    except (TypeError, ValueError):
        raise ValueError(f"`calibrate` has to be x, y, width and height in pixels, not {calibrate!r}") from None
    most = 2**32 - 1
    return (
        whole(x, "calibrate", 0, most),
        whole(y, "calibrate", 0, most),
        whole(width, "calibrate", 1, most),
        whole(height, "calibrate", 1, most),
    )


def read_image(path: str | os.PathLike[str]) -> ImageArray:
    """Read an image file as the command does.

    Parameters
    ----------
    path : str or path
        A PNG, JPEG, PNM or GIF file. A JPEG is turned as its EXIF data say.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Red, green and blue.

    Raises
    ------
    OSError
        The system refuses the file.
    SinewError
        The file is no picture.
    """
    if not is_path(path):
        raise ValueError(f"`path` has to be a path, not {type(path).__name__}")
    return _sinew.read_image(path)


def segment_skin(
    image: npt.ArrayLike,
    *,
    skin: str | os.PathLike[str] = "gaussian",
    calibrate: tuple[int, int, int, int] | None = None,
    raw: bool = False,
) -> npt.NDArray[np.bool_]:
    """Find the skin in an image, as ``sinew segment`` does.

    Parameters
    ----------
    image : array_like of uint8, shape (height, width, 3)
        Red, green and blue. Of OpenCV's order, ``cv2.cvtColor(image, cv2.COLOR_BGR2RGB)`` makes it
        faster than ``image[..., ::-1]``.
    skin : str or path
        ``gaussian``, ``histogram``, or a file that ``sinew train skin`` wrote.
    calibrate : tuple of int, optional
        x, y, width and height in pixels of a rectangle that shows only skin: the model is adapted
        to it.
    raw : bool
        Give each pixel's own decision, without the opening and closing that the tracker applies.

    Returns
    -------
    ndarray of bool, shape (height, width)

    Raises
    ------
    ValueError
        A parameter breaks its rule.
    SinewError
        There is no such skin model.
    """
    return _sinew.segment_skin(rgb(image), skin_name(skin), rectangle(calibrate), bool(raw))


def find_blobs(
    image: npt.ArrayLike,
    *,
    skin: str | os.PathLike[str] = "gaussian",
    calibrate: tuple[int, int, int, int] | None = None,
) -> npt.NDArray[np.void]:
    """Find the blobs of skin in an image, as ``sinew blobs`` does.

    Parameters
    ----------
    image : array_like of uint8, shape (height, width, 3)
        Red, green and blue.
    skin : str or path
        ``gaussian``, ``histogram``, or a file that ``sinew train skin`` wrote.
    calibrate : tuple of int, optional
        x, y, width and height in pixels of a rectangle that shows only skin.

    Returns
    -------
    structured ndarray, shape (n,)
        A row a blob, the most likely hand first. The fields are the columns of the command's table
        after ``image`` and ``blob``: ``hand_likelihood``, ``area_px``, ``centroid_u_px``,
        ``palm_u_px`` and on.

    Raises
    ------
    ValueError
        A parameter breaks its rule.
    SinewError
        There is no such skin model.
    """
    numbers = _sinew.find_blobs(rgb(image), skin_name(skin), rectangle(calibrate))[0]
    blobs = np.empty(len(numbers), dtype=BLOB_DTYPE)
    for column, name in enumerate(_sinew.BLOB_COLUMNS):
        blobs[name] = numbers[:, column]
    return blobs
