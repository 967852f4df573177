"""`sinew.ArmTracker`: the command's numbers, step by step."""

import csv
import json
import pickle
import subprocess
import threading

import numpy as np
import pytest

import sinew

FRAMES = 24
# Half of the last digit of the command's table, and single precision.
TOLERANCES = {"m": 0.51e-5, "rad": 0.51e-5, "px": 0.51e-2, "hand_likelihood": 0.51e-4}
HANDS = [
    {"frame": 0, "u_px": 300.0, "v_px": 200.0, "size_px": 60.0, "probability": 0.875, "side": "left"},
    {"frame": 1, "u_px": 305.0, "v_px": 210.5, "size_px": 60.0, "probability": 0.75, "side": ""},
    {"frame": 1, "u_px": 405.0, "v_px": 210.5, "size_px": 60.0, "probability": 0.75, "side": "right"},
    {"frame": 4, "u_px": 310.0, "v_px": 220.0, "size_px": 55.5, "probability": 0.5, "side": "right"},
]
HEADS = {0: (320.0, 120.0, 90.0), 9: (322.0, 121.5, 90.0)}


@pytest.fixture(scope="module")
def filmed():
    """A person with both arms and a face, whose hands are hidden at times."""
    return sinew.simulate_arm(frames=FRAMES, side="both", seed=5, false_blob=1.0, hidden=0.2)


@pytest.fixture(scope="module")
def scene(tmp_path_factory, command):
    """The same in a folder, with one image that cannot be read."""
    folder = tmp_path_factory.mktemp("scene")
    options = ["--frames", FRAMES, "--side", "both", "--seed", 5, "--false-blob", 1, "--hidden", 0.2]
    command("simulate", "arm", "--motion", "builtin", "--out", folder, *options)
    (folder / "frames" / "frame_0011.png").write_text("broken")
    table(folder / "hands.csv", HANDS)
    heads = [dict(zip(("frame", "u_px", "v_px", "size_px"), (frame, *box))) for frame, box in HEADS.items()]
    table(folder / "head.csv", heads)
    return folder


def table(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)


def images(scene):
    """The frames as the library reads them; None for the broken one."""
    paths = sorted((scene / "frames").glob("*.png"))
    return [None if path.name == "frame_0011.png" else sinew.read_image(path) for path in paths]


def tracked(frames, tracker, hands=None, heads=None):
    """Estimates of all arms in the order of the command's rows."""
    rows = []
    for number, image in enumerate(frames):
        found = None if hands is None else [hand for hand in hands if hand["frame"] == number]
        if found == []:
            found = np.empty((0, 5))
        answer = tracker.update(image, hands=found if image is not None else None, head=(heads or {}).get(number))
        rows += answer if isinstance(answer, sinew.ArmPair) else [answer]
    return rows


