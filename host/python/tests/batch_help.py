"""What tests of batches share."""

import csv
import hashlib
import importlib.util
import os
from pathlib import Path

import pytest

from sinew import _sinew


def needs(package):
    """Skip what needs a package that is not there; with CI=true that is a failure."""
    if importlib.util.find_spec(package) is None:
        if os.environ.get("CI") == "true":
            pytest.fail(f"{package} is not installed, and CI=true", pytrace=False)
        pytest.skip(f"left out: {package} is not installed", allow_module_level=True)


def walks(folder, count, cycles=4):
    """Angle tables of different people, w01.csv and so on."""
    folder.mkdir()
    for seed in range(1, count + 1):
        table = folder / f"w{seed:02}.csv"
        words = ["simulate", "cyclic", "--model", "walking", "--cycles", str(cycles), "--seed", str(seed)]
        assert _sinew.run_command(["sinew", *words, "--out", str(table), "--quiet"]) == 0
    return folder


def table(path):
    """Rows of a CSV file by their id."""
    with open(path, newline="", encoding="utf-8") as file:
        return {row["id"]: row for row in csv.DictReader(file)}


def sha256(out):
    """Of all results and both tables, but for times."""
    digest = hashlib.sha256()
    results = Path(out) / "results"
    for file in sorted(path for path in results.rglob("*") if path.is_file() and path.name != "job.json"):
        digest.update(f"{file.relative_to(results)}\0".encode() + file.read_bytes())
    digest.update((Path(out) / "summary.csv").read_bytes())
    for row in table(Path(out) / "status.csv").values():
        digest.update("\0".join(row[name] for name in ("id", "key", "status", "class", "message")).encode())
    return digest.hexdigest()


def finished(out):
    """Records of the results so far by their keys."""
    return {path.parent.name: path.read_bytes() for path in (Path(out) / "results").glob("*/job.json")}
