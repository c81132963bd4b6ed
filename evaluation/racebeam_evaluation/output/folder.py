"""The folder that a run writes: whole, or not at all."""

import os
import pathlib
import shutil
import tempfile
from collections.abc import Mapping

from ..errors import BadInput


def check_free(folder: pathlib.Path) -> None:
    """Raises BadInput unless `folder` can be made, or is empty."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise BadInput(f"{folder} is not empty; expected a new or an empty folder")
    if not folder.absolute().parent.is_dir():
        raise BadInput(
            f"{folder.absolute().parent} is not a folder; expected the folder in which {folder.name} is made"
        )


def write(folder: pathlib.Path, files: Mapping[str, bytes | pathlib.Path]) -> None:
    """Writes all files, by their paths in `folder`: bytes, or copies of files. They are written elsewhere, and the
    folder is then renamed."""
    check_free(folder)
    try:
        with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.absolute().parent) as made:
            aside = pathlib.Path(made) / "whole"
            for name, content in files.items():
                (aside / name).parent.mkdir(parents=True, exist_ok=True)
                if isinstance(content, bytes):
                    (aside / name).write_bytes(content)
                else:
                    shutil.copyfile(content, aside / name, follow_symlinks=False)
            os.replace(aside, folder)
    except OSError as error:
        raise BadInput(
            f"{folder} cannot be written: {error.strerror}; expected a folder with room for the report"
        ) from error
