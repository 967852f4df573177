"""A batch in one process of the command, beside this one: a fault of native code ends that alone."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from typing import Any

from .. import _sinew
from .plan import Plan
from .progress import Progress
from .result import row_of


def run(plan: Plan, progress: Progress) -> list[dict[str, Any]]:
    """Rows of the status table."""
    with tempfile.TemporaryDirectory(prefix="sinew-") as scratch:
        rows = os.path.join(scratch, "rows.jsonl")
        ended, error = _command(plan, rows, progress)
        if os.path.exists(rows):
            with open(rows, encoding="utf-8") as lines:
                return [row_of(line) for line in lines]
    if error is not None:
        _sinew.raise_error(error["kind"], error["message"])
    by = f"signal {-ended}" if ended < 0 else f"status {ended}"
    raise RuntimeError(f"the process of the batch ended with {by}; what it finished is kept: call it again")


def _words(plan: Plan, rows: str) -> list[str]:
    words = [sys.executable, "-m", "sinew", "batch", plan.manifest.path or "-", "--out", plan.out]
    for name, value in (("folder", plan.manifest.folder), ("jobs", plan.jobs), ("shard", plan.shard)):
        words += [] if value is None else [f"--{name}={value}"]
    words += [f"--set={name}={value}" for name, value in plan.set]
    words += ["--retry-failed"] if plan.retry_failed else []
    return [*words, f"--rows={rows}", "--progress", "--json"]


def _command(plan: Plan, rows: str, progress: Progress) -> tuple[int, dict[str, Any] | None]:
    """Exit status of the command, and its error."""
    # Found where this package was, also where no environment variable says so.
    package = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    path = os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")]))
    child = subprocess.Popen(
        _words(plan, rows),
        stdin=subprocess.DEVNULL if plan.manifest.text is None else subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        errors="replace",
        env=os.environ | {"PYTHONPATH": path},
    )
    error: dict[str, Any] | None = None
    try:
        if child.stdin is not None:
            _write(child.stdin, plan.manifest.text or "")
        for line in child.stderr or ():
            error = _take(line, progress) or error
    except BaseException:
        # Ctrl-C in a notebook reaches this process alone.
        child.send_signal(signal.SIGINT if os.name != "nt" else signal.SIGTERM)
        child.communicate()
        raise
    finally:
        progress.end()
    return child.wait(), error


def _write(pipe: Any, text: str) -> None:
    try:
        with pipe:
            pipe.write(text)
    except BrokenPipeError:
        # The command has ended, and says why.
        pass


def _take(line: str, progress: Progress) -> dict[str, Any] | None:
    """Shows progress, passes on what is neither that nor an error, and returns an error."""
    try:
        said = json.loads(line)
    except ValueError:
        said = None
    if isinstance(said, dict) and "progress" in said:
        progress.show(**said["progress"])
        return None
    if isinstance(said, dict) and "error" in said:
        found: dict[str, Any] = said["error"]
        return found
    sys.stderr.write(line)
    return None
