"""`sinew.train_cyclic`, and models that it makes."""

import pickle

import numpy as np
import pytest

import sinew


@pytest.fixture(scope="module")
def walks():
    """Two people, ten seconds each."""
    filmed = [sinew.simulate_keypoints(seconds=10.0, seed=seed) for seed in (1, 2)]
    return [sinew.angles(one.keypoints, layout=one.layout, fps=one.rate_hz) for one in filmed]


def test_cycles_are_found_or_given(walks):
    found = sinew.train_cyclic(walks)
    assert found.trained_cycles > 10
    assert found.mean_cycle_rad.shape == (100, 13)
    given = sinew.train_cyclic(walks, cycles=[[(10, 45), (45, 80)], [(20, 55)]], people=["anna", "bert"], length=50)
    assert given.trained_cycles == 3
    assert given.mean_cycle_rad.shape == (50, 13)
    of_arrays = sinew.train_cyclic([walk.angles_rad for walk in walks], rate_hz=30.0)
    np.testing.assert_array_equal(of_arrays.mean_cycle_rad, found.mean_cycle_rad)


def test_a_trained_model_tracks_and_is_pickled(walks):
    model = sinew.train_cyclic(walks, mirror=True)
    track = sinew.track_cyclic(walks[0], model)
    assert track.cadence_per_min == pytest.approx(sinew.track_cyclic(walks[0]).cadence_per_min, rel=0.02)
    again = sinew.track_cyclic(walks[0], pickle.loads(pickle.dumps(model)))
    np.testing.assert_array_equal(track.angles_rad, again.angles_rad)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"cycles": [[(0, 30)]]}, ValueError, "`cycles`.*2 entries"),
        ({"people": ["a"]}, ValueError, "`people`.*2 entries"),
        ({"cycles": [[(30, 0)], [(0, 30)]]}, sinew.SinewError, "recordings:1.*end 0"),
        ({"cycles": [[(0, 9999)], [(0, 30)]]}, sinew.SinewError, r"recordings\[0\].*outside"),
        ({"cycles": [[], []]}, sinew.SinewError, "no cycle"),
        ({"cycles": [[(0, 30)], []]}, sinew.SinewError, "one training cycle only"),
        ({"cycles": [[(0.5, 30)], [(0, 30)]]}, ValueError, "`cycles`.*whole"),
        ({"length": 5}, ValueError, "`length`"),
        ({"length": 5000}, ValueError, "`length`"),
        ({"rate_hz": -1.0}, ValueError, "`rate_hz`"),
    ],
)
def test_what_cannot_be_trained_on_is_named(walks, options, error, words):
    with pytest.raises(error, match=words):
        sinew.train_cyclic(walks, **options)


def test_a_recording_without_a_cycle_is_named():
    with pytest.raises(sinew.SinewError, match=r"recordings\[1\]"):
        sinew.train_cyclic(_walk_and_rest(), rate_hz=30.0)
    with pytest.raises(FileNotFoundError):
        sinew.train_cyclic("no_such_cuts.csv")
    with pytest.raises(ValueError, match="`people`"):
        sinew.train_cyclic("cuts.csv", people=["a"])


def _walk_and_rest():
    filmed = sinew.simulate_keypoints(seconds=10.0, seed=1)
    walk = sinew.angles(filmed.keypoints, layout=filmed.layout, fps=filmed.rate_hz)
    return walk.angles_rad, np.zeros((200, 13))
