"""Processes that are forked from one that has computed."""

import multiprocessing
import os
import pickle

import pytest

import sinew

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="the system does not fork"),
    pytest.mark.filterwarnings("ignore:This process"),
]


def forked(work):
    """What `work` returns or raises in a forked process."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)

    def send():
        try:
            sender.send(work())
        except Exception as error:
            sender.send(error)

    process = context.Process(target=send)
    process.start()
    try:
        assert receiver.poll(60.0), "the forked process hangs"
        return receiver.recv()
    finally:
        process.kill()
        process.join()


def test_a_recording_is_tracked_in_forked_processes(walk):
    def cadence():
        return sinew.track_cyclic(walk).cadence_per_min

    wanted = cadence()
    assert forked(cadence) == wanted
    assert forked(lambda: (cadence(), forked(cadence))) == (wanted, wanted)
    assert cadence() == wanted


def test_bodies_are_tracked_in_forked_processes():
    scene = sinew.simulate_stereo(rate_hz=4.0, points=300)

    def tracker(frames):
        made = sinew.BodyTracker(rate_hz=4.0, particles=12, measures=scene.measures)
        for cloud in scene.clouds[:frames]:
            made.update(cloud)
        return made

    def after_the_third(tracker):
        tracker.update(scene.clouds[2])
        return tracker.state_crc32

    wanted, begun = tracker(3).state_crc32, tracker(2)
    assert forked(lambda: tracker(3).state_crc32) == wanted
    assert forked(lambda: after_the_third(begun)) == wanted, "a tracker that the other process began"
    assert after_the_third(begun) == wanted


def test_an_arm_tracker_in_use_belongs_to_its_process():
    frames = sinew.simulate_arm(frames=3).frames

    def of_all(tracker):
        return [tracker.update(image).status for image in frames]

    made, in_use = sinew.ArmTracker(), sinew.ArmTracker()
    wanted = of_all(in_use)
    assert forked(lambda: of_all(made)) == wanted
    for use in (lambda: in_use.update(frames[0]), lambda: in_use.state_crc32, lambda: pickle.dumps(in_use)):
        error = forked(use)
        assert isinstance(error, ValueError) and "pickle it" in str(error), error
    text = pickle.dumps(in_use)
    assert forked(lambda: pickle.loads(text).frame) == 2
