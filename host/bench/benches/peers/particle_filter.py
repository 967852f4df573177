"""One step of a particle filter over 28 states with numpy and with the package `particles`, as their users write it.

The task: 13 angles with their velocities, a position in a cycle and its velocity; accelerations with a mean that depends on the
position, interpolated, and correlated normal noise of 13 x 13 (one covariance for the whole cycle); all angles measured;
weighted means; systematic resampling in every frame. 14 normals a particle are drawn inside of the step.

    python3 particle_filter.py [PARTICLES] [FRAMES]

prints `name median_ms minimum_ms`, one line each. Needs numpy; `particles` (pip install particles) is left out where it is missing.
"""

import sys
import time

import numpy as np

ANGLES, POSITIONS = 13, 100
STATES = 2 * ANGLES + 2
SIGMA_RAD = 0.506
TEMPORAL_STD = 1e-4
TAU = 2.0 * np.pi


def motion(kind):
    """Mean accelerations, the Cholesky factor of their noise and mean poses of a made-up cycle."""
    phase = TAU * (np.arange(POSITIONS)[:, None] / POSITIONS + 0.07 * np.arange(ANGLES))
    swing = 0.1 + 0.05 * np.arange(ANGLES)
    pose = swing * np.sin(phase)
    acceleration = -swing * (TAU / POSITIONS) ** 2 * np.sin(phase)
    random = np.random.default_rng(1).standard_normal((ANGLES, ANGLES))
    covariance = 1e-6 * (random @ random.T / ANGLES + np.eye(ANGLES))
    return [table.astype(kind) for table in (acceleration, np.linalg.cholesky(covariance), pose)]


class NumpyFilter:
    """Vectorised over the particles, single precision. Without `circular` angles are plain numbers."""

    def __init__(self, count, circular):
        self.acceleration, self.factor, self.pose = motion(np.float32)
        self.random = np.random.default_rng(2)
        self.count, self.circular = count, circular
        self.angles = np.tile(self.pose[0], (count, 1))
        self.velocities = np.zeros((count, ANGLES), np.float32)
        self.position = np.zeros(count, np.float32)
        self.velocity = np.full(count, 1.0 / 65.0, np.float32)

    def step(self, measured):
        normals = self.random.standard_normal((self.count, ANGLES + 1), dtype=np.float32)
        along = self.position * np.float32(POSITIONS)
        before = along.astype(np.int32)
        part = (along - before)[:, None]
        ratio = (self.velocity * np.float32(POSITIONS))[:, None]
        low = self.acceleration[before % POSITIONS]
        mean = low + part * (self.acceleration[(before + 1) % POSITIONS] - low)
        acceleration = ratio * ratio * (mean + normals[:, :ANGLES] @ self.factor.T)
        self.angles += self.velocities + np.float32(0.5) * acceleration
        self.velocities += acceleration
        temporal = np.float32(TEMPORAL_STD) * normals[:, ANGLES]
        self.position = (self.position + self.velocity + np.float32(0.5) * temporal) % np.float32(1.0)
        self.velocity += temporal
        difference = measured - self.angles
        if self.circular:
            turn = np.float32(TAU)
            self.angles -= turn * np.rint(self.angles / turn)
            difference -= turn * np.rint(difference / turn)
        log_weights = np.float32(-0.5 / SIGMA_RAD**2) * np.einsum("ij,ij->i", difference, difference)
        weights = np.exp(log_weights - log_weights.max())
        weights /= weights.sum()
        if self.circular:
            estimate = np.arctan2(weights @ np.sin(self.angles), weights @ np.cos(self.angles))
        else:
            estimate = weights @ self.angles
        places = (self.random.random() + np.arange(self.count)) / self.count
        chosen = np.minimum(np.searchsorted(np.cumsum(weights, dtype=np.float64), places), self.count - 1)
        self.angles, self.velocities = self.angles[chosen], self.velocities[chosen]
        self.position, self.velocity = self.position[chosen], self.velocity[chosen]
        return estimate


def numpy_times(count, frames, circular):
    own = NumpyFilter(count, circular)
    times = []
    for frame in range(frames):
        measured = own.pose[frame * POSITIONS // 65 % POSITIONS]
        start = time.perf_counter()
        estimate = own.step(measured)
        times.append(time.perf_counter() - start)
    assert np.abs(estimate - measured).max() < 1.0, "the filter lost the motion"
    return times


def particles_times(count, frames):
    """The package's bootstrap filter; its normal distribution draws all 28 states."""
    import particles
    from particles import distributions as dists
    from particles import state_space_models as ssm

    acceleration, factor, pose = motion(np.float64)
    kinematics = np.zeros((STATES, ANGLES + 1))
    kinematics[:ANGLES, :ANGLES], kinematics[ANGLES : 2 * ANGLES, :ANGLES] = 0.5 * factor, factor
    kinematics[2 * ANGLES :, ANGLES] = 0.5 * TEMPORAL_STD, TEMPORAL_STD
    noise = kinematics @ kinematics.T + 1e-12 * np.eye(STATES)

    class Motion(ssm.StateSpaceModel):
        def PX0(self):
            first = np.concatenate([pose[0], np.zeros(ANGLES + 1), [1.0 / 65.0]])
            return dists.MvNormal(loc=first, cov=1e-6 * np.eye(STATES))

        def PX(self, t, xp):
            along = xp[:, 2 * ANGLES] % 1.0 * POSITIONS
            before = along.astype(np.int32)
            part = (along - before)[:, None]
            ratio = (xp[:, 2 * ANGLES + 1] * POSITIONS)[:, None]
            low = acceleration[before % POSITIONS]
            mean = ratio * ratio * (low + part * (acceleration[(before + 1) % POSITIONS] - low))
            to = xp.copy()
            to[:, :ANGLES] += xp[:, ANGLES : 2 * ANGLES] + 0.5 * mean
            to[:, ANGLES : 2 * ANGLES] += mean
            to[:, 2 * ANGLES] += xp[:, 2 * ANGLES + 1]
            return dists.MvNormal(loc=to, cov=noise)

        def PY(self, t, xp, x):
            return dists.MvNormal(loc=x[:, :ANGLES], cov=SIGMA_RAD**2 * np.eye(ANGLES))

    data = [pose[frame * POSITIONS // 65 % POSITIONS][None, :] for frame in range(frames)]
    smc = particles.SMC(fk=ssm.Bootstrap(ssm=Motion(), data=data), N=count, resampling="systematic", ESSrmin=1.0)
    times = []
    for _ in range(frames):
        start = time.perf_counter()
        next(smc)
        np.average(smc.X, weights=smc.W, axis=0)
        times.append(time.perf_counter() - start)
    return times


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    frames = int(sys.argv[2]) if len(sys.argv) > 2 else 30
    runs = {
        f"numpy-{np.__version__}": lambda: numpy_times(count, frames, True),
        f"numpy-{np.__version__}-linear": lambda: numpy_times(count, frames, False),
    }
    try:
        from importlib.metadata import version

        runs[f"particles-{version('particles')}"] = lambda: particles_times(count, frames)
    except ImportError:
        print("`particles` is left out: it is not installed", file=sys.stderr)
    for name, run in runs.items():
        times = sorted(run()[2:])
        print(f"{name} {1e3 * times[len(times) // 2]:.2f} {1e3 * times[0]:.2f}", flush=True)


if __name__ == "__main__":
    main()