def assert_same_rows(estimates, path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(estimates)
    for estimate, row in zip(estimates, rows):
        assert (str(estimate.frame), estimate.side, estimate.status) == (row["frame"], row["side"], row["status"])
        assert row["time_s"] == f"{estimate.time_s:.6f}"
        for joint in ("hand", "elbow", "shoulder"):
            for unit, axes in (("m", "xyz"), ("px", "uv")):
                values = getattr(estimate, f"{joint}_{unit}")
                cells = [row[f"{joint}_{axis}_{unit}"] for axis in axes]
                assert_same_cells(values, cells, TOLERANCES[unit])
        angles = [row[f"{name}_rad"] for name in ("elevation", "deviation", "rotation", "flexion")]
        assert_same_cells(estimate.angles_rad, angles, TOLERANCES["rad"])
        assert_same_cells([estimate.hand_std_m], [row["hand_std_m"]], TOLERANCES["m"])
        assert_same_cells([estimate.hand_likelihood], [row["hand_likelihood"]], 0.51e-4)
        assert_same_cells([estimate.effective_sample_size], [row["effective_sample_size"]], 0.51e-2)
        assert_same_cells([estimate.log_evidence], [row["log_evidence"]], 0.51e-5)
        assert row["blob_count"] == ("" if estimate.blob_count is None else str(estimate.blob_count))
        assert int(row["dropped_blobs"]) == estimate.dropped_blobs
        assert bool(int(row["degenerate"])) == estimate.degenerate


def assert_same_cells(values, cells, tolerance):
    printed = [float(cell) if cell else np.nan for cell in cells]
    np.testing.assert_allclose(values, printed, rtol=0.0, atol=tolerance)


RUNS = [
    ("right", {}, []),
    ("both", {"seed": 7}, ["--seed", 7]),
    ("left", {"variant": "pik-weighted", "particles": 100}, ["--variant", "pik-weighted", "--particles", 100]),
    ("right", {"front_end": "lines"}, ["--front-end", "lines"]),
    ("both", {"front_end": "lines", "face": "given"}, ["--front-end", "lines", "--head"]),
    ("right", {"face": "given"}, ["--head"]),
    ("both", {"face": False}, ["--no-face", "--hands"]),
    ("both", {}, ["--hands"]),
    (
        "right",
        {"calibrate": (300, 180, 20, 20), "skin": "histogram", "rate_hz": 30},
        ["--calibrate", "300,180,20,20", "--skin", "histogram", "--rate", 30],
    ),
]


@pytest.mark.parametrize(("side", "options", "words"), RUNS)
def test_estimates_and_state_are_the_commands(tmp_path, command, scene, side, options, words):
    hands, heads = (HANDS if "--hands" in words else None), (HEADS if "--head" in words else None)
    tables = {"--hands": ["--hands", scene / "hands.csv"], "--head": ["--head", scene / "head.csv"]}
    arguments = [part for word in words for part in tables.get(word, [word])]
    config = scene / "camera.toml"
    command("track", "arm", scene / "frames", "--config", config, "--side", side, "--out", tmp_path, *arguments)
    tracker = sinew.ArmTracker(side=side, config=config, **options)
    estimates = tracked(images(scene), tracker, hands, heads)
    assert_same_rows(estimates, tmp_path / "track.csv")
    report = json.loads((tmp_path / "run.json").read_text())
    assert tracker.state_crc32 == report["state_crc32"]
    assert report["options"]["config"] == tracker.config


def test_a_scene_in_memory_is_that_of_the_command(filmed, scene):
    for image, read in zip(filmed.frames, images(scene)):
        assert read is None or (image == read).all()
    with open(scene / "truth.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(filmed.truth) == 2 * FRAMES
    for found, row in zip(filmed.truth, rows):
        assert found["side"] == row["side"]
        for name in filmed.truth.dtype.names:
            if name != "side":
                assert_same_cells([found[name]], [row[name]], 0.51e-2 if name.endswith("px") else 0.51e-4)
    from_file = sinew.ArmTracker(config=scene / "camera.toml")
    assert sinew.ArmTracker(config=filmed.config).config == from_file.config == filmed.config


@pytest.mark.parametrize(
    "options",
    [
        {"side": "both"},
        {"front_end": "lines", "face": "given"},
        {"calibrate": (300, 180, 20, 20), "skin": "histogram", "particles": 80},
        {"face": False, "variant": "bootstrap"},
    ],
)
def test_a_pickled_tracker_goes_on_bit_for_bit(filmed, options):
    tracker = sinew.ArmTracker(config=filmed.config, **options)
    again = pickle.loads(pickle.dumps(tracker))
    for number, image in enumerate(filmed.frames):
        image = None if number == 6 else image
        head = (320.0, 120.0, 90.0) if options.get("face") == "given" and number in (2, 8) else None
        repr(tracker.update(image, head=head))
        again.update(image, head=head)
        assert again.state_crc32 == tracker.state_crc32, number
        again = pickle.loads(pickle.dumps(again))
        assert (again.frame, again.size_px, again.side) == (number, (640, 480), tracker.side)
        assert again.config == tracker.config


def test_seeds_and_times_change_the_state(filmed):
    def state(rate_hz=15.0, seed=1, times=None):
        tracker = sinew.ArmTracker(config=filmed.config, rate_hz=rate_hz, seed=seed)
        for number, image in enumerate(filmed.frames[:5]):
            tracker.update(image, time_s=None if times is None else times[number])
        return tracker.state_crc32

    assert state() == state()
    assert state() != state(seed=2)
    assert state(rate_hz=10.0) == state(rate_hz=10.0, times=np.arange(5) / 10.0)
    assert state(rate_hz=10.0) != state(rate_hz=10.0, times=np.arange(5) / 20.0)


def test_any_layout_of_an_image_gives_the_same(filmed):
    def state(layout):
        tracker = sinew.ArmTracker(config=filmed.config, side="both")
        for image in filmed.frames[:3]:
            tracker.update(layout(image))
        return tracker.state_crc32

    expected = state(lambda image: image)
    padded = np.zeros((480, 700, 3), dtype=np.uint8)

    def within(image):
        padded[:, 30:670] = image
        return padded[:, 30:670]

    def frozen(image):
        image = image.copy()
        image.setflags(write=False)
        return image

    layouts = [
        np.asfortranarray,
        within,
        frozen,
        lambda image: image.tolist(),
        lambda image: np.ascontiguousarray(image[::-1, ::-1])[::-1, ::-1],
        lambda image: np.ascontiguousarray(image[..., ::-1])[..., ::-1],
    ]
    for layout in layouts:
        assert state(layout) == expected


def test_hands_come_in_any_form(filmed):
    rows = np.array([[300.0, 200.0, 60.0, 0.9, 0.0], [400.0, 210.0, 55.0, 0.8, np.nan]])
    named = np.array(
        [(300.0, 200.0, 60.0, 0.9, "left"), (400.0, 210.0, 55.0, 0.8, "")],
        dtype=[("u_px", "f4"), ("v_px", "f8"), ("size_px", "f4"), ("probability", "f8"), ("side", "U5")],
    )
    entries = [dict(zip(("u_px", "v_px", "size_px", "probability"), row[:4])) for row in rows.tolist()]
    entries[0]["side"] = "left"

    def state(hands):
        tracker = sinew.ArmTracker(config=filmed.config, side="both", size_px=(640, 480))
        tracker.update(hands=hands)
        estimate = tracker.update(filmed.frames[0], hands=hands)
        assert estimate.left.blob_count == estimate.right.blob_count == 3
        return tracker.state_crc32

    assert state(rows) == state(named) == state(entries)
    tracker = sinew.ArmTracker(size_px=(640, 480))
    # A detector that needs no image: the hand alone.
    estimate = [tracker.update(hands=[(250.0 + 2 * i, 200.0, 60.0, 0.9)]) for i in range(20)][-1]
    assert estimate.status in ("tracking", "uncertain") and estimate.blob_count == 1
    np.testing.assert_allclose(estimate.hand_px, [288.0, 200.0], atol=15.0)
    assert tracker.update(hands=[]).blob_count == 0
    assert tracker.update().blob_count is None


def test_shares_of_the_picture_are_refused_as_the_command_refuses_them(filmed):
    image, inside, corner = filmed.frames[0], (300.0, 200.0, 60.0, 0.9), (0.5, 0.4, 60.0, 0.9)
    wanted = sinew.ArmTracker()
    wanted.update(image, hands=[inside], head=(320.0, 120.0, 90.0))
    tracker = sinew.ArmTracker()
    remedy = "multiply `u_px` and `size_px` by the picture's width, `v_px` by its height"
    for name, places in (("hands", {"hands": [corner, (1.2, -0.1, 0.08, 0.9)]}), ("head", {"head": (0.5, 0.3, 0.12)})):
        with pytest.raises(ValueError, match=f"`{name}` holds shares of the picture.*{remedy}"):
            tracker.update(image, **places)
    tracker.update(image, hands=[inside], head=(320.0, 120.0, 90.0))
    assert tracker.state_crc32 == wanted.state_crc32, "refused frames do not count"
    # Pixels are known by now: these are of a hand in the corner.
    tracker = pickle.loads(pickle.dumps(tracker))
    assert tracker.update(image, hands=[corner]).blob_count == 1


def test_missing_frames_are_predicted_and_then_lost(filmed):
    tracker = sinew.ArmTracker(config=filmed.config)
    with pytest.raises(ValueError, match="`size_px`"):
        tracker.update()
    assert tracker.frame is None and tracker.state_crc32 is None and tracker.particles() == []
    first = sinew.ArmTracker(config=filmed.config, size_px=(640, 480))
    assert first.update().status == "lost"
    assert np.isnan(first.update().hand_m).all() and first.frame == 1
    for image in filmed.frames[:5]:
        tracker.update(image)
    assert tracker.update(None).status == "predicted"
    for _ in range(30):
        estimate = tracker.update()
    assert estimate.status == "lost" and np.isnan(estimate.hand_px).all() and np.isnan(estimate.angles_rad).all()


def test_particles_are_those_of_the_last_frame(filmed):
    tracker = sinew.ArmTracker(config=filmed.config, side="both", particles=40)
    tracker.update(filmed.frames[0])
    left, right = pickle.loads(pickle.dumps(tracker)).particles()
    assert (left.side, right.side) == ("left", "right")
    assert left.weight.sum() == pytest.approx(1.0, abs=1e-5)
    assert left.angles_rad.shape == (40, 4) and left.hand_m.shape == left.elbow_m.shape == (40, 3)
    np.testing.assert_array_equal(left.hand_m, tracker.particles()[0].hand_m)
    assert left.driver_blob.min() >= -1


def test_trackers_run_in_threads(filmed):
    def run(tracker):
        for image in filmed.frames:
            tracker.update(image)

    trackers = [sinew.ArmTracker(config=filmed.config, seed=seed) for seed in (1, 2, 1)]
    threads = [threading.Thread(target=run, args=[tracker]) for tracker in trackers]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert trackers[0].state_crc32 == trackers[2].state_crc32 != trackers[1].state_crc32


GREY = np.zeros((48, 64), dtype=np.uint8)
IMAGE = np.zeros((48, 64, 3), dtype=np.uint8)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"image": GREY}, "`image`.*shape.*np.stack"),
        ({"image": np.zeros((48, 64, 4), np.uint8)}, r"`image`.*\(48, 64, 4\)"),
        ({"image": np.zeros((3, 48, 64), np.uint8)}, "`image`.*shape"),
        ({"image": IMAGE.astype(np.float32)}, "`image`.*uint8.*float32"),
        ({"image": np.full((48, 64, 3), np.nan)}, "`image`.*uint8.*float64"),
        ({"image": (IMAGE + np.int64(256)).tolist()}, "`image`.*uint8"),
        ({"image": IMAGE.astype(np.int64)}, "`image`.*uint8"),
        ({"image": [[1], [1, 2]]}, "`image`"),
        ({"image": "picture.png"}, "`image`.*shape"),
        ({"image": np.zeros((0, 64, 3), np.uint8)}, "`image`.*1 to 8192.*64x0"),
        ({"image": np.zeros((48, 0, 3), np.uint8)}, "`image`.*1 to 8192"),
        ({"image": np.zeros((1, 8193, 3), np.uint8)}, "`image`.*8193x1"),
        ({"image": np.zeros((50, 64, 3), np.uint8)}, "`image` has 64x50 pixels, and this tracker's have 64x48"),
        ({"hands": [[1.0, 2.0, 3.0]]}, r"`hands`.*\(1, 3\)"),
        ({"hands": [[1.0, 2.0, 0.0, 0.5]]}, "`hands`, row 0: `size_px`"),
        ({"hands": [[1.0, 2.0, 3.0, 1.5]]}, "`hands`, row 0: `probability`.*1.5"),
        ({"hands": [[1.0, 2.0, 3.0, 1.0], [np.nan, 2.0, 3.0, 0.5]]}, "`hands`, row 1.*NaN"),
        ({"hands": [[1.0, 2.0, 3.0, np.nan]]}, "`hands`, row 0: `probability`"),
        ({"hands": [[1.0, 2.0, 3.0, 0.5, 2.0]]}, "`hands`.*fifth column"),
        ({"hands": [{"u_px": 1.0}]}, "`hands`.*`v_px`"),
        ({"hands": [{"u_px": "x", "v_px": 1, "size_px": 1, "probability": 1}]}, "`u_px` of `hands`"),
        ({"hands": [{"u_px": 1, "v_px": 1, "size_px": 1, "probability": 1, "side": "up"}]}, "`side` of `hands`"),
        ({"head": (1.0, 2.0, 3.0)}, "`head` needs `image`"),
        ({"image": IMAGE, "head": (1.0, 2.0)}, "`head`"),
        ({"image": IMAGE, "head": (1.0, 2.0, -3.0)}, "`head`.*`size_px`"),
        ({"image": IMAGE, "head": (np.nan, 2.0, 3.0)}, "`head`.*NaN"),
        ({"image": IMAGE, "time_s": np.nan}, "`time_s`"),
        ({"image": IMAGE, "time_s": -1.0}, "`time_s`"),
        ({"image": IMAGE, "time_s": "now"}, "`time_s`"),
    ],
)
def test_wrong_frames_are_named_and_do_not_count(arguments, words):
    tracker = sinew.ArmTracker(size_px=(64, 48))
    before = tracker.state_crc32
    with pytest.raises(ValueError, match=words):
        tracker.update(**arguments)
    assert tracker.frame is None and tracker.state_crc32 == before
    assert tracker.update(IMAGE).frame == 0


