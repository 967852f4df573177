"""`sinew.angles`, `sinew.simulate_keypoints`, `sinew.Model`."""

import pickle

import numpy as np
import pytest

import sinew

# Where the points of the stick figure stand among those of COCO: both have arms and legs.
COCO_OF_STICK = {5: 2, 7: 3, 9: 4, 6: 5, 8: 6, 10: 7, 11: 8, 13: 9, 15: 10, 12: 11, 14: 12, 16: 13}


@pytest.fixture(scope="module")
def coco(keypoints):
    points = np.full((len(keypoints.keypoints), 17, 3), np.nan)
    for to, of in COCO_OF_STICK.items():
        points[:, to] = keypoints.keypoints[:, of]
    return points


def test_layouts_agree(walk, coco):
    found = sinew.angles(coco, fps=30.0)
    assert found.angles_rad.shape == (len(coco), 13)
    assert found.rate_hz == 30.0 and found.facing == "right"
    assert found.layout == "COCO, 17 points"
    knees = [sinew.ANGLE_NAMES.index(name) for name in ("l_knee", "r_ankle")]
    np.testing.assert_allclose(found.angles_rad[:, knees], walk.angles_rad[:, knees])
    assert {"coco17", "mediapipe33", "body25", "halpe26", "stick14"} <= set(sinew.layouts())


def test_two_columns_are_sure_and_lists_are_taken(coco):
    bare = sinew.angles(coco[:, :, :2], fps=30.0)
    listed = sinew.angles(coco.tolist(), fps=30.0)
    np.testing.assert_array_equal(bare.angles_rad, listed.angles_rad)
    turned = sinew.angles(coco[::-1].copy()[::-1], fps=30.0)
    np.testing.assert_array_equal(turned.angles_rad, listed.angles_rad)


def test_who_walks_left_is_mirrored():
    left = sinew.simulate_keypoints(facing="left", seed=2)
    right = sinew.simulate_keypoints(facing="right", seed=2)
    of_left, of_right = (sinew.angles(film.keypoints, film.layout, fps=30.0) for film in (left, right))
    assert (of_left.facing, of_right.facing) == ("left", "right")
    assert any("faces left" in note for note in of_left.notes)
    cadences = [sinew.track_cyclic(angles).cadence_per_min for angles in (of_left, of_right)]
    assert cadences[0] == pytest.approx(cadences[1], rel=0.02)


def test_shares_need_a_size(keypoints, walk):
    shares = keypoints.keypoints.copy()
    shares[:, :, :2] /= keypoints.image_size_px
    with pytest.raises(ValueError, match="image_size_px=\\(WIDTH, HEIGHT\\)"):
        sinew.angles(shares, keypoints.layout, fps=30.0)
    found = sinew.angles(shares, keypoints.layout, fps=30.0, image_size_px=keypoints.image_size_px)
    np.testing.assert_allclose(found.angles_rad, walk.angles_rad, atol=1.0e-6)


def test_sentences_about_an_array_speak_of_it(keypoints, walk):
    points = keypoints.keypoints.copy()
    points[:, :, 1] = 1000.0 - points[:, :, 1]
    points[90:, :, 0] += 500.0
    found = sinew.angles(points, keypoints.layout, fps=30.0)
    assert any(note.startswith("y points up (") and note.endswith("minus the array's") for note in found.notes)
    assert any(doubt.endswith("another person, or a cut; cut there") for doubt in found.doubts)
    for said in [*found.notes, *found.doubts, *sinew.track_cyclic(found).doubts]:
        assert "file" not in said and "person," not in said.split(";")[-1] and "--" not in said, said
    with pytest.raises(ValueError, match="make the table anew by `sinew.angles` with fps=60"):
        sinew.track_cyclic(walk, rate_hz=60.0)


