"""Starts servers as jobs of a scheduler, by submitit (pip install "submitit>=1.5").

Examples:
    with SlurmServers(n=32, image="/shared/atari", slurm_partition="cpu") as addresses:
        envs = racebeam.AtariVectorEnv("breakout", 1024, server=addresses)
"""

from __future__ import annotations

import importlib
import os
import pathlib
import shutil
import tempfile
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any

from . import program
from .errors import InvalidInput
from .extras import install_hint

__all__ = ["SlurmServers"]

PATIENCE = 10  # seconds for servers to end


class SlurmServers:
    """An array job of servers that lasts as long as a `with` block.

    The block receives the addresses of the servers, for `racebeam.connect` and `AtariVectorEnv(server=...)`. An address
    waits for its server, so that the job may start later.

    Args:
        n: Number of servers, at least 1.
        image: A cartridge image, or a folder of images, that the servers load. Default: clients send the images of the
            games that they play.
        options: Further options of `racebeam serve`.
        folder: Folder that all nodes see, for announce files and logs. A subfolder is made in it, and removed at the
            end.
        listen: Address on which each server listens.
        wait: Seconds that an address waits for its server.
        executor: An executor of submitit, whose logs stay. Default: submitit.AutoExecutor, which uses Slurm, or runs
            the jobs on this computer if it lacks Slurm.
        **parameters: Parameters of the executor's update_parameters(), such as `slurm_partition` or `timeout_min`.

    Attributes:
        jobs: The jobs of submitit, in the order of the addresses.

    Raises:
        InvalidInput: If `n` or `image` is wrong.
        ImportError: When the block begins, if submitit is not installed.

    Examples:
        >>> from racebeam.cluster import SlurmServers
        >>> SlurmServers(n=0)
        Traceback (most recent call last):
        racebeam._core.InvalidInput: n is 0; it takes 1 or more servers
    """

    def __init__(
        self,
        n: int,
        image: str | os.PathLike[str] | None = None,
        *,
        options: Sequence[str] = (),
        folder: str | os.PathLike[str] = ".",
        listen: str = "tcp://0.0.0.0:0",
        wait: float = 300,
        executor: Any = None,
        **parameters: Any,
    ) -> None:
        if not isinstance(n, int) or n < 1:
            raise InvalidInput(f"n is {n!r}; it takes 1 or more servers")
        self._count, self._wait, self._folder = n, wait, pathlib.Path(folder).resolve()
        self._options = [*_image_options(image), *options, "--listen", listen]
        self._executor, self._parameters = executor, parameters
        self._subfolder: pathlib.Path | None = None
        self.jobs: list[Any] = []

    def __enter__(self) -> list[str]:
        submitit = _import_submitit()
        self._subfolder = pathlib.Path(tempfile.mkdtemp(prefix="racebeam-servers-", dir=self._folder))
        try:
            executor = self._executor or submitit.AutoExecutor(folder=self._subfolder / "%j")
            executor.update_parameters(**{"name": "racebeam-servers", **self._parameters})
            announcements = [str(self._subfolder / f"server-{number}") for number in range(self._count)]
            self.jobs = executor.map_array(_serve, [[*self._options, "--announce", file] for file in announcements])
        except BaseException:
            self._end()
            raise
        return [f"file:{file}?wait={self._wait:g}" for file in announcements]

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    def _end(self) -> None:
        for job in self.jobs:
            job.cancel(check=False)
        self.jobs = []
        until = time.monotonic() + PATIENCE
        while self._subfolder is not None and self._subfolder.exists() and time.monotonic() < until:
            shutil.rmtree(self._subfolder, ignore_errors=True)  # fails while a job makes a file there
            time.sleep(0.05)


def _import_submitit() -> Any:
    try:
        return importlib.import_module("submitit")
    except ImportError:
        raise ImportError(f"racebeam.cluster needs submitit; {install_hint('submitit')}") from None


def _image_options(image: str | os.PathLike[str] | None) -> list[str]:
    if image is None:
        return []
    place = pathlib.Path(image).resolve()
    if not place.exists():
        raise InvalidInput(f"image is {os.fspath(image)!r}, which does not exist")
    return ["--roms", str(place if place.is_dir() else place.parent)]


def _serve(options: Sequence[str]) -> None:
    """Runs a job: becomes the server, so that the scheduler's signals reach it."""
    server = program.path()
    os.execv(server, [server, "serve", *options])
