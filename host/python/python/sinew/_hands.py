"""Hands and faces that another detector found."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ._arrays import FloatArray, floats
from ._columns import entries, labels

_COLUMNS = ("u_px", "v_px", "size_px", "probability")
_SIDES = {"left": 0.0, "right": 1.0, "": np.nan}


def hand_rows(hands: Any) -> tuple[FloatArray, bool]:
    """Rows of u, v, size, probability and side (0 left, 1 right, NaN unknown); whether there are sides.

    Raises
    ------
    ValueError
        They are none.
    """
    if isinstance(hands, np.ndarray) and hands.dtype.names is not None:
        names = hands.dtype.names
        found = [dict(zip(names, row.tolist())) for row in hands.reshape(-1)]
        return _of_mappings(found, "side" in names)
    if isinstance(hands, (list, tuple)) and any(isinstance(hand, Mapping) for hand in hands):
        if not all(isinstance(hand, Mapping) for hand in hands):
            raise ValueError("`hands` has to hold dictionaries alone, or none")
        return _of_mappings(list(hands), any(hand.get("side") is not None for hand in hands))
    if (names := labels(hands)) is not None:
        return _of_mappings(entries(hands) or [], "side" in names)
    rows = floats(hands, "hands")
    if rows.size == 0 and rows.ndim <= 2:
        return np.empty((0, 5)), rows.shape[-1:] == (5,)
    if rows.ndim != 2 or rows.shape[1] not in (4, 5):
        raise ValueError(f"`hands` has to have the shape (n, 4) or (n, 5), not {rows.shape}")
    has_sides = rows.shape[1] == 5
    if not has_sides:
        rows = np.column_stack([rows, np.full(len(rows), np.nan)])
    elif not (np.isnan(rows[:, 4]) | (rows[:, 4] == 0.0) | (rows[:, 4] == 1.0)).all():
        raise ValueError("`hands` has to have 0 (left), 1 (right) or NaN in its fifth column")
    return np.ascontiguousarray(rows), has_sides


def _of_mappings(hands: list[Mapping[str, Any]], has_sides: bool) -> tuple[FloatArray, bool]:
    rows = np.full((len(hands), 5), np.nan)
    for row, hand in zip(rows, hands):
        for column, name in enumerate(_COLUMNS):
            row[column] = _number(hand, name, "hands")
        row[4] = _side(hand.get("side"))
    return rows, has_sides


def _number(entry: Mapping[str, Any], name: str, parameter: str) -> float:
    if name not in entry:
        raise ValueError(f"`{parameter}` has to have `{name}`, but has {', '.join(map(str, entry)) or 'nothing'}")
    try:
        return float(entry[name])
    except (TypeError, ValueError):
        raise ValueError(f"`{name}` of `{parameter}` has to be a number, not {entry[name]!r}") from None


def _side(side: Any) -> float:
    if isinstance(side, bytes):
        side = side.decode("ascii", "replace")
    if side is None or (isinstance(side, (float, np.floating)) and np.isnan(side)):
        return np.nan
    if isinstance(side, str) and side in _SIDES:
        return _SIDES[side]
    if isinstance(side, (int, float, np.integer, np.floating)) and side in (0, 1):
        return float(side)
    raise ValueError(f"`side` of `hands` has to be left, right or empty, not {side!r}")


def head_box(head: Any) -> tuple[float, float, float]:
    """Middle and width of a face's box, pixels.

    Raises
    ------
    ValueError
        It is none.
    """
    if isinstance(head, np.void) and head.dtype.names is not None:
        head = dict(zip(head.dtype.names, head.tolist()))
    if (of_frame := entries(head)) is not None and len(of_frame) == 1:
        head = of_frame[0]
    if isinstance(head, Mapping):
        u_px, v_px, size_px = (_number(head, name, "head") for name in _COLUMNS[:3])
        return u_px, v_px, size_px
    box = floats(head, "head")
    if box.shape != (3,):
        raise ValueError(f"`head` has to be u_px, v_px and size_px, not an array of the shape {box.shape}")
    return float(box[0]), float(box[1]), float(box[2])
