"""`sinew.CyclicTracker`."""

import pickle

import numpy as np
import pytest

import sinew


def test_answers_are_those_of_an_online_track(walk):
    track = sinew.track_cyclic(walk.angles_rad, rate_hz=30.0, smooth=False)
    tracker = sinew.CyclicTracker("walking", rate_hz=30.0)
    for index, row in enumerate(walk.angles_rad):
        if index % 25 == 10:
            tracker = pickle.loads(pickle.dumps(tracker))
        estimate = tracker.update(row)
        np.testing.assert_array_equal(estimate.angles_rad, track.angles_rad[index])
        np.testing.assert_array_equal(estimate.std_rad, track.std_rad[index])
        assert (estimate.frame, estimate.cycles) == (index, track.cycles[index])
        assert estimate.cycle_position == track.cycle_position[index]
    assert estimate.cadence_per_min == pytest.approx(track.summary["last_cadence_per_min"])
    assert estimate.cadence_std_per_min == pytest.approx(track.summary["last_cadence_std_per_min"])


def test_left_out_frames_count(walk):
    some = np.r_[0:50, 55:100]
    time_s = np.arange(len(walk)) / 30.0
    track = sinew.track_cyclic(walk.angles_rad[some], time_s=time_s[some], rate_hz=30.0, smooth=False)
    tracker = sinew.CyclicTracker(sinew.Model("walking"), rate_hz=30)
    for frame in some:
        estimate = tracker.update(list(walk.angles_rad[frame]), dt_frames=6 if frame == 55 else 1)
    assert tracker.frame == estimate.frame == 99
    np.testing.assert_array_equal(estimate.angles_rad, track.angles_rad[-1])


def test_nothing_is_known_before_the_first_angle(walk):
    tracker = sinew.CyclicTracker(rate_hz=30.0)
    assert tracker.frame is None
    assert tracker.update(np.full(13, np.nan)) is None
    tracker = pickle.loads(pickle.dumps(tracker))
    assert tracker.frame == 0
    assert tracker.update(walk.angles_rad[0].astype(np.float32)).frame == 1
    assert np.isfinite(tracker.update(np.full(13, np.nan)).angles_rad).all()


@pytest.mark.parametrize(
    ("z", "dt_frames", "words"),
    [
        (np.zeros(12), 1, "`z`.*shape"),
        (np.zeros((1, 13)), 1, "`z`.*shape"),
        (np.full(13, np.inf), 1, "`z`.*finite"),
        (np.full(13, 1.0e300), 1, "`z`.*finite"),
        (["x"] * 13, 1, "`z`"),
        (np.zeros(13), 0, "`dt_frames`"),
        (np.zeros(13), 0.5, "`dt_frames`"),
        (np.zeros(13), -3, "`dt_frames`"),
    ],
)
def test_wrong_rows_are_named(z, dt_frames, words):
    tracker = sinew.CyclicTracker(rate_hz=30.0)
    with pytest.raises(ValueError, match=words):
        tracker.update(z, dt_frames)
    assert tracker.frame is None


def test_wrong_options_are_named():
    with pytest.raises(ValueError, match="`rate_hz`"):
        sinew.CyclicTracker(rate_hz=0.0)
    with pytest.raises(ValueError, match="rate_hz=0.01"):
        sinew.CyclicTracker(rate_hz=0.01)
    with pytest.raises(ValueError, match="`sigma_deg`"):
        sinew.CyclicTracker(rate_hz=30.0, sigma_deg=1.0e9)
    with pytest.raises(sinew.SinewError, match="wlaking"):
        sinew.CyclicTracker("wlaking", rate_hz=30.0)
