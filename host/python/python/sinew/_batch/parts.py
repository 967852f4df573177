"""How a batch is cut into tasks, and what a task does."""

from __future__ import annotations

import json
import os
import tempfile
import uuid
from dataclasses import dataclass

from .. import _sinew
from .remote import Remote

# Kinds whose recordings take minutes: each is a task of its own.
LONG = ("arm", "body")
# Tasks for each processor, so that all of them end at nearly the same time.
PARTS_PER_WORKER = 4


@dataclass(frozen=True)
class Where:
    """What all tasks of a batch share."""

    folders: tuple[str, str]
    """Where files lie that options name."""
    out: str
    url: str | None
    """The store, where results are not kept in the folder `out`."""
    retry_failed: bool


def cut(kinds: list[str | None], chunk: int, workers: int) -> list[list[int]]:
    """Numbers of the recordings of each task; the long ones come first."""
    alone = [[row] for row, kind in enumerate(kinds) if kind in LONG]
    others = [row for row, kind in enumerate(kinds) if kind not in LONG]
    size = max(1, min(chunk, -(-len(others) // (PARTS_PER_WORKER * workers))))
    return alone + [others[start : start + size] for start in range(0, len(others), size)]


def work(rows: list[str], where: Where) -> str:
    """Track recordings, and return a line of JSON for each."""
    # As many threads as the task has processors. The library reads it when it first needs them.
    os.environ.setdefault("RAYON_NUM_THREADS", "1")
    if where.url is None:
        return _work_in(rows, where, where.out)
    remote = Remote(where.url)
    return "".join(_work_beside(row, where, remote) for row in rows)


def _work_in(rows: list[str], where: Where, out: str) -> str:
    return _part(rows, where, out).work()


def _part(rows: list[str], where: Where, out: str) -> _sinew.BatchPart:
    name = uuid.uuid4().hex
    return _sinew.BatchPart("\n".join(rows), where.folders, out, name, where.retry_failed)


def _work_beside(row: str, where: Where, remote: Remote) -> str:
    """Track a recording in a folder of this machine, unless the store has it, and bring it there."""
    with tempfile.TemporaryDirectory(prefix="sinew-") as out:
        for key in _part([row], where, out).keys():
            if key is not None:
                _bring(remote, out, (f"results/{key}/job.json", f"errors/{key}.json"))
        line = _work_in([row], where, out)
        found = json.loads(line)
        key, ended = found["key"], found["ended"]
        if key and ended and not ended["from_before"]:
            if ended["failure"] is None:
                remote.put_result(os.path.join(out, "results", key), f"results/{key}")
                remote.forget(f"errors/{key}.json")
            else:
                with open(os.path.join(out, "errors", f"{key}.json"), "rb") as content:
                    remote.put(f"errors/{key}.json", content.read())
    return line


def _bring(remote: Remote, out: str, names: tuple[str, ...]) -> None:
    for name in names:
        content = remote.get(name)
        if content is not None:
            path = os.path.join(out, *name.split("/"))
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as file:
                file.write(content)


def lost(identity: str, reason: str, attempts: int) -> str:
    """The line of a recording whose workers died."""
    message = f"the process that worked on it ended each time ({reason}); call it again to try it anew"
    ended = {
        "seconds": 0.0,
        "attempts": attempts,
        "failure": {"class": "try-again", "message": message},
        "from_before": False,
        "numbers": [],
    }
    return json.dumps({"id": identity, "key": "", "ended": ended}) + "\n"
