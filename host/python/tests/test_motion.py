"""`sinew.read_motion`, `sinew.read_cloud` and `sinew.simulate_stereo`."""

import json
import pickle

import numpy as np
import pytest

import sinew

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 20 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.05
0 90 0 0 0 0 0 0 0
5 90 0 90 0 0 0 0 0
"""


@pytest.fixture()
def bvh(tmp_path):
    path = tmp_path / "short.bvh"
    path.write_text(BVH)
    return path


def test_a_bvh_has_joints_and_parents(bvh):
    motion = sinew.read_motion(bvh)
    assert motion.names == ["Hips", "Spine", "Spine_end"] and motion.parents == [-1, 0, 1]
    assert motion.rate_hz == pytest.approx(20.0) and len(motion) == 2
    assert motion.joints_m.shape == (2, 3, 3) and motion.joints_m.dtype == np.float32
    np.testing.assert_allclose(motion.joints_m[0], [[0, 0.9, 0], [0, 1.0, 0], [0, 1.2, 0]], atol=1e-6)
    np.testing.assert_allclose(motion.joint("Spine_end")[1], [-0.25, 0.9, 0], atol=1e-6)
    assert motion.up is None and not motion.is_on_skin and motion.notes == []
    turned = motion.in_camera_axes("y")
    np.testing.assert_array_equal(turned.joints_m, motion.joints_m * [1, -1, -1])
    np.testing.assert_array_equal(turned.in_camera_axes().joints_m, turned.joints_m)
    scaled = sinew.read_motion(bvh, metres_per_unit=1.0, rate_hz=50)
    assert scaled.rate_hz == 50.0 and scaled.joints_m[0, 0, 1] == 90.0
    assert pickle.loads(pickle.dumps(motion)).names == motion.names
    with pytest.raises(ValueError, match="`up` has to be given"):
        motion.in_camera_axes()
    with pytest.raises(ValueError, match="`up` has to be one of"):
        motion.in_camera_axes("up")
    with pytest.raises(KeyError, match="Spine_end"):
        motion.joint("Head")


def test_markers_may_be_missing(tmp_path):
    path = tmp_path / "markers.trc"
    head = "PathFileType\t4\t(X/Y/Z)\tm.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t2\t2\tmm\n"
    path.write_text(head + "Frame#\tTime\tA\t\t\tB\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
                    "1\t0.00\t1000\t0\t0\t1\t2\t3\n2\t0.01\t\t\t\t1\t2\t3\n")
    motion = sinew.read_motion(path)
    assert motion.names == ["A", "B"] and motion.parents is None and motion.rate_hz == 100.0
    np.testing.assert_allclose(motion.joint("A"), [[1, 0, 0], [np.nan] * 3])


def test_a_tracked_body_comes_back_from_its_files(tmp_path, command):
    folder, out = tmp_path / "scene", tmp_path / "run"
    command("simulate", "stereo", "--motion", "stick-wave", "--rate", 1, "--points", 300, "--out", folder)
    command("track", "body", folder, "--out", out)
    table = np.genfromtxt(out / "track.csv", delimiter=",", names=True)
    for name, tolerance in [("track.trc", 1e-5), ("track.bvh", 1e-4)]:
        motion = sinew.read_motion(out / name)
        assert motion.up == "y" and len(motion) == len(table)
        turned = motion.in_camera_axes()
        for joint in sinew.BODY_JOINT_NAMES:
            places = np.stack([table[f"{joint}_{axis}_m"] for axis in "xyz"], axis=1)
            np.testing.assert_allclose(turned.joint(joint), places, atol=tolerance)
    assert sinew.read_motion(out / "track.bvh").parents[0] == -1
    measured = sinew.BodyTracker(measures=out / "track.bvh").measures
    assert measured["thigh_m"] == pytest.approx(json.loads((folder / "body.json").read_text())["thigh_m"], abs=1e-3)


def test_motions_that_cannot_be_used(tmp_path, bvh):
    with pytest.raises(FileNotFoundError, match="missing.bvh"):
        sinew.read_motion(tmp_path / "missing.bvh")
    with pytest.raises(sinew.SinewError, match="short.dat.*no known kind"):
        sinew.read_motion(bvh.rename(tmp_path / "short.dat"))
    short = tmp_path / "cut.bvh"
    short.write_text(BVH.replace("Frames: 2", "Frames: 3"))
    with pytest.raises(sinew.SinewError, match="cut.bvh.*partial=True"):
        sinew.read_motion(short)
    motion = sinew.read_motion(short, partial=True)
    assert len(motion) == 2 and "2 of the 3 frames" in motion.notes[0]
    with pytest.raises(ValueError, match="`rate_hz`"):
        sinew.read_motion(short, rate_hz=0)
    with pytest.raises(ValueError, match="`metres_per_unit`"):
        sinew.read_motion(short, metres_per_unit=-1)
    lonely = tmp_path / "m.amc"
    lonely.write_text("1\n")
    with pytest.raises(sinew.SinewError, match="`skeleton`"):
        sinew.read_motion(lonely)


def test_clouds_of_every_format(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("x,y,z\n0.1,0.2,2.0\nnan,0,1\n0,0,0\n0,0,3\n")
    cloud = sinew.read_cloud(path)
    assert cloud.dtype == np.float32 and cloud.flags.c_contiguous
    np.testing.assert_array_equal(cloud, np.float32([[0.1, 0.2, 2.0], [0, 0, 3]]))
    empty = tmp_path / "e.ply"
    header = "ply\nformat ascii 1.0\nelement vertex 0\n"
    empty.write_text(header + "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n")
    assert sinew.read_cloud(empty).shape == (0, 3)
    with pytest.raises(FileNotFoundError, match="missing.ply"):
        sinew.read_cloud(tmp_path / "missing.ply")
    with pytest.raises(sinew.SinewError, match="a.txt.*no cloud"):
        sinew.read_cloud(path.rename(tmp_path / "a.txt"))
    broken = tmp_path / "b.pcd"
    broken.write_text("nonsense")
    with pytest.raises(sinew.SinewError, match="b.pcd"):
        sinew.read_cloud(broken)


def test_depth_images_are_clouds(tmp_path):
    image, camera = tmp_path / "d.pgm", tmp_path / "camera.json"
    image.write_bytes(b"P5\n3 2\n65535\n" + np.array([[0, 2000, 0], [0, 0, 4000]], ">u2").tobytes())
    camera.write_text('{"fx": 100, "fy": 100, "cx": 1, "cy": 0}')
    np.testing.assert_allclose(sinew.read_cloud(image, camera), [[0, 0, 2], [0.04, 0.04, 4]], rtol=1e-6)
    camera.write_text("{}")
    with pytest.raises(sinew.SinewError, match="camera.json.*fx, fy, cx and cy"):
        sinew.read_cloud(image, camera)


def test_scenes_are_the_commands(tmp_path, command):
    folder = tmp_path / "scene"
    options = ["--points", 300, "--rate", 1, "--seed", 5, "--outliers", 0.2, "--patches", 2, "--hide", "l_arm:1-3"]
    command("simulate", "stereo", "--motion", "stick-wave", *options, "--distance", 2.5, "--out", folder)
    made = sinew.simulate_stereo(
        rate_hz=1, points=300, seed=5, outliers=0.2, patches=2, hide=["l_arm:1-3"], distance_m=2.5
    )
    said = json.loads((folder / "run.json").read_text())
    assert len(made) == said["frames"] == 20
    for frame, cloud in enumerate(made.clouds):
        np.testing.assert_array_equal(cloud, sinew.read_cloud(folder / "points" / f"{frame:06}.ply"))
    assert made.measures == json.loads((folder / "body.json").read_text())
    pose = dict(zip(sinew.BODY_COORDINATE_NAMES, made.first_pose))
    assert pose == {name: np.float32(value) for name, value in json.loads((folder / "first_pose.json").read_text()).items()}
    assert made.camera == said["camera"] and made.floor_y_m == said["floor_y_m"] and made.rate_hz == said["rate_hz"]
    truth = np.genfromtxt(folder / "truth.csv", delimiter=",", skip_header=1)[:, 1:].reshape(20, -1, 3)
    np.testing.assert_allclose(made.joints_m, truth[:, :17], atol=0.6e-5)
    np.testing.assert_allclose(made.markers_m, truth[:, 17:], atol=0.6e-5)
    stick = np.genfromtxt(folder / "stick.csv", delimiter=",", skip_header=1)[:, 1:7].reshape(20, 2, 3)
    np.testing.assert_allclose(made.stick_m, stick, atol=0.6e-5)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"motion": "missing.bvh"}, None),
        ({"outliers": 2.0}, "`outliers` has to be from 0 to 1"),
        ({"points": 10**7}, "`points` has to be at most"),
        ({"points": -1}, "`points`"),
        ({"patches": 2**40}, "`patches`"),
        ({"rate_hz": 0}, "`rate_hz`"),
        ({"rate_hz": 5000}, "`rate_hz` has to be at most 1000"),
        ({"distance_m": 0.2}, "`distance_m` has to be from 1 to 20"),
        ({"heading_deg": 10.0}, "`heading_deg` are for motion files"),
        ({"between_s": (0, 1)}, "`between_s`.* are for motion files"),
        ({"between_s": (0, 1, 2)}, "`between_s`"),
        ({"part": "lower"}, "`part` has to be one of"),
        ({"hide": ["arm:1-2"]}, "`hide`.*l_arm:30-44"),
        ({"hide": "l_arm:1-2"}, "`hide` has to be a list"),
        ({"rate_hz": 1, "hide": ["l_arm:1-400"]}, "`hide` names frame 400; the last one is 19"),
        ({"seed": -1}, "`seed`"),
    ],
)
def test_wrong_options_are_named(options, words):
    kind = ValueError if words else FileNotFoundError
    with pytest.raises(kind, match=words or "missing.bvh"):
        sinew.simulate_stereo(**options)
