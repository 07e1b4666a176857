"""The two environments that are compared: a commit becomes one, an existing one is taken as it is.

A commit is built once, with `pip install` from its files, and kept in build/compare/COMMIT. The
benches need no extra of satcheck.
"""

from __future__ import annotations

import fcntl
import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STORE = ROOT / "build" / "compare"
WORKING_TREE = "."
BUILT = "built"
TAIL = 25  # lines of the output of a failing build


class CannotCompare(Exception):
    """An argument names nothing that can be measured, or its build fails."""


@dataclass(frozen=True, slots=True)
class Side:
    """An environment with satcheck. name: as the user wrote it."""

    name: str
    python: Path

    @property
    def satcheck(self) -> Path:
        return self.python.with_name("satcheck")


def side_of(name: str, store: Path = STORE) -> Side:
    """The environment of a commit, of the working tree ("."), or of a folder or Python that exists.

    Raises CannotCompare.
    """
    place = Path(name).absolute()  # not resolved: the Python of an environment is a link
    for python in (place, place / "bin" / "python"):
        if python.is_file():
            side = Side(name, python)
            if not side.satcheck.is_file():
                raise CannotCompare(f"{name}: there is no {side.satcheck}")
            return side
    tree = working_tree() if name == WORKING_TREE else commit_of(name)
    return Side(name, built(tree, store))


def commit_of(name: str) -> str:
    """The full hash. Raises CannotCompare where git knows no such commit."""
    words = ["rev-parse", "--verify", "--quiet", "--end-of-options", f"{name}^{{commit}}"]
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CannotCompare(f"{name}: neither a commit nor an environment")
    return done.stdout.strip()


def working_tree() -> str:
    """The hash of a git tree of all files that git does not ignore, new ones included."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "GIT_INDEX_FILE": str(Path(folder) / "index")}
        subprocess.run(["git", "add", "--all"], cwd=ROOT, env=environment, check=True)
        words = ["git", "write-tree"]
        done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, check=True)
    return done.stdout.decode().strip()


def built(tree: str, store: Path) -> Path:
    """The Python of an environment with these files of git installed. Raises CannotCompare."""
    store.mkdir(parents=True, exist_ok=True)
    folder = store / tree[:12]
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # another comparison may be building it
        if not (folder / BUILT).exists():
            _build(tree, folder)
    return folder / "venv" / "bin" / "python"


def _build(tree: str, folder: Path) -> None:
    source, environment = folder / "source", folder / "venv"
    shutil.rmtree(folder, ignore_errors=True)
    source.mkdir(parents=True)
    sys.stderr.write(f"building {tree[:12]} in {folder}: this takes some minutes\n")
    words = ["git", "archive", "--format=tar", tree]
    archive = subprocess.run(words, cwd=ROOT, capture_output=True, check=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        tar.extractall(source, filter="data")
    for step in (
        [sys.executable, "-m", "venv", str(environment)],
        [str(environment / "bin" / "python"), "-m", "pip", "install", str(source)],
    ):
        done = subprocess.run(
            step, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
        )
        if done.returncode:
            tail = "\n".join(done.stdout.splitlines()[-TAIL:])
            raise CannotCompare(f"{tree[:12]} cannot be built:\n{' '.join(step)}\n{tail}")
    shutil.rmtree(source)
    (folder / BUILT).touch()
