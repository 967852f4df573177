"""`sinew.track_cyclic`: what it takes, what it returns, what it refuses."""

import pickle
import sys
import threading

import numpy as np
import pytest

import sinew


@pytest.fixture(scope="module")
def track(walk):
    return sinew.track_cyclic(walk)


def test_shapes_and_types(walk, track):
    n = len(walk)
    assert len(track) == n
    for name in ("frame", "time_s", "is_known", "outlier", "misfit", "cycle_position", "cycles"):
        assert getattr(track, name).shape == (n,), name
    assert track.angles_rad.shape == track.std_rad.shape == (n, 13)
    assert track.angles_rad.dtype == np.float64 and track.is_known.dtype == bool
    assert set(track.flexion_deg) == set(sinew.FLEXION_NAMES)
    assert all(values.shape == (n,) for values in track.flexion_deg.values())
    assert track.is_known.all() and np.isfinite(track.angles_rad).all()


def test_the_cadence_is_the_persons(keypoints, track):
    assert track.cadence_per_min == pytest.approx(keypoints.cadence_per_min, rel=0.03)
    assert 0.0 < track.cadence_std_per_min < 5.0
    assert track.doubts == []
    knee = track.flexion_deg["l_knee_flexion"]
    assert 30.0 < knee.max() - knee.min() < 90.0


def test_events_and_strides(track):
    times = [event["time_s"] for event in track.events]
    assert times == sorted(times) and len(times) > 8
    assert {event["event"] for event in track.events} == {"foot_strike", "toe_off"}
    assert {stride["foot"] for stride in track.strides} == {"left", "right"}


@pytest.mark.parametrize(
    "of",
    [
        lambda a: a.astype(np.float64),
        lambda a: a.tolist(),
        lambda a: np.asfortranarray(a),
        lambda a: a[::-1].copy()[::-1],
        lambda a: a[:, ::-1].copy()[:, ::-1],
        lambda a: np.repeat(a, 2, axis=0)[::2],
        lambda a: a.astype(">f8"),
        lambda a: a.astype(object),
        lambda a: np.ma.masked_invalid(a),
    ],
    ids=["same", "list", "fortran", "negative rows", "negative columns", "strided", "big-endian", "objects", "masked"],
)
def test_any_layout_in_memory_gives_the_same(walk, track, of):
    found = sinew.track_cyclic(of(walk.angles_rad), rate_hz=30.0)
    np.testing.assert_array_equal(found.angles_rad, track.angles_rad)


def test_packed_records_and_broadcast_rows(walk, track):
    records = np.zeros(len(walk), dtype=[("flag", "u1"), ("angles", "f8", 13)])
    records["angles"] = walk.angles_rad
    found = sinew.track_cyclic(records["angles"], rate_hz=30.0)
    np.testing.assert_array_equal(found.angles_rad, track.angles_rad)
    row = np.broadcast_to(walk.angles_rad[0], (60, 13))
    assert len(sinew.track_cyclic(row, rate_hz=30.0)) == 60


def test_float32_and_read_only(walk, track):
    angles = walk.angles_rad.astype(np.float32)
    angles.flags.writeable = False
    found = sinew.track_cyclic(angles, rate_hz=30.0)
    np.testing.assert_allclose(found.angles_rad, track.angles_rad, atol=1.0e-4)


def test_none_in_a_list_is_missing(walk):
    rows = walk.angles_rad.tolist()
    rows[3][4] = None
    angles = walk.angles_rad.copy()
    angles[3, 4] = np.nan
    found, wanted = (sinew.track_cyclic(a, rate_hz=30.0) for a in (rows, angles))
    np.testing.assert_array_equal(found.angles_rad, wanted.angles_rad)


def test_times_give_frames_and_rate(walk, track):
    time_s = 5.0 + np.arange(len(walk)) / 30.0
    found = sinew.track_cyclic(walk.angles_rad, time_s=time_s)
    assert found.rate_hz == pytest.approx(30.0)
    np.testing.assert_array_equal(found.time_s, time_s)
    np.testing.assert_allclose(found.angles_rad, track.angles_rad, atol=1.0e-4)
    rounded = np.round(np.arange(3000) / 30.0, 3)
    found = sinew.track_cyclic(np.tile(walk.angles_rad, (17, 1))[:3000], time_s=rounded, smooth=False)
    np.testing.assert_array_equal(found.frame, np.arange(3000))
    some = np.r_[0:50, 55 : len(walk)]
    found = sinew.track_cyclic(walk.angles_rad[some], time_s=time_s[some])
    np.testing.assert_array_equal(found.frame, some)
    assert found.summary["skipped_frames"] == 5


