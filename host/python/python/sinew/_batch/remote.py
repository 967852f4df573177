"""Results in a store that pyarrow opens by its URL."""

from __future__ import annotations

import os
from typing import Any


class Remote:
    """A folder of a store.

    Parameters
    ----------
    url : str
        Such as ``s3://bucket/folder``.
    """

    def __init__(self, url: str) -> None:
        try:
            import pyarrow
            import pyarrow.fs
        except ImportError as error:
            raise ImportError("a URL as `out` needs pyarrow: pip install pyarrow") from error
        try:
            self._store, self._folder = pyarrow.fs.FileSystem.from_uri(url)
        except (pyarrow.ArrowInvalid, pyarrow.ArrowNotImplementedError) as error:
            raise ValueError(f"`out`: {url} is no folder that pyarrow opens ({error})") from None

    def _path(self, name: str) -> str:
        return f"{self._folder.rstrip('/')}/{name}"

    def get(self, name: str) -> bytes | None:
        """Bytes of a file, None where there is none."""
        try:
            with self._store.open_input_stream(self._path(name)) as file:
                content: bytes = file.read()
                return content
        except FileNotFoundError:
            return None

    def put(self, name: str, content: bytes) -> None:
        """Write a file.

        Raises
        ------
        OSError
            The store refuses it.
        """
        path = self._path(name)
        # Stores of objects have no folders, and make none.
        self._store.create_dir(path.rsplit("/", 1)[0], recursive=True)
        with self._store.open_output_stream(path) as file:
            file.write(content)

    def put_result(self, folder: str, name: str) -> None:
        """Write all files of a result; its record comes last, and makes it count."""
        files = [os.path.join(at, file) for at, _, found in os.walk(folder) for file in found]
        files.sort(key=lambda file: (os.path.relpath(file, folder) == "job.json", file))
        for file in files:
            with open(file, "rb") as content:
                self.put(f"{name}/{os.path.relpath(file, folder).replace(os.sep, '/')}", content.read())

    def forget(self, name: str) -> None:
        """Remove a file if it is there."""
        try:
            self._store.delete_file(self._path(name))
        except FileNotFoundError:
            pass

    def __reduce__(self) -> Any:
        raise TypeError("a store is opened where it is used")
