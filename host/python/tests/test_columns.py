"""Data frames and series: their columns are found by name."""

import numpy as np
import pytest

import sinew

pandas = pytest.importorskip("pandas")

NAMES = list(sinew.ANGLE_NAMES)


@pytest.fixture(scope="module")
def frame(walk):
    return pandas.DataFrame(walk.angles_rad, columns=NAMES)


@pytest.mark.parametrize("unit", ["", "_rad"])
def test_columns_in_any_order_give_the_same_track(walk, frame, unit):
    wanted = sinew.track_cyclic(walk.angles_rad, rate_hz=30.0)
    for order in (NAMES, sorted(NAMES), NAMES[::-1]):
        found = sinew.track_cyclic(frame[order].add_suffix(unit), rate_hz=30.0)
        np.testing.assert_array_equal(found.angles_rad, wanted.angles_rad)
    unnamed = sinew.track_cyclic(pandas.DataFrame(walk.angles_rad), rate_hz=30.0)
    np.testing.assert_array_equal(unnamed.angles_rad, wanted.angles_rad)
    table = pytest.importorskip("pyarrow").Table.from_pandas(frame[NAMES[::-1]], preserve_index=False)
    np.testing.assert_array_equal(sinew.track_cyclic(table, rate_hz=30.0).angles_rad, wanted.angles_rad)


def test_names_that_are_unknown_missing_or_there_twice_are_named(frame):
    renamed = frame.rename(columns={NAMES[2]: "hip"})
    twice = frame[[*NAMES[:-1], NAMES[0]]]
    for wrong, words in (
        (renamed, f"`angles` has to have the columns .*it lacks {NAMES[2]} and it has also hip"),
        (frame.assign(frame=range(len(frame))), "it has also frame"),
        (twice, f"it lacks {NAMES[-1]} and it has also {NAMES[0]}"),
    ):
        with pytest.raises(ValueError, match=words):
            sinew.track_cyclic(wrong, rate_hz=30.0)
    with pytest.raises(ValueError, match=r"`recordings\[0\]` has to have the columns"):
        sinew.train_cyclic([renamed], rate_hz=30.0)


def test_rows_of_an_online_tracker_are_read_by_name(frame):
    by_place, by_name = sinew.CyclicTracker(rate_hz=30.0), sinew.CyclicTracker(rate_hz=30.0)
    for row in range(20):
        answers = by_place.update(frame.to_numpy()[row]), by_name.update(frame[NAMES[::-1]].iloc[row])
        np.testing.assert_array_equal(answers[0].angles_rad, answers[1].angles_rad)
    with pytest.raises(ValueError, match="`z` has to have the columns"):
        by_name.update(frame.iloc[0][1:])


def test_points_and_the_first_pose_are_read_by_name():
    scene = sinew.simulate_stereo(rate_hz=4.0, points=300)
    pose = dict(zip(sinew.BODY_COORDINATE_NAMES, map(float, scene.first_pose)))
    crcs = set()
    for first_pose in (scene.first_pose, pandas.Series(pose)[sorted(pose)]):
        tracker = sinew.BodyTracker(rate_hz=4.0, particles=12, measures=scene.measures, first_pose=first_pose)
        for cloud in scene.clouds[:2]:
            points = pandas.DataFrame(cloud, columns=["x", "y", "z"])[["z", "x", "y"]]
            tracker.update(cloud if first_pose is scene.first_pose else points)
        crcs.add(tracker.state_crc32)
    assert len(crcs) == 1
    with pytest.raises(ValueError, match="`points` has to have the columns x, y, z: it lacks z and it has also depth"):
        tracker.update(points.rename(columns={"z": "depth"}))


def test_hands_and_heads_are_read_by_name():
    scene = sinew.simulate_arm(frames=3)
    hand = {"u_px": 300.0, "v_px": 200.0, "size_px": 50.0, "probability": 0.9, "side": "right"}
    head = {"u_px": 320.0, "v_px": 140.0, "size_px": 80.0}
    crcs = set()
    for is_frame in (False, True):
        tracker = sinew.ArmTracker()
        for image in scene.frames:
            if is_frame:
                hands = pandas.DataFrame([hand])[["side", "probability", "v_px", "u_px", "size_px"]]
                tracker.update(image, hands=hands, head=pandas.Series(head)[["size_px", "v_px", "u_px"]])
            else:
                tracker.update(image, hands=[hand], head=head)
        crcs.add(tracker.state_crc32)
    assert len(crcs) == 1
    with pytest.raises(ValueError, match="`hands` has to have `size_px`, but has u_px"):
        tracker.update(image, hands=pandas.DataFrame([hand]).rename(columns={"size_px": "width"}))
