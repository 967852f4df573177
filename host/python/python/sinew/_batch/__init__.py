"""Many recordings, each tracked once: on this machine or on a Ray cluster."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Literal

from .. import _sinew
from . import local, ray_engine
from .manifest import Manifest, options
from .plan import Plan
from .progress import Progress
from .result import BatchResult

__all__ = ["BatchResult", "batch"]


def batch(
    manifest: str | os.PathLike[str] | Iterable[Mapping[str, Any]] | Any,
    out: str | os.PathLike[str],
    *,
    engine: Literal["local", "ray"] = "local",
    jobs: int | None = None,
    shard: tuple[int, int] | str | None = None,
    set: Mapping[str, Any] | None = None,
    folder: str | os.PathLike[str] | None = None,
    retry_failed: bool = False,
    parquet: bool = False,
    check: bool = False,
    progress: bool | None = None,
    chunk: int = 100,
    address: str | None = None,
    max_retries: int = 3,
) -> BatchResult:
    """Track a list of recordings, each once, as ``sinew batch`` does and to the same bytes.

    A recording that cannot be tracked is a row with its error, and stops no other. The same call
    again does what is missing.

    Parameters
    ----------
    manifest : path, iterable of dict, pandas.DataFrame or pyarrow.Table
        A CSV table, JSON lines (``.jsonl``), a Parquet file, or a folder of recordings; else rows
        with ``id``, ``input``, ``kind`` and options named like the command's flags.
    out : path or URL
        Folder of all results: ``results/KEY``, ``status.csv``, ``summary.csv``. With
        ``engine="ray"`` also a URL that :mod:`pyarrow.fs` opens.
    engine : {"local", "ray"}
        One process on this machine, or a Ray cluster (``pip install 'sinew[ray]'``).
    jobs : int, optional
        Recordings at once; by default one more than there are processors, with
        ``engine="ray"`` as many.
    shard : (int, int) or str, optional
        ``(I, N)`` or ``"I/N"``: only every N-th recording, beginning with the I-th, from 1. For
        ``engine="local"``.
    set : dict, optional
        Options of all rows that have none: ``{"model": "running"}``.
    folder : path, optional
        Folder that relative paths start from: by default that of the manifest, for rows the one
        that you are in.
    retry_failed : bool
        Try those again that failed before.
    parquet : bool
        Also write ``status.parquet`` and ``summary.parquet``; needs pyarrow.
    check : bool
        Raise :class:`SinewError` if a recording has no result.
    progress : bool, optional
        Print how many are done on standard error; by default where that is a terminal.
    chunk : int
        Most recordings of a task of Ray. Arms and bodies are a task each.
    address : str, optional
        Address of a Ray cluster; by default a cluster on this machine that ends with the call,
        unless Ray is running in this process.
    max_retries : int
        How often Ray does a task again whose worker died.

    Returns
    -------
    BatchResult

    Raises
    ------
    ValueError
        A parameter breaks its rule.
    SinewError
        The manifest is broken: the message names line and rule.
    OSError
        The manifest cannot be read, ``out`` cannot be written, or no cluster is at ``address``.
    ImportError
        A package is missing that the engine or a format needs.
    KeyboardInterrupt
        Ctrl-C came. What was finished is kept; ``status.csv`` shows the others as ``open``.
        Where Ray ran before the call, tasks that it already has go on to their end.
    """
    if engine not in ("local", "ray"):
        raise ValueError(f'`engine` has to be "local" or "ray", not {engine!r}')
    plan = Plan.checked(
        manifest=Manifest.of(manifest, folder),
        out=out,
        jobs=jobs,
        shard=shard,
        set=options(set, "set"),
        retry_failed=retry_failed,
        chunk=chunk,
        address=address,
        max_retries=max_retries,
        is_ray=engine == "ray",
    )
    rows = (ray_engine if engine == "ray" else local).run(plan, Progress(progress))
    result = BatchResult(plan.out, rows, plan.table_suffix)
    if parquet:
        result.to_parquet()
    if check and result.failed:
        first = result.failed[0]
        _sinew.raise_error(
            "data",
            f"{len(result.failed)} of {len(rows)} recordings have no result; "
            f"the first is `{first['id']}`: {first['message']}",
        )
    return result
