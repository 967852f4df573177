"""A batch on a Ray cluster: rows go to tasks, rows of the tables come back, results are files."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import tempfile
from collections import deque
from collections.abc import Iterator
from typing import Any

from .. import _sinew
from .parts import Where, cut, lost, work
from .plan import Plan, is_url
from .progress import Progress
from .remote import Remote
from .result import Row, row_of

# Tasks that are handed to Ray at once, for each processor.
AHEAD = 4
# How long an address may take to answer.
PATIENCE_S = 5.0
# Bytes of memory for what tasks return; Ray's least. A row takes two kilobytes.
STORE_BYTES = 80 << 20


def run(plan: Plan, progress: Progress) -> list[Row]:
    """Rows of the status table."""
    ray = _ray()
    manifest = plan.manifest
    rows = _sinew.batch_rows(manifest.path or "", manifest.text, manifest.folder, plan.set)
    remote = Remote(plan.out) if is_url(plan.out) else None
    folder = os.path.dirname(manifest.path or "") if manifest.folder is None else manifest.folder
    with contextlib.ExitStack() as stack:
        out = plan.out
        if remote is not None:
            out = stack.enter_context(tempfile.TemporaryDirectory(prefix="sinew-"))
            # A store that cannot be written is an error of now, not of the first task.
            remote.put("status.csv", b"")
        whole = _sinew.WholeBatch(out, [identity for identity, _, _ in rows])
        stack.callback(whole.close)
        where = Where((folder, os.getcwd()), out, plan.out if remote else None, plan.retry_failed)
        driver = _Driver(ray, plan, rows, where, whole, progress)
        with _cluster(ray, plan) as workers:
            is_done = False
            try:
                driver.run(workers)
                is_done = True
            finally:
                progress.end()
                whole.end(is_done)
                if remote is not None:
                    _bring_tables(remote, out)
    return driver.rows


def _bring_tables(remote: Remote, out: str) -> None:
    for name in ("summary.csv", "status.csv"):
        with open(os.path.join(out, name), "rb") as table:
            remote.put(name, table.read())


class _Driver:
    """Hands out tasks and takes their rows."""

    def __init__(
        self,
        ray: Any,
        plan: Plan,
        recordings: list[tuple[str, str | None, str]],
        where: Where,
        whole: _sinew.WholeBatch,
        progress: Progress,
    ) -> None:
        self._ray, self._plan, self._recordings = ray, plan, recordings
        self._where, self._whole, self._progress = where, whole, progress
        self._found: dict[int, Row] = {}
        self._pending: dict[Any, list[int]] = {}
        self._waiting: deque[list[int]] = deque()

    def run(self, workers: int) -> None:
        """Work on all recordings, with so many tasks at once.

        After Ctrl-C no task is cancelled: Ray 2.60 aborts the whole process if a task ends while it is
        (`Tried to complete task that was not pending`, 2 of 25 times). A cluster that ends with the batch takes
        its tasks along.
        """
        kinds = [kind for _, kind, _ in self._recordings]
        self._waiting.extend(cut(kinds, self._plan.chunk, workers))
        again = self._plan.max_retries
        task = self._ray.remote(num_cpus=1, max_retries=again, retry_exceptions=[OSError])(work)
        where = self._ray.put(self._where)
        while self._waiting or self._pending:
            while self._waiting and len(self._pending) < AHEAD * workers:
                part = self._waiting.popleft()
                self._pending[task.remote([self._recordings[row][2] for row in part], where)] = part
            ended, _ = self._ray.wait(list(self._pending), num_returns=1)
            for reference in ended:
                self._take(reference, self._pending.pop(reference))
            self._progress.show(len(self._found), len(self._recordings))

    def _take(self, reference: Any, part: list[int]) -> None:
        errors = self._ray.exceptions
        try:
            lines = self._ray.get(reference)
        except errors.RayTaskError as error:
            raise (error.cause if isinstance(error.cause, Exception) else error) from None
        except (errors.WorkerCrashedError, errors.OutOfMemoryError, errors.NodeDiedError) as error:
            if len(part) > 1:
                # One recording may be to blame: each gets a task of its own.
                self._waiting.extend([row] for row in part)
                return
            reason = type(error).__name__
            lines = lost(self._recordings[part[0]][0], reason, 1 + self._plan.max_retries)
        self._whole.add(part, lines)
        self._found.update(zip(part, map(row_of, lines.splitlines())))

    @property
    def rows(self) -> list[Row]:
        """Rows in the order of the manifest."""
        return [self._found[row] for row in range(len(self._recordings))]


def _ray() -> Any:
    try:
        import ray
    except ImportError as error:
        raise ImportError("`engine=\"ray\"` needs Ray: pip install 'sinew[ray]'") from error
    return ray


@contextlib.contextmanager
def _cluster(ray: Any, plan: Plan) -> Iterator[int]:
    """Joins a cluster, or starts one that ends with the batch; how many tasks it does at once."""
    is_own = not ray.is_initialized()
    if is_own:
        address = plan.address or os.environ.get("RAY_ADDRESS") or "local"
        _check(address)
        options: dict[str, Any] = {"logging_level": logging.ERROR, "log_to_driver": False}
        if address == "local":
            os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
            options |= {"num_cpus": plan.jobs, "include_dashboard": False, "object_store_memory": STORE_BYTES}
        try:
            ray.init(address=address, **options)
        except ConnectionError as error:
            raise _no_cluster(address, error) from None
    try:
        processors = max(1, int(ray.cluster_resources().get("CPU", 1)))
        yield min(processors, plan.jobs or processors)
    finally:
        if is_own:
            ray.shutdown()


def _check(address: str) -> None:
    """Ray itself waits a minute for an address where nothing is."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if not host or not port.isdigit():
        return
    try:
        socket.create_connection((host.strip("[]"), int(port)), PATIENCE_S).close()
    except OSError as error:
        raise _no_cluster(address, error) from None


def _no_cluster(address: str, error: Exception) -> ConnectionError:
    return ConnectionError(
        f"`address`: no Ray cluster answers at {address} ({error}); "
        "start one with `ray start --head`, or leave `address` out for one on this machine"
    )
