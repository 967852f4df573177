"""Motion models."""

from __future__ import annotations

import os
from typing import Any

from . import _sinew
from ._arrays import FloatArray, is_path


def models() -> list[str]:
    """Names of the motion models that are part of the package."""
    return _sinew.models()


class Model:
    """A model of a cyclic motion.

    Parameters
    ----------
    name : str or path
        A name of :func:`models`, or a file that ``sinew train cyclic`` wrote. The file is read
        once; a distinct model stays in memory as long as the process.

    Raises
    ------
    SinewError
        The name is unknown, or the file is no model.
    FileNotFoundError
        There is no such file.
    """

    __slots__ = ("_native",)

    def __init__(self, name: str | os.PathLike[str] = "walking") -> None:
        if not is_path(name):
            raise ValueError(f"`model` has to be a name or a path, not {type(name).__name__}")
        self._native = _sinew.Model(os.fspath(name))

    @property
    def name(self) -> str:
        """Name or path of the model."""
        return self._native.name

    @property
    def rate_hz(self) -> float:
        """Frames per second of its training data; recordings may have any other rate."""
        return self._native.rate_hz

    @property
    def mean_cycle_rad(self) -> FloatArray:
        """Mean angles over the cycle, (100, 13) radians; (100, 26) for a motion in space."""
        return self._native.mean_cycle_rad

    @property
    def cadence_per_min(self) -> float:
        """Mean cycles per minute of those whom it was trained on."""
        return self._native.cadence_per_min

    @property
    def trained_cycles(self) -> int:
        """Number of cycles that it was trained on."""
        return self._native.trained_cycles

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as ``sinew train cyclic`` does; the command and firmware take the file."""
        self._native.save(path)

    def __repr__(self) -> str:
        return f"Model({self.name!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_json, (self.name, self._native.to_json())


def trained(native: _sinew.Model) -> Model:
    """A model of the extension."""
    model = Model.__new__(Model)
    model._native = native
    return model


def _from_json(name: str, text: str) -> Model:
    return trained(_sinew.Model.from_json(name, text))


def native_model(model: Any) -> _sinew.Model:
    """The extension's model for a parameter `model`."""
    return (model if isinstance(model, Model) else Model(model))._native
