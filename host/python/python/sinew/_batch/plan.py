"""What a batch is to do, checked."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from .manifest import Manifest

# Recordings at once; the command has the same limit.
MAX_JOBS = 1024


@dataclass(frozen=True)
class Plan:
    """Parameters of :func:`sinew.batch` that keep their rules."""

    manifest: Manifest
    out: str
    """An absolute path, or a URL."""
    jobs: int | None
    shard: str | None
    set: list[tuple[str, str]]
    retry_failed: bool
    chunk: int
    address: str | None
    max_retries: int

    @staticmethod
    def checked(*, out: Any, is_ray: bool, **parts: Any) -> Plan:
        """The plan of these parameters.

        Raises
        ------
        ValueError
            A parameter breaks its rule; the message names both.
        """
        for name, least in (("jobs", 1), ("chunk", 1), ("max_retries", 0)):
            value = parts[name]
            if (value is not None or name != "jobs") and not is_whole(value, least):
                raise ValueError(f"`{name}` has to be a whole number from {least}, not {value!r}")
        if parts["jobs"] is not None and parts["jobs"] > MAX_JOBS:
            raise ValueError(f"`jobs` has to be at most {MAX_JOBS}, not {parts['jobs']}")
        if not isinstance(out, (str, os.PathLike)):
            raise ValueError(f"`out` has to be a path or URL, not {type(out).__name__}")
        out = os.fspath(out)
        if not is_url(out):
            out = os.path.abspath(out)
        elif not is_ray:
            raise ValueError('`out` has to be a folder of this machine; URLs need engine="ray"')
        parts["shard"] = shard(parts["shard"])
        if is_ray and parts["shard"]:
            raise ValueError("`shard` is for engine=\"local\": Ray shares out the recordings itself")
        if not is_ray and parts["address"] is not None:
            raise ValueError('`address` is for engine="ray"')
        parts["retry_failed"] = bool(parts["retry_failed"])
        return Plan(out=out, **parts)

    @property
    def table_suffix(self) -> str:
        """What names of tables end with."""
        return f"_{self.shard.replace('/', '_of_')}" if self.shard else ""


def is_url(path: str) -> bool:
    """Whether a store is not a folder of this machine."""
    return "://" in path


def is_whole(value: Any, least: int) -> bool:
    """Whether a parameter is a whole number of at least this."""
    return hasattr(value, "__index__") and not isinstance(value, bool) and value.__index__() >= least


def shard(value: Any) -> str | None:
    """``I/N`` for a parameter `shard`."""
    if value is None:
        return None
    parts = value.split("/") if isinstance(value, str) else value
    try:
        index, count = (int(part) for part in parts)
    except (TypeError, ValueError):
        raise ValueError(f"`shard` has to be (I, N) or 'I/N', not {value!r}") from None
    if not 1 <= index <= count:
        raise ValueError(f"`shard` has to be I of N with I from 1 to N, not {value!r}")
    return f"{index}/{count}"
