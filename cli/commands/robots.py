"""The options that are about robots."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

_Command = TypeVar("_Command", bound=Callable[..., Any])

# In the order of the fields of `posing.Posing`.
POSE_OPTIONS = ("pose", "state", "sample", "seed")


def _packages(_: click.Context, __: click.Parameter, given: tuple[str, ...]) -> dict[str, Path]:
    found: dict[str, Path] = {}
    for text in given:
        name, _equals, folder = text.partition("=")
        if not name or not folder:
            raise click.BadParameter(f"{text!r} should be NAME=DIR")
        if not Path(folder).is_dir():
            raise click.BadParameter(f"{folder!r} is no folder")
        found[name] = Path(folder)
    return found


package_option = click.option(
    "--package",
    "packages",
    multiple=True,
    metavar="NAME=DIR",
    callback=_packages,
    help="The folder of the ROS package NAME that a URDF names; NAME can also be a folder in a "
    "package (arm/meshes). Repeatable.",
)


def pose_options(command: _Command) -> _Command:
    """Adds them all; first here, first in the help."""
    for option in reversed(
        (
            click.option(
                "--pose",
                multiple=True,
                metavar="FILE",
                help='Values of joints, {"joint": value}: a JSON file, or the text; radians, '
                "metres. Several poses, or a list of them, are checked one by one. Joints that are "
                "not named are at 0, or at the limit nearest to 0.",
            ),
            click.option(
                "--state",
                multiple=True,
                metavar="NAME",
                help="A state that the SRDF names. Several are combined; --pose overrides them.",
            ),
            click.option(
                "--sample",
                type=click.IntRange(min=1),
                metavar="N",
                help="Check N random poses within the limits; joints in --pose and --state stay.",
            ),
            click.option(
                "--seed",
                type=click.IntRange(min=0),
                metavar="N",
                help="Which random poses: the same seed draws the same poses.  [default: 0]",
            ),
        )
    ):
        command = option(command)
    return command