def test_times_have_to_rise_and_to_be_there():
    tracker = sinew.ArmTracker()
    tracker.update(IMAGE, time_s=1.0)
    with pytest.raises(ValueError, match="`time_s`.*rise.*1"):
        tracker.update(IMAGE, time_s=1.0)
    with pytest.raises(ValueError, match="`time_s`.*all frames"):
        tracker.update(IMAGE)
    assert tracker.update(IMAGE, time_s=1.5).time_s == 1.5
    with pytest.raises(ValueError, match="`head`.*face"):
        sinew.ArmTracker(face=False).update(IMAGE, head=(1.0, 2.0, 3.0))
    with pytest.raises(ValueError, match="`hands`.*front_end"):
        sinew.ArmTracker(front_end="lines", size_px=(64, 48)).update(hands=[(1.0, 2.0, 3.0, 0.5)])
    with pytest.raises(ValueError, match="calibration rectangle.*64x48"):
        sinew.ArmTracker(calibrate=(60, 0, 10, 10)).update(IMAGE)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"side": "middle"}, "`side`.*left.*middle"),
        ({"side": 1}, "`side`"),
        ({"variant": "kip"}, "`variant`.*pik-weighted.*kip"),
        ({"particles": 0}, "`particles`.*5000"),
        ({"particles": 5001}, "`particles`"),
        ({"particles": 2.5}, "`particles`"),
        ({"seed": -1}, "`seed`"),
        ({"seed": 2**64}, "`seed`"),
        ({"rate_hz": 0.0}, "`rate_hz`"),
        ({"rate_hz": 1.0e9}, "`rate_hz`.*10000"),
        ({"skin": "gausian"}, "`skin=gausian`"),
        ({"skin": 3}, "`skin`"),
        ({"calibrate": (1, 2, 3)}, "`calibrate`"),
        ({"calibrate": (1, 2, 0, 4)}, "`calibrate`"),
        ({"calibrate": (-1, 2, 3, 4)}, "`calibrate`"),
        ({"front_end": "photos"}, "`front_end`.*lines.*photos"),
        ({"face": "maybe"}, "`face`.*given"),
        ({"config": 5}, "`config`"),
        ({"config": {"body": {"heigth_m": 1.8}}}, "`config`.*body.height_m"),
        ({"config": {"body": {"height_m": -1.0}}}, "`config`.*height_m"),
        ({"config": {"body": {"height_m": np.nan}}}, "`config`.*finite"),
        ({"config": {"body": {"height_m": object()}}}, "`config`"),
        ({"size_px": (0, 48)}, "`size_px`"),
        ({"size_px": 640}, "`size_px`"),
    ],
)
def test_wrong_options_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        sinew.ArmTracker(**options)


