"""Many recordings on a Ray cluster: the bytes of a local batch, whatever is killed in between."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from batch_help import finished, needs, sha256, table, walks

needs("ray")
needs("pyarrow")

import ray  # noqa: E402

import sinew  # noqa: E402
from sinew._batch.parts import cut  # noqa: E402

RECORDINGS = 48
SHORT = "SINEW_SHORT_TESTS" in os.environ
"""Whether CI runs its short form."""


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """Walks of 850 frames or so, and a table that is broken."""
    folder = walks(tmp_path_factory.mktemp("ray") / "in", RECORDINGS, cycles=12)
    (folder / "broken.csv").write_text("no table\n")
    return folder


@pytest.fixture(scope="module")
def local(recordings):
    """The SHA-256 of the same on this machine."""
    out = recordings.parent / "local"
    found = sinew.batch(recordings, out)
    assert (len(found.ok), len(found.failed)) == (RECORDINGS, 1)
    return sha256(out)


@pytest.fixture
def cluster():
    """Two workers that stay from call to call of a test."""
    ray.init(address="local", num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield
    ray.shutdown()


def test_ray_makes_the_bytes_of_a_local_batch(recordings, local, tmp_path, cluster, capfd):
    out = tmp_path / "runs"
    found = sinew.batch(recordings, out, engine="ray", progress=True)
    assert (len(found.ok), len(found.failed), len(found.open)) == (RECORDINGS, 1, 0)
    assert sha256(out) == local
    assert f"{RECORDINGS + 1} of {RECORDINGS + 1}" in capfd.readouterr().err
    assert not (out / "unfinished").exists()
    again = sinew.batch(recordings, out, engine="ray", chunk=5)
    assert all(row["from_before"] for row in again.rows)

    # A store with a URL: what is there is not done again, and the bytes are the same.
    url = (tmp_path / "store").as_uri()
    rows = sorted(recordings.glob("*.csv"))
    sinew.batch([{"id": path.stem, "input": path} for path in rows[:5]], url, engine="ray")
    kept = finished(tmp_path / "store")
    assert len(kept) == 4, "the first row is the broken table"
    stored = sinew.batch(recordings, url, engine="ray", parquet=True)
    assert sum(row["from_before"] for row in stored.ok) == 4 and kept.items() <= finished(tmp_path / "store").items()
    assert sha256(tmp_path / "store") == local
    assert (tmp_path / "store" / "status.parquet").stat().st_size > 0
    assert stored.summary == f"{url}/summary.csv" and len(stored.to_arrow()) == RECORDINGS + 1

    # Rows with errors of their own, and options that name a file of the folder that one is in.
    rows = [
        {"id": "a", "input": recordings / "w01.csv", "modle": "x"},
        {"id": "b", "input": "gone.csv"},
        {"id": "c", "input": recordings / "w02.csv"},
    ]
    outs = [tmp_path / "rows_ray", tmp_path / "rows_local"]
    for engine, rows_out in zip(("ray", "local"), outs):
        found = sinew.batch(rows, rows_out, engine=engine, folder=tmp_path, set={"sigma_deg": 4})
        assert [row["status"] for row in found.rows] == ["error", "error", "ok"]
    assert sha256(outs[0]) == sha256(outs[1])
    swept = sinew.sweep(recordings / "w03.csv", {"sigma_deg": [3, 5]}, tmp_path / "sweep", engine="ray")
    assert len(table(swept.table)) == 2


def test_what_is_wrong_is_said_before_anything_is_done(recordings, tmp_path):
    with pytest.raises(sinew.SinewError, match="manifest:2: has the id `a` of line 1"):
        sinew.batch([{"id": "a", "input": "x"}, {"id": "a", "input": "y"}], tmp_path / "runs", engine="ray")
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="choose another `out`"):
        sinew.batch(recordings, tmp_path / "file" / "runs", engine="ray")
    with pytest.raises(ValueError, match="`out`: nowhere://x"):
        sinew.batch(recordings, "nowhere://x", engine="ray")
    for address in ("127.0.0.1:1", "ray://127.0.0.1:1"):
        begun = time.monotonic()
        with pytest.raises(ConnectionError, match=f"`address`: no Ray cluster answers at {address}"):
            sinew.batch(recordings, tmp_path / "runs", engine="ray", address=address)
        assert time.monotonic() - begun < 10.0
    assert not ray.is_initialized()


DRIVER = """
import json, sys
import sinew
found = sinew.batch(sys.argv[1], sys.argv[2], engine="ray", jobs=2, chunk=10)
print(json.dumps(found.rows))
"""


def driver(recordings, out):
    words = [sys.executable, "-c", DRIVER, recordings, out]
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)


def descendants(pid):
    """Processes below one, with what they call themselves."""
    parents, names = {}, {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            stat = (folder / "stat").read_text()
            names[int(folder.name)] = (folder / "cmdline").read_bytes().split(b"\0")[0].decode()
        except OSError:
            continue
        parents[int(folder.name)] = int(stat.rpartition(")")[2].split()[1])
    below = {pid}
    while True:
        more = {child for child, parent in parents.items() if parent in below} - below
        if not more:
            return {child: names.get(child, "") for child in below - {pid}}
        below |= more


def working(child):
    """Processes of a driver that are at a task."""
    return [pid for pid, name in descendants(child.pid).items() if name.startswith("ray::work")]


def is_alive(pid):
    """Whether a process runs; one that has ended may still have an entry."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_for(condition, seconds=120.0):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "it took too long"
        time.sleep(0.005)


linux = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="finds workers in /proc")


@linux
def test_a_killed_worker_loses_nothing(recordings, local, tmp_path):
    out = tmp_path / "runs"
    child = driver(recordings, out)
    wait_for(lambda: len(finished(out)) >= 4)
    os.kill(working(child)[0], signal.SIGKILL)
    before = finished(out)
    printed, said = child.communicate(timeout=180)
    assert child.returncode == 0, said.decode()
    # Ray says on standard output that a worker died.
    rows = json.loads(printed.splitlines()[-1])
    assert len(rows) == RECORDINGS + 1 and sha256(out) == local
    # The part of the killed worker was done again, but for what it had finished.
    assert before.items() <= finished(out).items()
    parts = [part for part in cut([None] * len(rows), 10, 2) if any(rows[row]["from_before"] for row in part)]
    assert len(parts) >= 1, "the killed worker had finished recordings"
    for part in parts:
        assert all(rows[row]["from_before"] for row in part if rows[row]["key"] in before)
    assert not (out / "unfinished").exists()


@linux
@pytest.mark.parametrize("number", [signal.SIGKILL] if SHORT else [signal.SIGKILL, signal.SIGINT])
def test_an_ended_driver_goes_on(recordings, local, tmp_path, number):
    out = tmp_path / "runs"
    child = driver(recordings, out)
    wait_for(lambda: len(finished(out)) >= 6)
    workers = working(child)
    os.kill(child.pid, number)
    _, said = child.communicate(timeout=60)
    if number == signal.SIGINT:
        assert b"KeyboardInterrupt" in said and (out / "status.csv").exists()
    # Tasks end with their driver.
    wait_for(lambda: not any(map(is_alive, workers)), seconds=30.0)
    before = finished(out)
    assert 6 <= len(before) < RECORDINGS, "it was ended in mid-run"
    found = sinew.batch(recordings, out, engine="ray", jobs=2)
    assert {row["key"] for row in found.ok if row["from_before"]} == set(before)
    assert before.items() <= finished(out).items()
    assert len(found.ok) == RECORDINGS and sha256(out) == local
