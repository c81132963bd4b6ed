"""Servers as jobs of a scheduler, by submitit (pip install "racebeam[slurm]").

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

__all__ = ["SlurmServers"]

PATIENCE = 10  # seconds for servers to end


class SlurmServers:
    """An array job of n servers, for the time of a `with`, which gives their addresses. racebeam.connect() and
    AtariVectorEnv(server=...) take these. They wait for their server, `wait` seconds at most.

    image: a cartridge image, or a folder of them, which the servers load; None: clients send the images of the games that they
        play. options: of `racebeam serve`. folder: for announce files and logs, where all nodes see it; a folder of its own is
        made in it and removed at the end. listen: what the servers listen on.
    executor: one of submitit, whose logs stay; None: submitit.AutoExecutor, which asks Slurm, or runs the jobs here where
        there is none.
    parameters: what its update_parameters() takes, such as slurm_partition or timeout_min.

    Raises ImportError without submitit; InvalidInput for what cannot be.
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
        self._options = [*_options_of(image), *options, "--listen", listen]
        self._executor, self._parameters = executor, parameters
        self._own: pathlib.Path | None = None
        self.jobs: list[Any] = []  # of submitit, in the order of the addresses

    def __enter__(self) -> list[str]:
        submitit = _submitit()
        self._own = pathlib.Path(tempfile.mkdtemp(prefix="racebeam-servers-", dir=self._folder))
        try:
            executor = self._executor or submitit.AutoExecutor(folder=self._own / "%j")
            executor.update_parameters(**{"name": "racebeam-servers", **self._parameters})
            announced = [str(self._own / f"server-{number}") for number in range(self._count)]
            self.jobs = executor.map_array(_serve, [[*self._options, "--announce", file] for file in announced])
        except BaseException:
            self._end()
            raise
        return [f"file:{file}?wait={self._wait:g}" for file in announced]

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    def _end(self) -> None:
        for job in self.jobs:
            job.cancel(check=False)
        self.jobs = []
        until = time.monotonic() + PATIENCE
        while self._own is not None and self._own.exists() and time.monotonic() < until:
            shutil.rmtree(self._own, ignore_errors=True)  # not while a job makes a file there
            time.sleep(0.05)


def _submitit() -> Any:
    try:
        return importlib.import_module("submitit")
    except ImportError:
        raise ImportError('racebeam.cluster needs submitit; install it with: pip install "racebeam[slurm]"') from None


def _options_of(image: str | os.PathLike[str] | None) -> list[str]:
    if image is None:
        return []
    place = pathlib.Path(image).resolve()
    if not place.exists():
        raise InvalidInput(f"image is {os.fspath(image)!r}, which is not there")
    return ["--roms", str(place if place.is_dir() else place.parent)]


def _serve(options: Sequence[str]) -> None:
    """The job: becomes the server, so that the scheduler's signals reach it."""
    server = program.path()
    os.execv(server, [server, "serve", *options])
