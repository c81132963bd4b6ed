"""The files of this tree that tests of documents read."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_OURS = {"build", "__pycache__", "node_modules"}  # and all that begin with a dot, but .github and .ci


def files(root=ROOT):
    """Paths of all files below `root`, relative to it, in order, without those of builds, environments and
    git."""
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [
            name
            for name in folders
            if name not in NOT_OURS and (not name.startswith(".") or name in (".github", ".ci"))
        ]
        found += [(pathlib.Path(folder) / name).relative_to(root) for name in names]
    return sorted(found)


def documents(root=ROOT):
    return [path for path in files(root) if path.suffix == ".md"]
