"""`sinew.BodyTracker`: its answers are the command's, and what it refuses."""

import csv
import json
import pickle
import threading

import numpy as np
import pytest

import sinew

POINTS = 400
FRAMES = 12


@pytest.fixture(scope="module")
def scene():
    """A person with a stick."""
    return sinew.simulate_stereo(rate_hz=2.0, points=POINTS)


def tracker_of(scene, **options):
    options = {"measures": scene.measures, "first_pose": scene.first_pose, "rate_hz": scene.rate_hz} | options
    return sinew.BodyTracker(**options)


def same_estimates(found, wanted):
    for name in ("pose", "joints_m", "spread_m", "observed", "ambiguous"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))
    assert (found.frame, found.points, found.log_evidence) == (wanted.frame, wanted.points, wanted.log_evidence)


def same_as_table(estimates, path):
    """Every printed number is the estimate's, in single precision."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(estimates)
    for row, estimate in zip(rows, estimates):
        found = {"frame": estimate.frame, "points": estimate.points}
        found |= {f"root_{axis}_m": value for axis, value in zip("xyz", estimate.root_m)}
        found |= {f"{name}_rad": value for name, value in estimate.angles_rad.items()}
        found["effective_sample_size"] = estimate.effective_sample_size
        found["log_evidence"] = estimate.log_evidence
        for index, place in enumerate(estimate.joints_m):
            joint = sinew.BODY_JOINT_NAMES[index]
            found |= {f"{joint}_{axis}_m": value for axis, value in zip("xyz", place)}
            if f"{joint}_spread_m" in row:
                found[f"{joint}_spread_m"] = estimate.spread_m[index]
                found[f"{joint}_observed"] = estimate.observed[index]
                found[f"{joint}_ambiguous"] = estimate.ambiguous[index]
        assert set(row) == set(found)
        for name, cell in row.items():
            assert np.float32(cell) == np.float32(found[name]), (estimate.frame, name)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    ("motion", "part", "model"),
    [
        ("stick-wave", "whole", "guided"),
        ("stick-wave", "upper", "guided"),
        ("stick-wave", "whole", "stick"),
        ("pelvic-lift", "whole", "pelvic-lift"),
    ],
)
def test_answers_are_the_commands(tmp_path, command, motion, part, model, threads):
    folder, out = tmp_path / "scene", tmp_path / "run"
    made = ["--rate", 2, "--points", POINTS, "--body", part]
    command("simulate", "stereo", "--motion", motion, *made, "--out", folder)
    said = command("track", "body", folder, "--model", model, "--particles", 40, "--seed", 7, "--out", out)["run"]
    scene = json.loads((folder / "run.json").read_text())
    tracker = sinew.BodyTracker(
        measures=folder / "body.json",
        first_pose=folder / "first_pose.json",
        part=part,
        model=model,
        particles=40,
        seed=7,
        rate_hz=scene["rate_hz"],
        floor_y_m=scene["floor_y_m"],
        threads=threads,
    )
    simulated = sinew.simulate_stereo(motion, rate_hz=2.0, points=POINTS, part=part)
    # The file of the stick has hundredths of a millimetre.
    stick = np.genfromtxt(folder / "stick.csv", delimiter=",", skip_header=1)[:, 1:7] if model == "stick" else None
    estimates = []
    for frame, cloud in enumerate(simulated.clouds):
        np.testing.assert_array_equal(cloud, sinew.read_cloud(folder / "points" / f"{frame:06}.ply"))
        ends = None if stick is None else stick[frame].reshape(2, 3)
        estimates.append(tracker.update(cloud, stick=ends))
    same_as_table(estimates, out / "track.csv")
    assert tracker.state_crc32 == said["state_crc32"]


def test_a_start_in_the_points_and_frames_without_a_file(tmp_path, command):
    folder, out = tmp_path / "scene", tmp_path / "run"
    command("simulate", "stereo", "--motion", "stick-wave", "--rate", 2, "--points", 21000, "--out", folder)
    clouds = {frame: sinew.read_cloud(folder / "points" / f"{frame:06}.ply") for frame in (0, 1, 4, 5)}
    for path in (folder / "points").iterdir():
        if int(path.stem) not in clouds:
            path.unlink()
    (folder / "first_pose.json").unlink()
    said = command("track", "body", folder, "--out", out)["run"]
    tracker = sinew.BodyTracker(measures=folder / "body.json", rate_hz=2)
    estimates = [tracker.update(cloud, time_s=100.0 + frame / 2.0) for frame, cloud in clouds.items()]
    same_as_table(estimates, out / "track.csv")
    assert tracker.state_crc32 == said["state_crc32"]
    assert estimates[-1].points == 20000 and estimates[-1].points_over_cap > 0


@pytest.mark.parametrize("knows_first_pose", [False, True])
def test_estimated_measures_are_the_commands(tmp_path, command, scene, knows_first_pose):
    folder, out = tmp_path / "scene", tmp_path / "run"
    command("simulate", "stereo", "--motion", "stick-wave", "--rate", 2, "--points", POINTS, "--out", folder)
    if not knows_first_pose:
        (folder / "first_pose.json").unlink()
    given = ["--height", 1.6, "--size", "estimated"]
    (folder / "body.json").unlink()
    run = command("track", "body", folder, *given, "--out", out)["run"]
    first = {"first_pose": scene.first_pose} if knows_first_pose else {}
    person = sinew.BodyTracker(height_m=1.6, rate_hz=2.0, **first)
    measures = person.estimate_measures(iter(scene.clouds))
    assert measures == run["body"] != person.measures
    assert person.frame is None, "the tracker stays as it is"
    tracker = sinew.BodyTracker(measures=measures, rate_hz=2.0, **first)
    same_as_table([tracker.update(cloud) for cloud in scene.clouds], out / "track.csv")
    assert tracker.state_crc32 == run["state_crc32"]


def test_measures_are_estimated_before_the_first_frame_and_from_points(scene):
    tracker = tracker_of(scene)
    assert tracker.estimate_measures([None, np.zeros((0, 3), np.float32)]) is None
    with pytest.raises(ValueError, match="`clouds`"):
        tracker.estimate_measures([np.zeros((4, 2))])
    tracker.update(scene.clouds[0])
    with pytest.raises(ValueError, match="`estimate_measures` is for a tracker that answered no frame"):
        tracker.estimate_measures(scene.clouds)


def test_the_first_pose_is_the_commands(tmp_path, command, scene):
    folder, out = tmp_path / "scene", tmp_path / "run"
    command("simulate", "stereo", "--motion", "stick-wave", "--rate", 2, "--points", POINTS, "--out", folder)
    (folder / "first_pose.json").unlink()
    run = command("track", "body", folder, "--out", out)["run"]
    person = sinew.BodyTracker(measures=scene.measures, rate_hz=scene.rate_hz)
    first = person.find_first_pose(iter([None, *scene.clouds]))
    assert person.frame is None, "the tracker stays as it is"
    assert first.is_facing_doubtful == any("wrong way" in warning for warning in run["warnings"])
    tracker = sinew.BodyTracker(measures=scene.measures, rate_hz=scene.rate_hz, first_pose=first.pose)
    same_as_table([tracker.update(cloud) for cloud in scene.clouds], out / "track.csv")
    assert person.find_first_pose([]).facing_margin == 0.0


def test_shapes_and_types(scene):
    tracker = tracker_of(scene)
    assert tracker.frame is None and tracker.measures == scene.measures
    first = tracker.update(scene.clouds[0])
    np.testing.assert_array_equal(first.pose, scene.first_pose)
    estimate = tracker.update(scene.clouds[1])
    assert estimate.joints_m.shape == (17, 3) and estimate.joints_m.dtype == np.float32
    assert estimate.spread_m.shape == estimate.observed.shape == (17,)
    assert len(estimate.angles_rad) == 27 and set(estimate.to_pose()) == set(sinew.BODY_COORDINATE_NAMES)
    assert (estimate.frame, estimate.time_s, tracker.frame) == (1, 0.5, 1)
    assert np.abs(estimate.joints_m - scene.joints_m[1]).max() < 0.3
    upper = tracker_of(scene, part="upper").update(scene.clouds[0])
    assert upper.joints_m.shape == (9, 3) and len(upper.angles_rad) == 14
    assert len(sinew.BODY_PARENTS) == len(sinew.BODY_JOINT_NAMES) == 17
    assert "guided, 30 particles" in repr(tracker)


def test_a_pickled_tracker_goes_on_bit_for_bit(scene):
    whole, broken = tracker_of(scene, threads=1), tracker_of(scene, threads=2)
    for frame, cloud in enumerate(scene.clouds[:FRAMES]):
        if frame in (0, 1, 5):
            broken = pickle.loads(pickle.dumps(broken))
        same_estimates(broken.update(cloud), whole.update(cloud))
    assert broken.state_crc32 == whole.state_crc32
    # Also before a first pose is known, and between times.
    waiting = pickle.loads(pickle.dumps(sinew.BodyTracker(rate_hz=2.0)))
    assert waiting.notes and waiting.update(None, time_s=3.3) is None
    waiting = pickle.loads(pickle.dumps(waiting))
    with pytest.raises(ValueError, match="`time_s`.*rise"):
        waiting.update(None, time_s=3.3)
    assert waiting.update(scene.clouds[0]).frame == 1


@pytest.mark.parametrize(
    "of",
    [
        lambda a: a.astype(np.float64),
        lambda a: a.tolist(),
        lambda a: np.asfortranarray(a),
        lambda a: a[::-1].copy()[::-1],
        lambda a: a[:, ::-1].copy()[:, ::-1],
        lambda a: np.repeat(a, 2, axis=0)[::2],
        lambda a: a.astype(">f4"),
        lambda a: a.astype(object),
        lambda a: np.ma.masked_invalid(a),
        lambda a: np.concatenate([a, np.full((3, 3), np.nan), [[np.inf, 0, 1], [0, 0, 0], [0, 0, 1e300]]]),
    ],
    ids=["float64", "list", "fortran", "back", "mirrored", "strided", "big-endian", "objects", "masked", "unusable"],
)
def test_any_layout_in_memory_gives_the_same(scene, of):
    found, wanted = tracker_of(scene), tracker_of(scene)
    for cloud in scene.clouds[:3]:
        same_estimates(found.update(of(cloud)), wanted.update(cloud))
    assert found.state_crc32 == wanted.state_crc32


def test_read_only_clouds_are_taken(scene):
    cloud = scene.clouds[0].copy()
    cloud.flags.writeable = False
    assert tracker_of(scene).update(cloud).points == len(cloud)


@pytest.mark.parametrize("nothing", [None, [], np.empty((0, 3)), np.full((50, 3), np.nan), np.zeros((50, 3))])
def test_nothing_seen_is_a_prediction(scene, nothing):
    tracker = tracker_of(scene)
    tracker.update(scene.clouds[0])
    estimate = tracker.update(nothing)
    assert estimate.points == 0 and not estimate.observed.any() and np.isfinite(estimate.joints_m).all()
    assert estimate.skipped_points == (0 if nothing is None else len(nothing))


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (np.zeros((5, 2)), "`points`.*shape \\(n, 3\\), not \\(5, 2\\)"),
        (np.zeros((3, 5)), "`points`.*shape"),
        (np.zeros((0, 2)), "`points`.*shape"),
        (np.zeros((5, 0)), "`points`.*shape"),
        (np.zeros(3, dtype=np.float32), "`points`.*shape"),
        (np.zeros((1, 5, 3), dtype=np.float32), "`points`.*shape"),
        (7.0, "`points`.*shape"),
        (np.zeros((5, 3), dtype=complex), "`points`.*complex"),
        (np.zeros((5, 3), dtype=bool), "`points`.*bool"),
        (np.full((5, 3), "x"), "`points`.*real numbers"),
        ([[0.0] * 3, [0.0]], "`points`"),
        ([[10**400] * 3], "`points`"),
        (np.broadcast_to(np.float32(1.0), (10**9, 3)), "`points`.*at most 89478485 points"),
    ],
)
def test_wrong_points_are_named(scene, points, words):
    tracker = tracker_of(scene)
    with pytest.raises(ValueError, match=words):
        tracker.update(points)
    assert tracker.frame is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda cloud: 100.0 * cloud, r"`points`: the first points begin \d+ m .*multiply them by .*0.01 for centi"),
        (lambda cloud: 1000.0 * cloud, "`points`: the points are farther than 1000 m.*0.001 for millimetres"),
        (lambda cloud: 0.01 * cloud, r"`points`: the first points end 0.0\d+ m from the camera"),
        (lambda cloud: cloud * [1, -1, -1], "`points`: .* behind the camera .*change the signs of y and z"),
    ],
    ids=["centimetres", "millimetres", "hectometres", "y up, z backward"],
)
def test_first_points_in_other_units_or_axes_are_refused(scene, change, words):
    tracker = tracker_of(scene)
    # All points may be too far in a first dark picture: five are looked at.
    with pytest.raises(ValueError, match=words):
        for cloud in scene.clouds[:5]:
            tracker.update(change(cloud))
    with pytest.raises(ValueError, match=words.replace("points`", "clouds`")):
        tracker_of(scene).estimate_measures([change(cloud) for cloud in scene.clouds])
    same = tracker_of(scene)
    for _ in range(0 if tracker.frame is None else tracker.frame + 1):
        same.update(None)
    for cloud in scene.clouds[:6]:
        same_estimates(tracker.update(cloud), same.update(cloud))
    same.update(change(scene.clouds[6]))


def test_notes_speak_of_parameters(scene):
    unknown = sinew.BodyTracker(rate_hz=scene.rate_hz)
    assert any("(`height_m`, `measures`)" in note for note in unknown.notes), unknown.notes
    z_up = tracker_of(scene, first_pose=None)
    for cloud in scene.clouds[:5]:
        z_up.update(cloud[:, [0, 2, 1]] * [1.0, -1.0, -1.0] + [0.0, 2.0, 3.0])
    assert any("along the line of sight" in note and "(`first_pose`)" in note for note in z_up.notes), z_up.notes
    assert "--" not in " ".join(unknown.notes + z_up.notes)


@pytest.mark.parametrize("time_s", [np.nan, np.inf, "x", 4.0, 3.9])
def test_wrong_times_are_named(scene, time_s):
    tracker = tracker_of(scene)
    tracker.update(scene.clouds[0], time_s=4.0)
    before = tracker.state_crc32
    with pytest.raises(ValueError, match="`time_s`"):
        tracker.update(scene.clouds[1], time_s=time_s)
    assert (tracker.frame, tracker.state_crc32) == (0, before)
    assert tracker.update(scene.clouds[1], time_s=5.0).frame == 2


def test_a_stick_is_for_its_model(scene):
    with pytest.raises(ValueError, match="`stick` is for model"):
        tracker_of(scene).update(scene.clouds[0], stick=scene.stick_m[0])
    tracker = tracker_of(scene, model="stick", particles=20)
    with pytest.raises(ValueError, match="`stick`.*shape \\(2, 3\\)"):
        tracker.update(scene.clouds[0], stick=np.zeros((3, 2)))
    unseen = tracker_of(scene, model="stick", particles=20)
    for cloud, stick in zip(scene.clouds[:3], scene.stick_m):
        tracker.update(cloud, stick=stick * np.nan)
        unseen.update(cloud)
    assert tracker.state_crc32 == unseen.state_crc32


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"height_m": 9}, "`height_m` has to be from 0.5"),
        ({"height_m": "x"}, "`height_m`"),
        ({"height_m": 1.7, "measures": {}}, "`height_m`.*`measures`"),
        ({"measures": {"trunk_m": 0.5}}, "`measures` is no body.json.*head_m"),
        ({"measures": 3}, "`measures` has to be a path or a dict"),
        ({"measures": {"trunk_m": object()}}, "`measures` has to hold plain numbers"),
        ({"part": "lower"}, "`part` has to be one of whole, upper, not `lower`"),
        ({"part": 1}, "`part`"),
        ({"part": "upper", "model": "pelvic-lift"}, "model=\"pelvic-lift\" holds the feet.*part=\"whole\""),
        ({"model": "guidde"}, "`model` has to be one of end-effector, guided"),
        ({"particles": 0}, "`particles`"),
        ({"particles": 10**6}, "`particles` has to be from 1 to 16384"),
        ({"particles": 2.5}, "`particles`"),
        ({"seed": -1}, "`seed`"),
        ({"rate_hz": 0}, "`rate_hz`"),
        ({"rate_hz": 1e9}, "`rate_hz` has to be from 0.1 to 1000 Hz"),
        ({"first_pose": np.zeros(29)}, "`first_pose`.*shape \\(30,\\)"),
        ({"first_pose": np.full(30, np.nan)}, "`first_pose`"),
        ({"first_pose": {"knee": 1.0}}, "`first_pose` cannot be used.*`knee` is no coordinate"),
        ({"floor_y_m": np.inf}, "`floor_y_m`"),
        ({"threads": 0}, "`threads`"),
        ({"threads": 1000}, "`threads` has to be from 1 to 256"),
        ({"config": {"gided": {}}}, "`config` cannot be used.*nearest one is `guided`"),
        ({"config": {"guided": {"reach_std_m": -1}}}, "`config`.*`guided.reach_std_m`"),
        ({"config": {"guided": {"reach_std_m": [1]}}}, "`config`.*`reach_std_m` has to be a number"),
    ],
)
def test_wrong_options_are_named(options, words):
    with pytest.raises(ValueError, match=words):
        sinew.BodyTracker(**options)


def test_files_that_cannot_be_used(tmp_path):
    for name, ending in [("measures", "json"), ("measures", "bvh"), ("first_pose", "json"), ("config", "toml")]:
        missing = tmp_path / f"missing.{ending}"
        with pytest.raises(FileNotFoundError, match=missing.name):
            sinew.BodyTracker(**{name: missing})
        broken = tmp_path / f"broken.{ending}"
        broken.write_text("nonsense")
        with pytest.raises(sinew.SinewError, match=broken.name):
            sinew.BodyTracker(**{name: broken})


def test_a_config_and_a_pose_by_name(tmp_path, scene):
    config = {"pulling_blocks": 12, "guided": {"reach_std_m": np.float64(0.2)}}
    file = tmp_path / "numbers.toml"
    file.write_text("pulling_blocks = 12\n[guided]\nreach_std_m = 0.2\n")
    pose = dict(zip(sinew.BODY_COORDINATE_NAMES, scene.first_pose))
    trackers = [tracker_of(scene, config=config, first_pose=pose), tracker_of(scene, config=file), tracker_of(scene)]
    for tracker in trackers:
        for cloud in scene.clouds[:3]:
            tracker.update(cloud)
    given, of_file, plain = (tracker.state_crc32 for tracker in trackers)
    assert given == of_file != plain
    limited = tracker_of(scene, first_pose={"root_z": 3.0, "l_knee_flexion": -9.0})
    assert any("l_knee_flexion" in note for note in limited.notes)


def test_trackers_in_threads_give_the_same(scene):
    wanted = tracker_of(scene)
    for cloud in scene.clouds[:FRAMES]:
        wanted.update(cloud)
    trackers = [tracker_of(scene, threads=1) for _ in range(3)]

    def run(tracker):
        for cloud in scene.clouds[:FRAMES]:
            tracker.update(cloud)

    threads = [threading.Thread(target=run, args=(tracker,)) for tracker in trackers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {tracker.state_crc32 for tracker in trackers} == {wanted.state_crc32}
