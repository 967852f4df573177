"""Lists of recordings in all forms that Python has."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Manifest:
    """A file or folder that the command reads, or rows as JSON lines."""

    path: str | None
    text: str | None
    folder: str | None
    """Where relative paths start; None for the manifest's own folder."""

    @staticmethod
    def of(manifest: Any, folder: Any) -> Manifest:
        """The manifest of a parameter `manifest`.

        Raises
        ------
        ValueError
            It is none, or a row is broken.
        """
        if folder is not None and not isinstance(folder, (str, os.PathLike)):
            raise ValueError(f"`folder` has to be a path, not {type(folder).__name__}")
        start = None if folder is None else os.path.abspath(folder)
        if isinstance(manifest, (str, os.PathLike)):
            path = os.path.abspath(manifest)
            if not path.endswith(".parquet") or os.path.isdir(path):
                return Manifest(path, None, start)
            rows, own = parquet_rows(path), os.path.dirname(path)
        else:
            rows, own = rows_of(manifest), os.getcwd()
        return Manifest(None, json_lines(rows), start or own)


def parquet_rows(path: str) -> list[dict[str, Any]]:
    """Rows of a Parquet file."""
    try:
        import pyarrow.parquet
    except ImportError as error:
        raise ImportError("a Parquet `manifest` needs pyarrow: pip install pyarrow") from error
    try:
        rows: list[dict[str, Any]] = pyarrow.parquet.read_table(path).to_pylist()
    except pyarrow.ArrowInvalid as error:
        raise ValueError(f"`manifest`: {path} is no Parquet file ({error})") from None
    return rows


def rows_of(manifest: Any) -> list[Mapping[str, Any]]:
    """Rows of a data frame, an Arrow table, or an iterable of them."""
    if hasattr(manifest, "to_pylist"):
        rows = manifest.to_pylist()
    elif hasattr(manifest, "to_dict") and hasattr(manifest, "columns"):
        rows = manifest.to_dict("records")
    elif isinstance(manifest, Iterable) and not isinstance(manifest, (Mapping, bytes)):
        rows = list(manifest)
    else:
        raise ValueError(f"`manifest` has to be a path, rows, or a table, not {type(manifest).__name__}")
    for number, row in enumerate(rows, 1):
        if not isinstance(row, Mapping):
            raise ValueError(f"`manifest`, row {number}: has to be a dict, not {type(row).__name__}")
    return rows


def json_lines(rows: Iterable[Mapping[str, Any]]) -> str:
    """Rows as the command reads them, a line each."""
    lines = []
    for number, row in enumerate(rows, 1):
        cells = {flag(name): cell(value, f"`manifest`, row {number}: `{name}`") for name, value in row.items()}
        lines.append(json.dumps({name: value for name, value in cells.items() if value is not None}))
    return "".join(line + "\n" for line in lines)


def options(values: Mapping[str, Any] | None, parameter: str) -> list[tuple[str, str]]:
    """Options by the names of their flags, as the command takes them."""
    if values is None:
        return []
    if not isinstance(values, Mapping):
        raise ValueError(f"`{parameter}` has to be a dict, not {type(values).__name__}")
    cells = [(flag(name), cell(value, f"`{parameter}`: `{name}`")) for name, value in values.items()]
    return [(name, word(value)) for name, value in cells if value is not None]


def flag(name: Any) -> str:
    """Name of a flag: ``sigma_deg`` is ``sigma-deg``."""
    return str(name).replace("_", "-")


def word(value: str | int | float | bool) -> str:
    """A value as the command line has it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def cell(value: Any, what: str) -> str | int | float | bool | None:
    """A value of an option; None where there is none.

    Raises
    ------
    ValueError
        It is no text, number, path, True or False.
    """
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    elif hasattr(value, "item") and getattr(value, "shape", ()) == ():
        value = value.item()
    if value is None or (isinstance(value, float) and value != value) or type(value).__name__ in ("NAType", "NaTType"):
        return None
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        # A column of whole numbers with a missing one has become one of floats.
        return int(value)
    if isinstance(value, (str, int, float, bool)):
        return value
    raise ValueError(f"{what} has to be a text, a number, a path, True or False, not {type(value).__name__}")
