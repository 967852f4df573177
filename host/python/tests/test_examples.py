"""The examples of docs/batch.md as a user runs them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from batch_help import needs, table, walks

import sinew

EXAMPLES = Path(__file__).parent.parent / "examples"
# The command of this package, and that of Snakemake.
ENVIRONMENT = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    folder = walks(tmp_path_factory.mktemp("examples") / "in", 5)
    (folder / "broken.csv").write_text("no table\n")
    rows = "".join(f"{path.stem},in/{path.name}\n" for path in sorted(folder.glob("*.csv")))
    (folder.parent / "list.csv").write_text("id,input\n" + rows)
    sinew._sinew.run_command(["sinew", "batch", str(folder.parent / "list.csv"), "--out", str(folder.parent / "whole")])
    return folder.parent


def assert_same(out, other):
    """Same results; a message has the path as it was given."""
    status = [{name: row["status"] for name, row in table(one / "status.csv").items()} for one in (out, other)]
    assert status[0] == status[1]
    assert (out / "summary.csv").read_bytes() == (other / "summary.csv").read_bytes()


def test_snakemake_works_on_shards(recordings):
    needs("snakemake")
    words = ["--cores", "2", "--config", "list=list.csv", "out=snake", "shards=3"]
    command = [sys.executable, "-m", "snakemake", "-s", EXAMPLES / "Snakefile", *words]
    for _ in range(2):
        done = subprocess.run(command, cwd=recordings, env=ENVIRONMENT, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert "Nothing to be done" in done.stdout + done.stderr
    assert len(list((recordings / "snake").glob("status_*_of_3.csv"))) == 3
    assert_same(recordings / "snake", recordings / "whole")


@pytest.mark.skipif(os.name == "nt", reason="a script for bash")
def test_slurm_works_on_shards(recordings, tmp_path):
    srun = tmp_path / "srun"
    srun.write_text('#!/bin/sh\nexec "$@"\n')
    srun.chmod(0o755)
    environment = ENVIRONMENT | {"PATH": f"{tmp_path}{os.pathsep}{ENVIRONMENT['PATH']}"}
    for shard in (1, 2):
        slurm = {"SLURM_ARRAY_TASK_ID": str(shard), "SLURM_ARRAY_TASK_COUNT": "2", "SLURM_CPUS_PER_TASK": "2"}
        words = [EXAMPLES / "slurm.sh", "list.csv", "slurm"]
        done = subprocess.run(words, cwd=recordings, env=environment | slurm, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert "3 of 3, 0 s left" in done.stderr
    found = sinew.batch(recordings / "list.csv", recordings / "slurm")
    assert sum(row["from_before"] for row in found.ok) == 5
    assert_same(recordings / "slurm", recordings / "whole")