@pytest.mark.parametrize(
    ("points", "options", "words"),
    [
        (np.ones((4, 17, 3)), {}, "`fps` has to be given"),
        (np.ones((4, 17, 3)), {"fps": -1}, "`fps`.*greater than zero"),
        (np.ones((4, 17)), {"fps": 30}, "`keypoints`.*shape"),
        (np.ones((4, 17, 4)), {"fps": 30}, "`keypoints`.*shape"),
        (np.ones((0, 17, 3)), {"fps": 30}, "`keypoints` need at least one frame"),
        (np.ones((4, 18, 3)), {"fps": 30}, "`keypoints` need 17 points"),
        (np.ones((4, 17, 3)), {"fps": 30, "layout": "coco"}, "`layout` has to be one of .*coco17"),
        (np.full((4, 17, 3), np.nan), {"fps": 30}, "`keypoints` has no person"),
        (np.full((4, 17, 3), 1.0e12), {"fps": 30}, "`keypoints` at frame 0"),
        (np.ones((4, 17, 3)), {"fps": 30, "min_confidence": -1}, "`min_confidence`"),
        (np.ones((4, 17, 3)), {"fps": 30, "image_size_px": (0, 5)}, "`image_size_px`"),
        (np.ones((4, 17, 3)), {"fps": 30, "image_size_px": (5,)}, "`image_size_px`"),
        (np.ones((4, 17, 3)), {"fps": 30, "facing": "up"}, "`facing`.*`up`"),
        (np.ones((4, 17, 3)), {"fps": 30, "person": 2}, "`person` is for files"),
        ("walk.xyz", {"layout": "halpe26"}, "`layout` is for arrays"),
        ([["x"]], {"fps": 30}, "`keypoints`"),
    ],
)
def test_wrong_values_are_named(points, options, words):
    with pytest.raises(ValueError, match=words):
        sinew.angles(points, **options)


def test_files(tmp_path, walk):
    with pytest.raises(FileNotFoundError, match="missing.bvh"):
        sinew.angles(tmp_path / "missing.bvh")
    unknown = tmp_path / "file.xyz"
    unknown.write_text("x")
    with pytest.raises(sinew.SinewError, match="file.xyz.*is of no known kind"):
        sinew.angles(str(unknown))
    with pytest.raises(OSError):
        walk.save(tmp_path / "missing" / "walk.csv")
    walk.save(tmp_path / "walk.csv")
    assert sinew.track_cyclic(tmp_path / "walk.csv").rate_hz == 30.0
    assert (tmp_path / "walk.about.json").is_file()


def test_angles_are_an_array(walk):
    assert np.asarray(walk).shape == (len(walk), 13)
    assert np.asarray(walk, dtype=np.float32).dtype == np.float32
    assert "180 frames at 30 Hz" in repr(walk)


def test_simulated_keypoints():
    one, same, other = (sinew.simulate_keypoints(seconds=1.0, seed=seed) for seed in (1, 1, 2))
    assert one.keypoints.shape == (30, 14, 3)
    np.testing.assert_array_equal(one.keypoints, same.keypoints)
    assert not np.array_equal(one.keypoints, other.keypoints)
    for options, words in [
        ({"seconds": 0.0}, "`seconds`"),
        ({"rate_hz": 1.0e6}, "`rate_hz`"),
        ({"height_px": 1.0}, "`height_px`"),
        ({"sigma_px": -1.0}, "`sigma_px`"),
        ({"missing": 1.0}, "`missing`"),
        ({"facing": "up"}, "`facing`"),
        ({"seed": -1}, "`seed`"),
    ]:
        with pytest.raises(ValueError, match=words):
            sinew.simulate_keypoints(**options)


def test_models():
    assert sinew.models() == ["walking", "running", "arm-circles"]
    for name in sinew.models():
        model = sinew.Model(name)
        assert model.mean_cycle_rad.shape == (100, 13) and model.rate_hz > 0.0
        assert 40.0 < model.cadence_per_min < 110.0 and model.trained_cycles >= 6
    again = pickle.loads(pickle.dumps(sinew.Model("running")))
    assert repr(again) == "Model('running')"
    np.testing.assert_array_equal(again.mean_cycle_rad, sinew.Model("running").mean_cycle_rad)
    with pytest.raises(sinew.SinewError, match="walking, running, arm-circles"):
        sinew.Model("wlaking")


def test_a_model_of_a_file(tmp_path, walk):
    path = tmp_path / "model.json"
    path.write_text(sinew.Model("walking")._native.to_json())
    of_file, shipped = (sinew.track_cyclic(walk, model) for model in (path, "walking"))
    np.testing.assert_array_equal(of_file.angles_rad, shipped.angles_rad)


def test_angles_are_pickled_whole(tmp_path, walk):
    again = pickle.loads(pickle.dumps(walk))
    np.testing.assert_array_equal(again.angles_rad, walk.angles_rad)
    np.testing.assert_array_equal(again.frame, walk.frame)
    for name in ("rate_hz", "facing", "layout", "notes", "doubts"):
        assert getattr(again, name) == getattr(walk, name), name
    walk.save(tmp_path / "a.csv")
    again.save(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    track, of_again = sinew.track_cyclic(walk), sinew.track_cyclic(again)
    np.testing.assert_array_equal(track.angles_rad, of_again.angles_rad)
    assert track.gait == of_again.gait and track.notes == of_again.notes == walk.notes