@pytest.mark.parametrize("rate_hz", [None, 30.0])
def test_times_may_have_jitter_and_gaps(walk, rate_hz):
    rows = len(walk)
    for seed in range(20):
        draws = np.random.default_rng(seed)
        jitter_s = draws.normal(0.0, 0.005, rows)
        time_s = np.arange(rows) / 30.0 + jitter_s
        found = sinew.track_cyclic(walk.angles_rad, time_s=time_s, rate_hz=rate_hz, smooth=False)
        np.testing.assert_array_equal(found.frame, np.arange(rows))
        assert found.rate_hz == pytest.approx(30.0, rel=1.0e-3)
        kept = np.flatnonzero(draws.random(rows) < 0.8)
        time_s = np.arange(rows) / 30.0 + 0.5 * jitter_s
        found = sinew.track_cyclic(walk.angles_rad[kept], time_s=time_s[kept], rate_hz=rate_hz, smooth=False)
        np.testing.assert_array_equal(found.frame, kept - kept[0])


def test_times_of_two_decimals_are_even(walk):
    time_s = np.round(np.arange(len(walk)) / 60.0, 2)
    found = sinew.track_cyclic(walk.angles_rad, time_s=time_s, smooth=False)
    np.testing.assert_array_equal(found.frame, np.arange(len(walk)))
    assert found.rate_hz == pytest.approx(60.0, rel=2.0e-3)


@pytest.mark.parametrize("rate_hz", [None, 30.0])
def test_uneven_times_are_refused(walk, rate_hz):
    for seed in range(20):
        time_s = np.cumsum(np.random.default_rng(seed).uniform(0.007, 0.06, len(walk)))
        with pytest.raises(ValueError, match="`time_s` has to be even: .* of a frame|`time_s` says"):
            sinew.track_cyclic(walk.angles_rad, time_s=time_s, rate_hz=rate_hz)


def test_frames_without_a_person_are_not_known(walk):
    angles = walk.angles_rad.copy()
    angles[60:150] = np.nan
    found = sinew.track_cyclic(angles, rate_hz=30.0)
    assert not found.is_known[100] and np.isnan(found.angles_rad[100]).all() and np.isnan(found.cycle_position[100])
    assert found.is_known[20] and not found.outlier[100]


@pytest.mark.parametrize(
    ("angles", "options", "words"),
    [
        (np.zeros((5, 12)), {"rate_hz": 30}, "`angles`.*shape \\(n, 13\\), not \\(5, 12\\)"),
        (np.zeros(13), {"rate_hz": 30}, "`angles`.*shape"),
        (np.zeros((0, 13)), {"rate_hz": 30}, "`angles` need at least one frame"),
        ([], {"rate_hz": 30}, "`angles`.*shape"),
        ([[0.0] * 13, [0.0]], {"rate_hz": 30}, "`angles`"),
        (np.full((5, 13), np.inf), {"rate_hz": 30}, "`angles`.*finite"),
        (np.full((50, 13), np.nan), {"rate_hz": 30}, "no angle in any frame"),
        (np.zeros((5, 13), dtype=complex), {"rate_hz": 30}, "`angles`.*real numbers"),
        (np.full((5, 13), "x"), {"rate_hz": 30}, "`angles`.*real numbers"),
        (None, {"rate_hz": 30}, "`angles`"),
        (np.zeros((5, 13)), {}, "`rate_hz` has to be given"),
        (np.zeros((5, 13)), {"rate_hz": 0}, "`rate_hz`.*greater than zero"),
        (np.zeros((5, 13)), {"rate_hz": "x"}, "`rate_hz`.*number"),
        (np.zeros((5, 13)), {"rate_hz": 0.01}, "rate_hz=0.01"),
        (np.zeros((5, 13)), {"rate_hz": 30, "sigma_deg": -1}, "`sigma_deg`.*greater than zero"),
        (np.zeros((5, 13)), {"rate_hz": 30, "sigma_deg": 1e6}, "`sigma_deg`.*lie from"),
        (np.zeros((5, 13)), {"rate_hz": 30, "model": "wlaking"}, "wlaking.*walking, running, arm-circles"),
        (np.zeros((5, 13)), {"rate_hz": 30, "model": 3}, "`model`"),
        (np.zeros((5, 13)), {"time_s": [0, 1, 2]}, "`time_s`.*shape \\(5,\\)"),
        (np.zeros((3, 13)), {"time_s": [0, 2, 1]}, "`time_s`.*rise"),
        (np.zeros((3, 13)), {"time_s": [0, 33, 67]}, "`time_s` has to be in seconds, .*33 s.* by 1000"),
        (np.zeros((3, 13)), {"time_s": [0, 0.1, np.nan]}, "`time_s`.*finite"),
        (np.zeros((3, 13)), {"time_s": [0, 0.1, 0.2], "rate_hz": 7}, "`time_s` says 10"),
        (np.zeros((5, 13)), {"time_s": [0, 0.1, 0.2, 0.3, 0.37]}, None),
        (np.zeros((1, 13)), {"time_s": [0]}, "`rate_hz`.*single row"),
    ],
)
def test_wrong_values_are_named(angles, options, words):
    if words is None:
        sinew.track_cyclic(angles, **options)
        return
    with pytest.raises(ValueError, match=words):
        sinew.track_cyclic(angles, **options)


