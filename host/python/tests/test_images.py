"""`sinew.read_image`, `segment_skin`, `find_blobs` and `simulate_arm`."""

import csv

import numpy as np
import pytest

import sinew


@pytest.fixture(scope="module")
def filmed():
    """Three frames of a person."""
    return sinew.simulate_arm(frames=3, seed=2, false_blob=1.0, hidden=0.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, command):
    """The same in a folder."""
    folder = tmp_path_factory.mktemp("scene")
    options = ["--frames", 3, "--seed", 2, "--false-blob", 1, "--hidden", 0]
    command("simulate", "arm", "--motion", "builtin", "--out", folder, *options)
    return folder


OPTIONS = [
    ({}, []),
    ({"skin": "histogram"}, ["--skin", "histogram"]),
    ({"calibrate": (300, 180, 20, 20)}, ["--calibrate", "300,180,20,20"]),
]


@pytest.mark.parametrize(("options", "words"), OPTIONS)
@pytest.mark.parametrize("raw", [False, True])
def test_masks_are_the_commands(tmp_path, command, folder, options, words, raw):
    path = folder / "frames" / "frame_0001.png"
    command("segment", path, "--out", tmp_path, *words, *(["--raw"] if raw else []))
    image = sinew.read_image(path)
    mask = sinew.segment_skin(image, raw=raw, **options)
    written = sinew.read_image(tmp_path / "frame_0001.png")
    assert mask.dtype == np.bool_ and mask.shape == (480, 640) and mask.any()
    np.testing.assert_array_equal(mask, written[..., 0] == 255)


@pytest.mark.parametrize(("options", "words"), OPTIONS)
def test_blobs_are_the_commands(tmp_path, command, folder, options, words):
    path = folder / "frames" / "frame_0002.png"
    command("blobs", path, "--out", tmp_path / "blobs.csv", *words)
    blobs = sinew.find_blobs(sinew.read_image(path), **options)
    with open(tmp_path / "blobs.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(blobs) > 0
    assert list(rows[0]) == ["image", "blob", *blobs.dtype.names]
    for name in blobs.dtype.names:
        printed = np.array([row[name] for row in rows]).astype(blobs.dtype[name])
        np.testing.assert_array_equal(blobs[name], printed, err_msg=name)


def test_an_image_without_skin_has_no_blobs(filmed):
    black = np.zeros((40, 50, 3), dtype=np.uint8)
    assert not sinew.segment_skin(black).any() and len(sinew.find_blobs(black)) == 0
    assert sinew.find_blobs(black).dtype == sinew.find_blobs(filmed.frames[0]).dtype
    assert sinew.segment_skin(np.zeros((1, 1, 3), dtype=np.uint8)).shape == (1, 1)


@pytest.mark.parametrize("width", [31, 32, 33, 65])
def test_masks_of_any_width_have_their_pixels(width):
    image = np.zeros((9, width, 3), dtype=np.uint8)
    image[:, width // 2 :] = (196, 140, 115)
    mask = sinew.segment_skin(image, skin="histogram", raw=True)
    np.testing.assert_array_equal(mask, image[..., 0] > 0)


@pytest.mark.parametrize("function", [sinew.segment_skin, sinew.find_blobs])
def test_wrong_parameters_are_named(function):
    image = np.zeros((48, 64, 3), dtype=np.uint8)
    cases = [
        ({"image": image[..., 0]}, "`image`.*shape"),
        ({"image": image.astype(np.uint16)}, "`image`.*uint8.*uint16"),
        ({"image": image[:0]}, "`image`.*sides"),
        ({"image": None}, "`image`"),
        ({"image": np.zeros((1, 9000, 3), np.uint8)}, "`image`.*8192"),
        ({"image": image, "skin": "skni"}, "`skin=skni`.*histogram"),
        ({"image": image, "skin": None}, "`skin`"),
        ({"image": image, "calibrate": (60, 40, 10, 10)}, "calibration rectangle 60,40,10,10.*64x48"),
        ({"image": image, "calibrate": (0, 0, 4, 4)}, "black"),
        ({"image": image, "calibrate": (0, 0, 2**40, 4)}, "`calibrate`"),
        ({"image": image, "calibrate": 7}, "`calibrate`"),
    ]
    for arguments, words in cases:
        with pytest.raises(ValueError, match=words):
            function(**arguments)


def test_negative_strides_are_accepted(filmed):
    image = filmed.frames[0]
    mask = sinew.segment_skin(np.ascontiguousarray(image[::-1])[::-1])
    np.testing.assert_array_equal(mask, sinew.segment_skin(image))
    bgr = np.ascontiguousarray(image[..., ::-1])
    np.testing.assert_array_equal(sinew.find_blobs(bgr[..., ::-1]), sinew.find_blobs(image))


def test_files_that_are_no_image_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="no-such.png"):
        sinew.read_image(tmp_path / "no-such.png")
    (tmp_path / "broken.png").write_text("no picture")
    with pytest.raises(sinew.SinewError, match="broken.png"):
        sinew.read_image(tmp_path / "broken.png")
    with pytest.raises(OSError):
        sinew.read_image(tmp_path)
    with pytest.raises(ValueError, match="`path`"):
        sinew.read_image(None)


def test_an_image_is_read_with_its_pixels(tmp_path):
    (tmp_path / "two.ppm").write_bytes(b"P6 2 1 255\n" + bytes([1, 2, 3, 4, 5, 6]))
    image = sinew.read_image(tmp_path / "two.ppm")
    assert image.dtype == np.uint8 and image.flags.writeable
    np.testing.assert_array_equal(image, [[[1, 2, 3], [4, 5, 6]]])


def test_a_scene_can_be_tracked(filmed):
    assert filmed.frames.shape == (3, 480, 640, 3) and filmed.notes == []
    assert filmed.truth["side"].tolist() == ["right"] * 3
    np.testing.assert_allclose(filmed.truth["time_s"], np.arange(3) / 15.0, atol=1e-6)
    tracker = sinew.ArmTracker(side=filmed.side, rate_hz=filmed.rate_hz, config=filmed.config)
    estimate = [tracker.update(image) for image in filmed.frames][-1]
    true_px = [filmed.truth[-1][name] for name in ("hand_u_px", "hand_v_px")]
    assert np.hypot(*(estimate.hand_px - true_px)) < 40.0
    again = sinew.simulate_arm(frames=3, seed=2, false_blob=1.0, hidden=0.0)
    assert (again.frames == filmed.frames).all()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"frames": 0}, "`frames`"),
        ({"frames": 10**9}, "`frames`.*at most.*sinew simulate arm"),
        ({"frames": 2, "rate_hz": 0.0}, "`rate_hz`"),
        ({"frames": 2, "rate_hz": 1.0e6}, "`rate_hz`"),
        ({"frames": 2, "hidden": 2.0}, "`hidden`"),
        ({"frames": 2, "false_blob": np.nan}, "`false_blob`"),
        ({"frames": 2, "noise_std": -1.0}, "`noise_std`"),
        ({"frames": 5, "away": (4, 2)}, "`away`"),
        ({"frames": 5, "away": 4}, "`away`"),
        ({"frames": 2, "side": "middle"}, "`side`"),
        ({"frames": 2, "seed": -1}, "`seed`"),
        ({"frames": 2, "motion": 7}, "`motion`"),
    ],
)
def test_wrong_scenes_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        sinew.simulate_arm(**options)


def test_a_motion_that_is_not_there_is_refused():
    with pytest.raises(OSError, match="no-such.bvh"):
        sinew.simulate_arm("no-such.bvh", frames=2)
