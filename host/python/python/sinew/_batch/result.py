"""What a batch comes to."""

from __future__ import annotations

import io
import json
import os
from typing import TYPE_CHECKING, Any

from .plan import is_url

if TYPE_CHECKING:
    import pandas
    import pyarrow

Row = dict[str, Any]


class BatchResult:
    """The recordings of a batch; made by :func:`sinew.batch`."""

    def __init__(self, out: str, rows: list[Row], suffix: str = "") -> None:
        self.out: str = out
        """Folder of all results, or its URL."""
        self.rows: list[Row] = rows
        """One dict a recording, in the order of the manifest: id, key, status (``ok``, ``error``,
        ``open``), class and message of an error, seconds and attempts, and whether an earlier run
        did it (from_before)."""
        self._suffix = suffix

    @property
    def ok(self) -> list[Row]:
        """Rows of recordings with a result."""
        return [row for row in self.rows if row["status"] == "ok"]

    @property
    def failed(self) -> list[Row]:
        """Rows of recordings with an error."""
        return [row for row in self.rows if row["status"] == "error"]

    @property
    def open(self) -> list[Row]:
        """Rows of recordings that did not end."""
        return [row for row in self.rows if row["status"] == "open"]

    @property
    def status(self) -> str:
        """Path or URL of the status table."""
        return self.path(f"status{self._suffix}.csv")

    @property
    def summary(self) -> str:
        """Path or URL of the table with the numbers of each recording that has a result."""
        return self.path(f"summary{self._suffix}.csv")

    def path(self, name: str) -> str:
        """Path or URL of a file of the batch, such as ``results/KEY/estimate.csv``."""
        return f"{self.out.rstrip('/')}/{name}" if is_url(self.out) else os.path.join(self.out, *name.split("/"))

    def to_pandas(self) -> pandas.DataFrame:
        """The rows with the numbers of their summary, as a data frame.

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError("`to_pandas` needs pandas: pip install pandas") from error
        table = pandas.DataFrame(self.rows)
        numbers = pandas.read_csv(io.BytesIO(self._summary_bytes()), dtype={"id": str}).drop(columns="id")
        places = [-1 if place is None else place for place in self._summary_rows()]
        numbers = numbers.reindex(places).reset_index(drop=True)
        return pandas.concat([table, numbers.drop(columns=[*table.columns.intersection(numbers.columns)])], axis=1)

    def to_arrow(self) -> pyarrow.Table:
        """The rows with the numbers of their summary, as an Arrow table.

        Raises
        ------
        ImportError
            pyarrow is not installed.
        """
        try:
            import pyarrow
        except ImportError as error:
            raise ImportError("`to_arrow` needs pyarrow: pip install pyarrow") from error
        table = pyarrow.Table.from_pylist(self.rows, schema=_schema())
        numbers = self._summary_arrow()
        places = pyarrow.array(self._summary_rows(), type=pyarrow.int64())
        for name in numbers.column_names:
            if name not in table.column_names:
                table = table.append_column(name, numbers.column(name).take(places))
        return table

    def to_parquet(self) -> None:
        """Write the tables beside the CSV files, as ``status.parquet`` and ``summary.parquet``.

        Raises
        ------
        ImportError
            pyarrow is not installed.
        """
        try:
            import pyarrow
            import pyarrow.parquet
        except ImportError as error:
            raise ImportError("`to_parquet` and `parquet=True` need pyarrow: pip install pyarrow") from error
        status = pyarrow.Table.from_pylist(self.rows, schema=_schema()).drop_columns(["from_before"])
        for path, table in ((self.status, status), (self.summary, self._summary_arrow())):
            file = io.BytesIO()
            pyarrow.parquet.write_table(table, file)
            self._save(os.path.basename(path).removesuffix(".csv") + ".parquet", file.getvalue())

    def _summary_rows(self) -> list[int | None]:
        """The row of the summary for each recording."""
        places: list[int | None] = []
        count = 0
        for row in self.rows:
            places.append(count if row["status"] == "ok" else None)
            count += row["status"] == "ok"
        return places

    def _summary_bytes(self) -> bytes:
        if is_url(self.summary):
            from .remote import Remote

            return Remote(self.out).get(os.path.basename(self.summary)) or b""
        with open(self.summary, "rb") as file:
            return file.read()

    def _save(self, name: str, content: bytes) -> None:
        """Write a table beside the others, all of it or nothing."""
        if is_url(self.out):
            from .remote import Remote

            return Remote(self.out).put(name, content)
        with open(self.path(name + ".partial"), "wb") as file:
            file.write(content)
        os.replace(self.path(name + ".partial"), self.path(name))

    def _summary_arrow(self) -> pyarrow.Table:
        import pyarrow
        import pyarrow.csv

        text = pyarrow.csv.ConvertOptions(column_types={"id": pyarrow.string()})
        return pyarrow.csv.read_csv(io.BytesIO(self._summary_bytes()), convert_options=text)

    def __len__(self) -> int:
        return len(self.rows)

    def __repr__(self) -> str:
        counts = f"{len(self.ok)} ok, {len(self.failed)} failed, {len(self.open)} open"
        return f"<sinew.{type(self).__name__}: {len(self)} recordings, {counts}, {self.out}>"


def row_of(line: str) -> Row:
    """A row of the status table, of a line that the command wrote."""
    found = json.loads(line)
    ended = found["ended"]
    failure = (ended and ended["failure"]) or {"class": "", "message": ""}
    return {
        "id": found["id"],
        "key": found["key"],
        "status": "open" if ended is None else "error" if ended["failure"] else "ok",
        "class": failure["class"],
        "message": failure["message"],
        "seconds": ended and ended["seconds"],
        "attempts": ended and ended["attempts"],
        "from_before": bool(ended and ended["from_before"]),
    }


def _schema() -> pyarrow.Schema:
    import pyarrow

    texts = [(name, pyarrow.string()) for name in ("id", "key", "status", "class", "message")]
    numbers = [("seconds", pyarrow.float64()), ("attempts", pyarrow.int64())]
    return pyarrow.schema([*texts, *numbers, ("from_before", pyarrow.bool_())])
