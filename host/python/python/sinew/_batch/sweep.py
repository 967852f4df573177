"""Recordings tracked with all combinations of some options."""

from __future__ import annotations

import csv
import io
import itertools
import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from . import batch
from .manifest import cell, flag, rows_of
from .result import BatchResult, Row

if TYPE_CHECKING:
    import pandas

# Columns of the table that are no parameters and no numbers.
OWN = ("id", "input", "status")


class SweepResult(BatchResult):
    """The recordings of a sweep; made by :func:`sinew.sweep`."""

    def __init__(self, batch: BatchResult, parameters: list[Row]) -> None:
        super().__init__(batch.out, batch.rows)
        self.parameters: list[Row] = parameters
        """Input and options of each of :attr:`rows`, one dict each."""

    @property
    def table(self) -> str:
        """Path or URL of ``sweep.csv``: parameters beside the numbers of the summary."""
        return self.path("sweep.csv")

    def to_pandas(self) -> pandas.DataFrame:
        """The rows with their parameters and numbers, as a data frame.

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        table = super().to_pandas()
        import pandas

        parameters = pandas.DataFrame(self.parameters)
        others = table.drop(columns=["id", *parameters.columns.intersection(table.columns)])
        return pandas.concat([table[["id"]], parameters, others], axis=1)

    def _write(self) -> None:
        """Write ``sweep.csv``: the numbers as the summary has them."""
        summary = list(csv.reader(io.StringIO(self._summary_bytes().decode("utf-8"))))
        names = list(self.parameters[0])
        header, rows = summary[0][1:], summary[1:]
        kept = [index for index, name in enumerate(header, 1) if name not in (*OWN, *names)]
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(["id", *names, "status", *(header[index - 1] for index in kept)])
        for row, parameters, place in zip(self.rows, self.parameters, self._summary_rows()):
            numbers = [""] * len(kept) if place is None else [rows[place][index] for index in kept]
            values = (str(value).lower() if isinstance(value, bool) else value for value in parameters.values())
            table.writerow([row["id"], *values, row["status"], *numbers])
        self._save("sweep.csv", text.getvalue().encode("utf-8"))


def sweep(
    inputs: str | os.PathLike[str] | Iterable[Any],
    over: Mapping[str, Iterable[Any]],
    out: str | os.PathLike[str],
    *,
    kind: str | None = None,
    **options: Any,
) -> SweepResult:
    """Track recordings with every combination of some options, each once.

    Parameters
    ----------
    inputs : path, iterable of paths, iterable of dict, or table
        Recordings by their paths; or rows as :func:`batch` takes them, with ``id`` and ``input``.
    over : dict
        Values of each option, named like the command's flags:
        ``{"seed": range(5), "particles": [20, 50]}``.
    out : path or URL
        As of :func:`batch`; ``sweep.csv`` in it has a row for each combination, and
        ``sinew report`` shows it.
    kind : str, optional
        What is done with recordings that have no ``kind``: ``cyclic``, ``arm``, ``body``, ...
    **options
        As of :func:`batch`: ``engine``, ``set``, ``jobs``, ``address``, ...

    Returns
    -------
    SweepResult

    Raises
    ------
    ValueError
        A parameter breaks its rule.
    SinewError, OSError, ImportError
        As :func:`batch`.
    """
    if "shard" in options:
        raise ValueError("`shard` is for `sinew.batch`: a sweep has one table")
    values = _values(over)
    rows, parameters = [], []
    for recording in _recordings(inputs, kind):
        for chosen in itertools.product(*values.values()):
            combination = dict(zip(values, chosen))
            name = ".".join([str(recording["id"]), *(f"{name}={value}" for name, value in combination.items())])
            rows.append({**recording, **combination, "id": name})
            parameters.append({"input": recording["input"], **combination})
    if not rows:
        raise ValueError("`inputs` names no recording")
    found = SweepResult(batch(rows, out, **options), parameters)
    found._write()
    return found


def _values(over: Any) -> dict[str, list[Any]]:
    """The values of each option.

    Raises
    ------
    ValueError
        It is no dict of lists with at least one value each.
    """
    if not isinstance(over, Mapping) or not over:
        raise ValueError('`over` has to be a dict such as {"seed": range(5)}')
    values: dict[str, list[Any]] = {}
    for name, some in over.items():
        if flag(name) in ("id", "input", "status"):
            raise ValueError(f"`over`: `{name}` is no option")
        if isinstance(some, (str, bytes, Mapping)) or not isinstance(some, Iterable):
            raise ValueError(f"`over`: `{name}` has to be a list of values, not {type(some).__name__}")
        values[str(name)] = [cell(value, f"`over`: `{name}`") for value in some]
        if not values[str(name)] or None in values[str(name)]:
            raise ValueError(f"`over`: `{name}` has to have values, none of them missing")
    return values


def _recordings(inputs: Any, kind: str | None) -> list[Row]:
    """Rows with ``id`` and ``input``, of paths or rows."""
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    is_table = hasattr(inputs, "to_pylist") or hasattr(inputs, "columns")
    some = rows_of(inputs) if is_table else list(inputs)
    rows: list[Row] = []
    for number, one in enumerate(some, 1):
        if isinstance(one, (str, os.PathLike)):
            path = os.fspath(one)
            one = {"id": os.path.splitext(os.path.basename(path.rstrip("/")))[0], "input": path}
        if not isinstance(one, Mapping) or not {"id", "input"} <= set(one):
            raise ValueError(f"`inputs`, row {number}: has to be a path, or a dict with `id` and `input`")
        rows.append({**({"kind": kind} if kind else {}), **one})
    return rows
