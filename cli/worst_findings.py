"""The worst findings of a batch, with their pictures."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from msgspec.structs import replace

from satcheck.audit.batch.key import digest
from satcheck.audit.batch.stored import Stored
from satcheck.audit.words import is_wrong, rank
from satcheck.cli.formats.assets import worst_of
from satcheck.cli.output import cannot_write, harmless, talk, write_file
from satcheck.cli.progress import counting
from satcheck.cli.stated_scene import stated_scene
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset
from satcheck.report.report import Finding, Report

# A larger scene is drawn without its other bodies.
MOST_BODIES = 100
# A picture, PNG, or why there is none.
Picture = bytes | str
SIZE = (600, 450)
_DIGESTS = 10_000
_UNSAFE = re.compile(r"[^A-Za-z0-9]+")
_LONGEST_NAME = 80


class Drawing(NamedTuple):
    """How a gallery shows its worst findings. root: where the paths in the reports start. folder:
    of a PNG of each. top: how many. undrawn: why none has a picture."""

    root: Path = Path()
    folder: Path | None = None
    allow_outside: bool = False
    top: int = 100
    undrawn: str = ""


class Worst(NamedTuple):
    finding: Finding
    stored: Stored


# The asset, its finding and the picture of it.
Illustrated = tuple[Asset, Finding, Picture]


def worst_findings(results: Iterable[Stored], top: int) -> list[Worst]:
    """Return the worst finding of each asset that fails, warns or is open, the worst first, at most
    `top`. Holds the reports of as many."""
    findings = (
        Worst(min(listed, key=rank), stored)
        for stored in results
        if (listed := [each for each in stored.asset.report.findings if is_wrong(each)])
    )
    return worst_of(findings, top, lambda each: rank(each.finding, each.stored.asset.report.units))


def with_pictures(worst: Sequence[Worst], drawing: Drawing) -> Iterator[Illustrated]:
    """Each is drawn when it is taken, and written into the folder."""
    now, folder = lru_cache(_DIGESTS)(digest), drawing.folder
    if folder is not None:
        _make(folder)
    for number, each in enumerate(counting(worst, "pictures", "drawing"), 1):
        picture = drawing.undrawn or _picture(each, drawing, now)
        if folder is not None:
            _write(folder / file_name(number, each), each, picture)
        yield each.stored.asset, each.finding, picture


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(str(folder), error.strerror) from None


def _write(path: Path, worst: Worst, picture: Picture) -> None:
    if isinstance(picture, bytes):
        write_file(path, picture)
        return
    pair = f"{worst.finding.a} and {worst.finding.b}"
    talk(harmless(f"satcheck: {worst.stored.asset.file}: no picture of {pair}: {picture}"))


def file_name(number: int, worst: Worst) -> str:
    """`001-scene-box-lid.png`: letters, digits and `-` alone, whatever the names are."""
    scene = Path(worst.stored.files[0]).stem
    words = _UNSAFE.sub("-", f"{scene} {worst.finding.a} {worst.finding.b}").strip("-")
    return f"{number:03}-{words[:_LONGEST_NAME].strip('-')}.png"


def _picture(worst: Worst, drawing: Drawing, now: Callable[[str], str | None]) -> Picture:
    for file in worst.stored.inputs:
        sha256 = now(os.path.join(drawing.root, file.path))  # noqa: PTH118  keeps a `/` at the end
        if sha256 != file.sha256:
            return f"{file.path} {'is not there' if sha256 is None else 'has changed'}"
    try:
        return _drawn(worst, drawing)
    except SatcheckError as error:
        return str(error)


def _drawn(worst: Worst, drawing: Drawing) -> Picture:
    from satcheck.cli.formats.picture.png import render
    from satcheck.cli.formats.picture.slabs import with_slabs

    report = _of_finding(worst)
    scene, issues = stated_scene(report, drawing.root, allow_outside=drawing.allow_outside)
    if issues:
        return issues[0].message
    if len(scene.bodies) < len(report.bodies):
        return "a body could not be read, or its mesh has no SHA-256"
    return render(report, with_slabs(scene), SIZE)


def _of_finding(worst: Worst) -> Report:
    report, finding = worst.stored.asset.report, worst.finding
    bodies = report.bodies
    if len(bodies) > MOST_BODIES:
        bodies = tuple(body for body in bodies if body.id in (finding.a, finding.b))
    return replace(report, findings=(finding,), bodies=bodies)
