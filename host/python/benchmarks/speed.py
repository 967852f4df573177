"""Times of the package, beside those of the command that SINEW names.

    SINEW=target/release/sinew python host/python/benchmarks/speed.py

Run it on a machine with two idle cores. `docs/python.md` has the numbers.
"""

import json
import os
import subprocess
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

import sinew


def best_s(work, times=7):
    """Shortest time of `work`, seconds."""
    taken = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        taken.append(time.perf_counter() - start)
    return min(taken)


def threads_gain(work):
    """How many times as much two threads do as one."""
    alone_s = best_s(work, 3)

    def both():
        threads = [threading.Thread(target=work) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    return 2.0 * alone_s / best_s(both, 3)


def show(name, value, unit, asked=""):
    print(f"| {name} | {value:.3g} {unit} | {asked} |")


def cyclic():
    rng = np.random.default_rng(1)
    filmed = sinew.simulate_keypoints(seconds=850 / 30, seed=1)
    walk = sinew.angles(filmed.keypoints, layout=filmed.layout, fps=30.0)
    tracker, rows = sinew.CyclicTracker(rate_hz=30.0), rng.permutation(walk.angles_rad)
    show("a call of `CyclicTracker.update`", 1e3 * best_s(lambda: [tracker.update(row) for row in rows]) / len(rows), "ms", "0.3")
    array, rate_hz = np.array(walk), walk.rate_hz
    online_s = best_s(lambda: sinew.track_cyclic(array, rate_hz=rate_hz, smooth=False), 50)
    show("`track_cyclic`, 850 frames, `smooth=False`", 1e3 * online_s, "ms", "4")
    show("`track_cyclic`, 850 frames", 1e3 * best_s(lambda: sinew.track_cyclic(array, rate_hz=rate_hz)), "ms", "")

    def many():
        for _ in range(100):
            sinew.track_cyclic(array, rate_hz=rate_hz, smooth=False)

    show("`track_cyclic`: two threads over one", threads_gain(many), "times", "1.8")


def arms(folder):
    scene = folder / "scene"
    run("simulate", "arm", "--motion", "builtin", "--frames", 100, "--out", scene)
    frames = [sinew.read_image(path) for path in sorted((scene / "frames").iterdir())]
    config = scene / "camera.toml"

    def track(face=True):
        tracker = sinew.ArmTracker(config=config, face=face)
        for frame in frames:
            tracker.update(frame)

    mine_ms = 1e3 * best_s(track, 3) / len(frames)
    show("`ArmTracker.update`, 640x480", mine_ms, "ms", "")
    rates_hz = []
    for attempt in range(3):
        out = folder / f"arm{attempt}"
        run("track", "arm", scene / "frames", "--config", config, "--out", out)
        rates_hz.append(json.loads((out / "run.json").read_text())["frames_per_second"])
    show("the same above the command's time a frame", mine_ms - 1e3 / max(rates_hz), "ms", "0.5")
    # A face is looked for beside the tracker: one tracker alone keeps more than one core busy.
    show("`ArmTracker`: two threads over one", threads_gain(track), "times", "")
    gain = threads_gain(lambda: track(face=False))
    show("`ArmTracker`, no face looked for: two threads over one", gain, "times", "1.8")


def bodies():
    scene = sinew.simulate_stereo("stick-wave", points=2000)

    def track():
        tracker = sinew.BodyTracker(measures=scene.measures, first_pose=scene.first_pose, threads=1)
        for cloud in scene.clouds[:15]:
            tracker.update(cloud)

    show("`BodyTracker.update`, 2000 points, one thread", 1e3 * best_s(track, 3) / 15, "ms", "")
    show("`BodyTracker`: two threads over one", threads_gain(track), "times", "1.8")


def recordings(folder, count=500):
    table = folder / "recordings"
    table.mkdir()
    for seed in range(20):
        filmed = sinew.simulate_keypoints(seconds=850 / 30, seed=seed)
        sinew.angles(filmed.keypoints, layout=filmed.layout, fps=30.0).save(table / f"{seed}.csv")
    # Seeds of the filter make them differ, so that none is done once for another.
    rows = [{"id": f"{i}", "input": f"recordings/{i % 20}.csv", "seed": str(i)} for i in range(count)]
    with open(folder / "list.jsonl", "w") as manifest:
        manifest.writelines(json.dumps(row) + "\n" for row in rows)
    start = time.perf_counter()
    run("batch", folder / "list.jsonl", "--out", folder / "of_command")
    show(f"`sinew batch`, {count} recordings of 850 frames", time.perf_counter() - start, "s", "5")
    for engine in ("local", "ray"):
        try:
            start = time.perf_counter()
            sinew.batch(folder / "list.jsonl", folder / engine, engine=engine)
            show(f"`sinew.batch`, engine {engine}", time.perf_counter() - start, "s", "")
        except ImportError as error:
            print(f"| left out: {error} | | |")


def run(*arguments):
    program = os.environ.get("SINEW", "sinew")
    subprocess.run([program, *map(str, arguments), "-q"], check=True, capture_output=True)


if __name__ == "__main__":
    print("| what | took | asked |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        cyclic()
        arms(Path(name))
        bodies()
        recordings(Path(name))
