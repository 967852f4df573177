"""Data frames and series, whose columns have names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def labels(value: Any) -> list[str] | None:
    """Names of a data frame's columns or a series' entries; None of what has none, or numbers."""
    found = getattr(value, "column_names", None)
    if found is None:
        found = getattr(value, "columns", None)
    if found is None and hasattr(value, "to_numpy") and hasattr(value, "keys"):
        found = value.keys()
    if found is None or all(isinstance(label, (int, np.integer)) for label in found):
        return None
    return [str(label) for label in found]


def by_name(value: Any, names: Sequence[str], parameter: str, unit: str) -> Any:
    """The columns of a data frame or the entries of a series in the order of ``names``; anything
    else as it is. A name may end in its ``unit``.

    Raises
    ------
    ValueError
        A name is missing, unknown or there twice.
    """
    found = labels(value)
    if found is None:
        return value
    plain = [label.removesuffix(unit) for label in found]
    lacks = [name for name in names if name not in plain]
    others = [label for at, label in enumerate(found) if plain[at] not in names or plain[at] in plain[:at]]
    if lacks or others:
        faults = ["it lacks " + ", ".join(lacks)] * bool(lacks) + ["it has also " + ", ".join(others)] * bool(others)
        raise ValueError(f"`{parameter}` has to have the columns {', '.join(names)}: {' and '.join(faults)}")
    return np.asarray(value)[..., [plain.index(name) for name in names]]


def entries(value: Any) -> list[dict[str, Any]] | None:
    """The rows of a data frame as dictionaries; None of what has no names."""
    found = labels(value)
    if found is None:
        return None
    return [dict(zip(found, row)) for row in np.atleast_2d(np.asarray(value, dtype=object)).tolist()]
