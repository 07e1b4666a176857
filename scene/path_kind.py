"""What is at a path, for names that a user gives.

`Path.is_dir` and its siblings raise OSError for a name that is too long, and for one in a folder
that may not be searched. These say no, and whatever reads or writes the path says why.
"""

import os.path
from pathlib import Path

is_folder = os.path.isdir
is_file = os.path.isfile
exists = os.path.exists


def followed(path: Path) -> Path:
    """The path without links. `Path.resolve` raises for a path that leads in a circle, and for one
    that no system accepts. Here they stay as they are: they cannot be opened."""
    try:
        return Path(os.path.realpath(path))
    except ValueError:
        return path.absolute()
