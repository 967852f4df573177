"""What tests share: a made-up walk, and the command `sinew` where SINEW names it."""

import json
import os
import signal
import subprocess

import pytest

import sinew

# A shell's job in the background ignores Ctrl-C, and so would the programs that tests start.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def keypoints():
    """Six seconds of a walker with gaps."""
    return sinew.simulate_keypoints(seconds=6.0, missing=0.05, seed=3)


@pytest.fixture(scope="session")
def walk(keypoints):
    """Angles of the walker."""
    return sinew.angles(keypoints.keypoints, layout=keypoints.layout, fps=keypoints.rate_hz)


@pytest.fixture(scope="session")
def command():
    """Runs the command with --json and returns what it prints."""
    program = os.environ.get("SINEW")
    if not program:
        pytest.skip("SINEW does not name the command `sinew`: nothing to compare with")

    def run(*arguments):
        words = [program, *map(str, arguments), "--json"]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    return run