def test_a_configuration_is_a_file_or_sections(tmp_path):
    path = tmp_path / "camera.toml"
    path.write_text("[body]\nheight_m = 1.9\n[tracker]\nparticles = 20\n")
    of_file = sinew.ArmTracker(config=path)
    of_dict = sinew.ArmTracker(config={"body": {"height_m": np.float64(1.9)}, "tracker": {"particles": np.int64(20)}})
    assert of_file.config == of_dict.config and of_file.config["tracker"]["particles"] == 20
    assert sinew.ArmTracker(config=path, particles=30).config["tracker"]["particles"] == 30
    with pytest.raises(FileNotFoundError, match="no-such.toml"):
        sinew.ArmTracker(config=tmp_path / "no-such.toml")
    path.write_text("[body]\nheigth_m = 1.9\n")
    with pytest.raises(sinew.SinewError, match="camera.toml.*body.height_m"):
        sinew.ArmTracker(config=path)


def test_a_broken_state_is_refused(filmed):
    tracker = sinew.ArmTracker(config=filmed.config)
    tracker.update(filmed.frames[0])
    restored, (saved,) = tracker.__reduce__()
    assert restored(saved).state_crc32 == tracker.state_crc32
    for broken in ("", "{}", saved[: len(saved) // 2], saved.replace('\\"trackers\\":\\"', '\\"trackers\\":\\"AAAA')):
        with pytest.raises(ValueError):
            restored(broken)