def test_files_that_cannot_be_used(tmp_path):
    with pytest.raises(FileNotFoundError, match="missing.csv"):
        sinew.track_cyclic(tmp_path / "missing.csv")
    with pytest.raises(FileNotFoundError, match="missing.json"):
        sinew.track_cyclic(np.zeros((5, 13)), tmp_path / "missing.json", rate_hz=30)
    with pytest.raises(OSError):
        sinew.track_cyclic(tmp_path)
    broken = tmp_path / "broken.csv"
    broken.write_text("frame,x\n0,1\n")
    with pytest.raises(sinew.SinewError, match="broken.csv"):
        sinew.track_cyclic(broken)
    broken.write_text("{}")
    with pytest.raises(sinew.SinewError, match="broken.csv"):
        sinew.Model(broken)
    with pytest.raises(ValueError, match="`time_s` is for arrays"):
        sinew.track_cyclic(broken, time_s=[0])


def test_it_is_pickled_and_shown(track):
    again = pickle.loads(pickle.dumps(track))
    np.testing.assert_array_equal(again.angles_rad, track.angles_rad)
    assert again.summary == track.summary
    assert "a minute" in repr(track)
    html = track._repr_html_()
    assert html.startswith("<table>") and "l knee flexion" in html


def test_a_data_frame(track):
    pandas = pytest.importorskip("pandas")
    frame = track.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "frame"
    np.testing.assert_array_equal(frame["l_knee_rad"], track.angles_rad[:, sinew.ANGLE_NAMES.index("l_knee")])


def test_a_plot(track):
    pytest.importorskip("matplotlib").use("Agg")
    ax = track.plot()
    assert len(ax.get_legend().get_texts()) == 4
    with pytest.raises(ValueError, match="`names`"):
        track.plot(["knee"], ax)


@pytest.mark.parametrize(("module", "call"), [("pandas", "to_pandas"), ("matplotlib", "plot")])
def test_what_is_not_installed_is_named(track, monkeypatch, module, call):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=f"pip install {module}"):
        getattr(track, call)()


def test_threads_give_the_same(walk, track):
    found = [None] * 4

    def run(index):
        found[index] = sinew.track_cyclic(walk)

    threads = [threading.Thread(target=run, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for one in found:
        np.testing.assert_array_equal(one.angles_rad, track.angles_rad)


def test_a_table_of_arrow_has_the_frames_columns(track):
    pyarrow = pytest.importorskip("pyarrow")
    table = track.to_arrow()
    assert isinstance(table, pyarrow.Table)
    assert table.column_names == ["frame", *track.to_pandas().columns]
    np.testing.assert_array_equal(table["l_knee_rad"].to_numpy(), track.to_pandas()["l_knee_rad"])


def test_the_covariance_is_that_of_the_online_tracker(walk):
    track = sinew.track_cyclic(walk, smooth=False, covariance=True)
    assert track.covariance_rad2.shape == (len(walk), 13, 13)
    tracker = sinew.CyclicTracker(rate_hz=walk.rate_hz)
    for row, covariance in zip(walk.angles_rad, track.covariance_rad2):
        tracker.update(row)
        np.testing.assert_array_equal(tracker.covariance_rad2, covariance)
    variance = np.diagonal(track.covariance_rad2, axis1=1, axis2=2)
    np.testing.assert_allclose(np.sqrt(variance[1:]), track.std_rad[1:], rtol=1.0e-6)
    np.testing.assert_array_equal(track.covariance_rad2, np.swapaxes(track.covariance_rad2, 1, 2))
    assert np.linalg.eigvalsh(track.covariance_rad2[1:]).min() > 0.0
    paper = sinew.track_cyclic(walk, filter="paper", smooth=False, covariance=True)
    assert np.linalg.eigvalsh(paper.covariance_rad2).min() > 0.0
    assert sinew.track_cyclic(walk).covariance_rad2 is None


def test_a_recording_that_cannot_have_it_is_refused(walk):
    with pytest.raises(ValueError, match="`covariance`.*smooth=False"):
        sinew.track_cyclic(walk, covariance=True)
    with pytest.raises(ValueError, match="`filter`.*coupled, paper"):
        sinew.track_cyclic(walk, filter="kalman")
    with pytest.raises(ValueError, match="`particles`"):
        sinew.track_cyclic(walk, filter="particle", particles=0)
    with pytest.raises(ValueError, match="`seed`"):
        sinew.track_cyclic(walk, seed=-1)
