"""Many recordings on this machine."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from batch_help import finished, sha256, table, walks

import sinew
from sinew._batch.parts import cut, lost


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    return walks(tmp_path_factory.mktemp("batch") / "in", 4)


def run_sinew(*words, **options):
    return subprocess.run([sys.executable, "-m", "sinew", *map(str, words)], capture_output=True, **options)


def test_the_module_is_the_command(recordings, tmp_path):
    program = os.environ.get("SINEW")
    if not program:
        pytest.skip("SINEW does not name the command `sinew`: nothing to compare with")
    table = recordings / "w01.csv"
    for words in (
        ["--version"],
        ["batch", "--help"],
        ["track", "cyclic", table, "--model", "walking", "--out", "-"],
        ["track", "cyclic", tmp_path / "gone.csv"],
        ["batch", recordings, "--out", tmp_path / "x", "--shard", "3/2", "--json"],
        [],
    ):
        own, other = run_sinew(*words), subprocess.run([program, *map(str, words)], capture_output=True)
        assert (own.returncode, own.stdout, own.stderr) == (other.returncode, other.stdout, other.stderr), words


def catches_sigint(pid):
    """Whether a process has a handler of its own for Ctrl-C."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return bool(int(line.split()[1], 16) >> (signal.SIGINT - 1) & 1)


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="looks at handlers in /proc")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_the_module_as_the_program(number):
    # Waits for a table from standard input, where the program does not handle signals.
    words = [sys.executable, "-m", "sinew", "cut", "-", "--out", os.devnull]
    child = subprocess.Popen(words, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    # Python's handler comes first, and goes before the command begins.
    wait_for(lambda: catches_sigint(child.pid))
    wait_for(lambda: not catches_sigint(child.pid))
    child.send_signal(number)
    _, said = child.communicate(timeout=20)
    assert (child.returncode, b"Traceback" in said) == (-number, False)


def test_a_broken_recording_is_a_row_and_stops_no_other(recordings, tmp_path):
    rows = [{"id": path.stem, "input": path} for path in sorted(recordings.glob("*.csv"))]
    (tmp_path / "broken.csv").write_text("no table\n")
    rows += [
        {"id": "broken", "input": "broken.csv"},
        {"id": "gone", "input": "gone.csv"},
        {"id": "strange", "input": rows[0]["input"], "modle": "walking"},
        {"id": "dance", "input": rows[0]["input"], "kind": "dance"},
        {"id": "twin", "input": rows[0]["input"], "model": None, "sigma_deg": float("nan")},
    ]
    found = sinew.batch(rows, tmp_path / "runs", folder=tmp_path, set={"online": True}, jobs=2)
    assert [row["id"] for row in found.rows] == [row["id"] for row in rows]
    assert (len(found.ok), len(found.failed), len(found.open)) == (5, 4, 0)
    classes = {row["id"]: (row["class"], row["message"]) for row in found.failed}
    assert classes["gone"][0] == "no-input" and "gone.csv" in classes["gone"][1]
    assert classes["broken"][0] == "data" and "broken.csv" in classes["broken"][1]
    assert "no option `modle`; the nearest is `model`" in classes["strange"][1]
    assert "kind `dance` is none of" in classes["dance"][1]
    assert found.rows[-1]["key"] == found.rows[0]["key"]
    on_disk = table(found.status)
    assert {name: row["status"] for name, row in on_disk.items()} == {row["id"]: row["status"] for row in found.rows}
    assert list(table(found.summary)) == [row["id"] for row in found.ok]
    again = sinew.batch(rows, tmp_path / "runs", folder=tmp_path, set={"online": True})
    assert all(row["from_before"] for row in again.ok) and "5 ok, 4 failed" in repr(again)
    with pytest.raises(sinew.SinewError, match="4 of 9 recordings have no result; the first is `broken`"):
        sinew.batch(rows, tmp_path / "runs", folder=tmp_path, set={"online": True}, check=True)


def test_all_forms_of_a_manifest_say_the_same(recordings, tmp_path):
    pandas = pytest.importorskip("pandas")
    pyarrow = pytest.importorskip("pyarrow")
    import pyarrow.parquet

    rows = [{"id": "a", "input": "w01.csv", "sigma-deg": 4}, {"id": "b", "input": "w02.csv", "sigma-deg": None}]
    frame = pandas.DataFrame(rows)
    assert frame["sigma-deg"].dtype == float
    arrow = pyarrow.Table.from_pylist(rows)
    files = [recordings / f"list.{ending}" for ending in ("csv", "jsonl", "parquet")]
    frame.to_csv(files[0], index=False, float_format="%g")
    files[1].write_text("".join(json.dumps(row) + "\n" for row in rows))
    pyarrow.parquet.write_table(arrow, files[2])
    forms = [*files, *((form, recordings) for form in (rows, iter(rows), frame, arrow))]
    try:
        keys = set()
        for form in forms:
            manifest, folder = form if isinstance(form, tuple) else (form, None)
            found = sinew.batch(manifest, tmp_path / "runs", folder=folder)
            keys.add(tuple(row["key"] for row in found.ok))
        assert len(keys) == 1 and len(keys.pop()) == 2
    finally:
        for file in files:
            file.unlink()


def test_tables_come_as_data_frames_and_parquet(recordings, tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    (tmp_path / "broken.csv").write_text("no table\n")
    rows = [{"id": "x", "input": tmp_path / "broken.csv"}, {"id": "1", "input": recordings / "w01.csv"}]
    found = sinew.batch(rows, tmp_path / "runs", parquet=True)
    frame, arrow = found.to_pandas(), found.to_arrow()
    assert list(frame["id"]) == ["x", "1"] and arrow.column("id").to_pylist() == ["x", "1"]
    assert list(frame.columns) == arrow.column_names
    cadence = float(table(found.summary)["1"]["cadence_per_min"])
    assert pandas.isna(frame["cadence_per_min"][0]) and frame["cadence_per_min"][1] == cadence
    assert arrow.column("cadence_per_min").to_pylist() == [None, cadence]
    status = pandas.read_parquet(Path(found.out) / "status.parquet")
    assert list(status.columns) == list(table(found.status)["1"])
    assert len(pandas.read_parquet(Path(found.out) / "summary.parquet")) == 1


def test_parameters_that_are_wrong_are_named(recordings, tmp_path):
    for parameter, options in (
        ("engine", {"engine": "dask"}),
        ("jobs", {"jobs": 0}),
        ("jobs", {"jobs": 2000}),
        ("chunk", {"chunk": 1.5}),
        ("max_retries", {"max_retries": -1}),
        ("shard", {"shard": "3/2"}),
        ("shard", {"shard": (1, 2), "engine": "ray"}),
        ("address", {"address": "auto"}),
        ("set", {"set": ["model=walking"]}),
        ("set", {"set": {"model": ["walking"]}}),
        ("out", {"out": "s3://bucket/runs"}),
        ("manifest", {"manifest": 3}),
        ("manifest", {"manifest": ["w01.csv"]}),
        ("manifest", {"manifest": [{"id": "a", "input": object()}]}),
    ):
        arguments = {"manifest": recordings, "out": tmp_path / "runs"} | options
        with pytest.raises(ValueError, match=f"`{parameter}`"):
            sinew.batch(**arguments)
    with pytest.raises(sinew.SinewError, match="manifest:2: has the id `a` of line 1"):
        sinew.batch([{"id": "a", "input": "x"}, {"id": "a", "input": "y"}], tmp_path / "runs")
    with pytest.raises(sinew.SinewError, match="names no recording"):
        sinew.batch([], tmp_path / "runs")
    with pytest.raises(FileNotFoundError, match="gone.csv"):
        sinew.batch(tmp_path / "gone.csv", tmp_path / "runs")
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="cannot be made .*; choose another `out`"):
        sinew.batch(recordings, tmp_path / "file" / "runs")
    assert not (tmp_path / "runs").exists()


def test_shards_have_their_own_tables(recordings, tmp_path):
    for shard in ((1, 2), "2/2"):
        part = sinew.batch(recordings, tmp_path / "runs", shard=shard)
        assert len(part) == 2 and Path(part.status).name.endswith("_of_2.csv")
    whole = sinew.batch(recordings, tmp_path / "runs")
    assert all(row["from_before"] for row in whole.rows)


def driver(tmp_path, recordings):
    script = "import sinew, sys; sinew.batch(sys.argv[1], sys.argv[2], jobs=1)"
    return subprocess.Popen([sys.executable, "-c", script, recordings, tmp_path], stderr=subprocess.PIPE)


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_an_ended_call_goes_on_and_leaves_no_process(tmp_path, number):
    recordings = walks(tmp_path / "in", 24, cycles=12)
    out = tmp_path / "runs"
    child = driver(out, recordings)
    wait_for(lambda: len(finished(out)) >= 3)
    child.send_signal(number)
    _, said = child.communicate(timeout=30)
    assert b"KeyboardInterrupt" in said if number == signal.SIGINT else child.returncode == -number
    # The command ends by itself after a killed Python; its lock goes with it.
    wait_for(lambda: not list(out.glob(".sinew-lock*")))
    before = finished(out)
    if number == signal.SIGINT and len(before) < 24:
        assert sum(row["status"] == "open" for row in table(out / "status.csv").values()) == 24 - len(before)
    found = sinew.batch(recordings, out)
    assert sum(row["from_before"] for row in found.ok) == len(before) and len(found.ok) == 24
    assert before.items() <= finished(out).items()
    sinew.batch(recordings, tmp_path / "whole")
    assert sha256(out) == sha256(tmp_path / "whole")


def wait_for(condition, seconds=60.0):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until, "it took too long"
        time.sleep(0.005)


def test_progress_goes_to_standard_error(recordings, tmp_path, capfd):
    sinew.batch(recordings, tmp_path / "runs", progress=True)
    printed = capfd.readouterr()
    assert "4 of 4, 0 s left" in printed.err and printed.out == ""
    sinew.batch(recordings, tmp_path / "runs")
    assert capfd.readouterr().err == ""


def test_a_sweep_has_a_row_for_each_combination(recordings, tmp_path, capfd):
    inputs = [recordings / "w01.csv", recordings / "w02.csv"]
    over = {"sigma_deg": range(3, 6), "online": [True, False]}
    swept = sinew.sweep(inputs, over, tmp_path / "runs", set={"model": "walking"})
    rows = table(swept.table)
    assert len(rows) == len(swept.ok) == 12 and len({row["key"] for row in swept.rows}) == 12
    row = rows["w02.sigma_deg=4.online=False"]
    assert (row["input"], row["sigma_deg"], row["online"], row["status"]) == (str(inputs[1]), "4", "false", "ok")
    assert row["cadence_per_min"] == table(swept.summary)["w02.sigma_deg=4.online=False"]["cadence_per_min"]
    pandas = pytest.importorskip("pandas")
    frame = swept.to_pandas()
    assert list(frame.columns[:4]) == ["id", "input", "sigma_deg", "online"]
    assert isinstance(frame, pandas.DataFrame) and frame["cadence_per_min"].notna().all()
    page = tmp_path / "sweep.html"
    assert sinew._sinew.run_command(["sinew", "report", swept.out, "--out", str(page)]) == 0
    assert "sweep.csv" in page.read_text()
    for wrong in ({}, {"seed": 3}, {"seed": []}, {"id": [1]}, [("seed", [1])]):
        with pytest.raises(ValueError, match="`over`"):
            sinew.sweep(inputs, wrong, tmp_path / "other")
    with pytest.raises(ValueError, match="`inputs`, row 1"):
        sinew.sweep([3], {"seed": [1]}, tmp_path / "other")


def test_recordings_are_cut_so_that_workers_end_together():
    kinds = [None] * 500 + ["arm", "body"]
    parts = cut(kinds, 100, 2)
    assert parts[:2] == [[500], [501]] and sorted(sum(parts, [])) == list(range(502))
    assert {len(part) for part in parts[2:-1]} == {63}
    assert max(map(len, cut([None] * 10**5, 100, 2))) == 100
    assert [len(part) for part in cut([None] * 3, 100, 2)] == [1, 1, 1]


def test_a_recording_whose_workers_died_is_a_row(tmp_path):
    whole = sinew._sinew.WholeBatch(str(tmp_path), ["a", "b"])
    whole.add([1], lost("b", "WorkerCrashedError", 4))
    with pytest.raises(ValueError):
        whole.add([0], "no line")
    with pytest.raises(BlockingIOError, match="another|in use|process"):
        sinew._sinew.WholeBatch(str(tmp_path), ["a"])
    whole.end(True)
    whole.close()
    rows = table(tmp_path / "status.csv")
    assert (rows["a"]["status"], rows["b"]["status"], rows["b"]["class"]) == ("open", "error", "try-again")
