"""The folders of packages and models that environment variables of ROS and Gazebo name."""

from __future__ import annotations

import os
from pathlib import Path

# With folders that hold packages, models or files.
_VARIABLES = (
    "ROS_PACKAGE_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
)
_AMENT = "AMENT_PREFIX_PATH"  # the packages are in `share` of its folders


def search_path() -> tuple[str, ...]:
    """The values of these variables."""
    return tuple(os.environ.get(name, "") for name in (_AMENT, *_VARIABLES))


def folders_of_environment() -> list[Path]:
    ament, *others = (text.split(os.pathsep) for text in search_path())
    plain = [Path(entry) for entries in others for entry in entries if entry]
    return plain + [Path(entry) / "share" for entry in ament if entry]
