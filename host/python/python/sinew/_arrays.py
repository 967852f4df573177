"""Arrays as the extension takes them."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
MAX_WHOLE = 2**53 - 1
"""Largest frame number or count."""


def is_path(value: Any) -> bool:
    """Whether a parameter is the path of a file."""
    return isinstance(value, (str, os.PathLike))


def floats(value: Any, name: str) -> FloatArray:
    """The numbers of anything like an array, float64; masked ones are NaN.

    Raises
    ------
    ValueError
        They are no numbers, or rows differ in length.
    """
    try:
        masked = np.ma.isMaskedArray(value)
        array = value if masked else np.asarray(value)
        if array.dtype.kind == "O":
            # None is missing as NaN is: numpy makes it NaN.
            array = np.asarray(value, dtype=np.float64)
        if array.dtype.kind not in "fiub":
            raise ValueError(f"`{name}` has to hold real numbers, not {array.dtype}")
        array = array.astype(np.float64, copy=False)
        filled = np.asarray(np.ma.filled(array, np.nan) if masked else array)
        # Numbers of packed records may lie across the borders of words.
        return np.require(filled, requirements=["ALIGNED"])
    except (TypeError, ValueError) as error:
        if str(error).startswith(f"`{name}`"):
            raise
        raise ValueError(f"`{name}` has to be an array of numbers: {error}") from None


def positive(value: Any, name: str) -> float:
    """A number greater than zero.

    Raises
    ------
    ValueError
        It is none.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"`{name}` has to be a number, not {value!r}") from None
    if not (number > 0.0 and np.isfinite(number)):
        raise ValueError(f"`{name}` has to be greater than zero, not {number}")
    return number


def number(value: Any, name: str) -> float:
    """A number.

    Raises
    ------
    ValueError
        It is none.
    """
    try:
        return float(value)
    except (OverflowError, TypeError, ValueError):
        raise ValueError(f"`{name}` has to be a number, not {value!r}") from None


def whole(value: Any, name: str, low: int, high: int) -> int:
    """A whole number from ``low`` to ``high``.

    Raises
    ------
    ValueError
        It is none.
    """
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)) or not low <= value <= high:
        raise ValueError(f"`{name}` has to be a whole number from {low} to {high}, not {value!r}")
    return int(value)
