"""The numbers are the command's, at the precision that it prints."""

import csv

import numpy as np
import pytest

import sinew

# Half of the last digit of the command's tables.
SIX_DECIMALS = 0.5000001e-6
FIVE_DECIMALS = 0.5000001e-5


def rows_of(path):
    """Columns of a table by name; an empty cell and a word are NaN."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([number(row[name]) for row in rows]) for name in rows[0]}


def number(cell):
    try:
        return float(cell)
    except ValueError:
        return np.nan


def same(found, printed, tolerance):
    np.testing.assert_array_equal(np.isnan(found), np.isnan(printed))
    np.testing.assert_allclose(found, printed, rtol=0.0, atol=tolerance)


@pytest.mark.parametrize("online", [False, True])
@pytest.mark.parametrize("sigma_deg", [None, 4.0])
@pytest.mark.parametrize("model", ["walking", "running"])
def test_a_table_is_tracked_as_the_command_does(tmp_path, walk, command, model, sigma_deg, online):
    table, out = tmp_path / "walk.csv", tmp_path / "est.csv"
    walk.save(table)
    options = ["--sigma-deg", sigma_deg] if sigma_deg else []
    options += ["--online"] if online else []
    said = command("track", "cyclic", table, "--model", model, "--out", out, "--report", tmp_path / "run", *options)
    track = sinew.track_cyclic(table, model, sigma_deg=sigma_deg, smooth=not online)
    printed = rows_of(out)
    np.testing.assert_array_equal(track.frame, printed["frame"])
    for index, name in enumerate(sinew.ANGLE_NAMES):
        same(track.angles_rad[:, index], printed[f"{name}_rad"], SIX_DECIMALS)
        same(track.std_rad[:, index], printed[f"{name}_std_rad"], SIX_DECIMALS)
    away = np.abs(track.cycle_position - printed["cycle_position"])
    assert np.minimum(away, 1.0 - away).max() <= SIX_DECIMALS
    same(track.cycles, printed["cycles"], FIVE_DECIMALS)
    np.testing.assert_array_equal(track.outlier, printed["outlier"] == 1.0)
    assert track.summary == said["summary"]
    assert track.symmetries == said["symmetries"]
    assert track.cadence_per_min == said["summary"]["cadence_per_min"]
    assert len(track.doubts) == len(said["doubts"])


@pytest.mark.parametrize("filter", ["paper", "paper-cut", "particle"])
def test_the_papers_filters_are_the_commands(tmp_path, walk, command, filter):
    table, out = tmp_path / "walk.csv", tmp_path / "est.csv"
    walk.save(table)
    options = ["--filter", filter, "--particles", 200, "--seed", 7, "--online", "--report", tmp_path / "run"]
    said = command("track", "cyclic", table, "--model", "walking", "--out", out, *options)
    track = sinew.track_cyclic(table, filter=filter, particles=200, seed=7, smooth=False)
    printed = rows_of(out)
    for index, name in enumerate(sinew.ANGLE_NAMES):
        same(track.angles_rad[:, index], printed[f"{name}_rad"], SIX_DECIMALS)
    assert track.summary == said["summary"]


@pytest.mark.parametrize("mirror", [False, True])
def test_a_model_is_trained_as_the_command_does(tmp_path, walk, command, mirror):
    table, cuts, model, own = (tmp_path / name for name in ("walk.csv", "cuts.csv", "walk.json", "own.json"))
    walk.save(table)
    command("cut", table, "--out", cuts)
    command("train", "cyclic", "--cuts", cuts, "--out", model, *(["--mirror"] if mirror else []))
    of_list = sinew.train_cyclic(cuts, mirror=mirror)
    of_list.save(own)
    assert own.read_bytes() == model.read_bytes()
    # The table has six decimals.
    of_angles = sinew.train_cyclic([walk], mirror=mirror)
    np.testing.assert_allclose(of_angles.mean_cycle_rad, of_list.mean_cycle_rad, atol=2.0e-6)
    assert of_angles.trained_cycles == of_list.trained_cycles


def test_an_array_is_tracked_as_its_table(tmp_path, walk):
    table = tmp_path / "walk.csv"
    walk.save(table)
    of_table = sinew.track_cyclic(table)
    of_angles = sinew.track_cyclic(walk)
    of_array = sinew.track_cyclic(walk.angles_rad, rate_hz=walk.rate_hz)
    np.testing.assert_array_equal(of_angles.angles_rad, of_array.angles_rad)
    # The table has six decimals.
    np.testing.assert_allclose(of_table.angles_rad, of_array.angles_rad, atol=1.0e-4)
    assert of_array.cadence_per_min == pytest.approx(of_table.cadence_per_min, abs=1.0e-3)


def test_keypoints_give_the_commands_angles(tmp_path, command):
    file, table = tmp_path / "keypoints.csv", tmp_path / "walk.csv"
    command("simulate", "keypoints", "--out", file, "--seed", 3, "--missing", 0.05)
    said = command("angles", file, "--out", table)
    found = sinew.angles(file)
    printed = rows_of(table)
    for index, name in enumerate(sinew.ANGLE_NAMES):
        same(found.angles_rad[:, index], printed[f"{name}_rad"], SIX_DECIMALS)
    assert found.rate_hz == said["rate_hz"]
    assert len(found.doubts) == len(said["doubts"])
    # The array has more decimals than the file: a hundredth of a pixel turns a shoulder by this.
    filmed = sinew.simulate_keypoints(seed=3, missing=0.05)
    of_array = sinew.angles(filmed.keypoints, layout=filmed.layout, fps=30.0)
    assert of_array.facing == found.facing
    np.testing.assert_allclose(of_array.angles_rad, found.angles_rad, atol=1.0e-2)
