"""Points in memory, and files of points."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sinew
from ._columns import by_name

PointArray = npt.NDArray[np.float32]


def points32(value: Any, name: str, shape: tuple[int, ...] | None = None) -> PointArray:
    """Points as float32 in C order; the same memory where they are.

    Raises
    ------
    ValueError
        They are no numbers, have another shape than (n, 3) or ``shape``, or are too many.
    """
    if type(value) is np.ndarray and value.dtype == np.float32 and value.flags.carray:
        array = value
    else:
        array = _plain_array(by_name(value, "xyz", name, "_m"), name)
    wanted = shape or (array.shape[0] if array.ndim else 0, 3)
    if shape is None and array.shape == (0,):
        return np.empty((0, 3), dtype=np.float32)
    if array.shape != wanted:
        words = "(n, 3)" if shape is None else str(shape)
        raise ValueError(f"`{name}` has to have the shape {words}, not {array.shape}")
    if array.shape[0] > _sinew.MAX_CLOUD_POINTS:
        raise ValueError(f"`{name}` has to hold at most {_sinew.MAX_CLOUD_POINTS} points, not {array.shape[0]}")
    # Numbers beyond those of float32 become infinite, which is no point.
    with np.errstate(over="ignore"):
        return np.require(array, np.float32, ["C_CONTIGUOUS", "ALIGNED"])


def _plain_array(value: Any, name: str) -> npt.NDArray[Any]:
    """Real numbers of any type; masked ones and None are NaN."""
    try:
        array = value if np.ma.isMaskedArray(value) else np.asarray(value)
        if array.dtype.kind == "O":
            array = np.asarray(value, dtype=np.float64)
        if array.dtype.kind not in "fiu":
            raise ValueError(f"it holds {array.dtype}")
        if np.ma.isMaskedArray(array):
            return np.asarray(np.ma.filled(array.astype(np.float64), np.nan))
        return np.asarray(array)
    except (OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"`{name}` has to be an array of real numbers: {error}") from None


def read_cloud(path: str | os.PathLike[str], camera: str | os.PathLike[str] | None = None) -> PointArray:
    """The points of a PLY, PCD or CSV file, or of a depth image.

    Parameters
    ----------
    path : path
        The file; its ending says the format.
    camera : path, optional
        The ``camera.json`` of a depth image (PNG or PGM, one channel of 16 bits), as
        ``sinew track body`` reads it. Each pixel that has a depth is a point.

    Returns
    -------
    ndarray of shape (n, 3), float32
        Metres in the axes of the file, or of the camera, in its order. Points that are not finite, within 1 cm of
        the origin or farther than 1 km are left out, as ``sinew track body`` does.

    Raises
    ------
    SinewError
        A file breaks a rule of its format.
    OSError
        A file cannot be read.
    """
    return _sinew.read_cloud(path, camera)
