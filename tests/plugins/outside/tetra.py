"""A package outside of satcheck: it brings a format of meshes, one of reports, and a command."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import click
from msgspec import Meta

from satcheck.cli.commands import Plugin
from satcheck.cli.formats.registry import Format, Reports
from satcheck.scene import Refused
from satcheck.scene.document import Document, RawMesh, alone
from satcheck.scene.files.readers import File, Option, Reader

SCALE = Option("tetra_scale", Annotated[float, Meta(gt=0)], "the factor of all corners", 1.0)
READER = Reader("tetra", "TETRA", (".tetra",), "tetra:read", options=(SCALE,), text="plain")
FORMAT = Format("verdicts", (".verdicts",), "tetra:render")
COMMAND = Plugin("corners", "Count the corners of a tetrahedron.", "tetra:command")

_FACES = (0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3)


def read(file: File) -> Document:
    """Return the tetrahedron of a file: a line for each corner, three numbers each."""
    try:
        scale = file.options[SCALE.name]
        words = bytes(file.data).split()
        corners = [scale * float(word) for word in words]
        points = struct.pack("<12d", *corners)
    except (ValueError, struct.error) as error:
        raise Refused("bad-record", f"not four corners: {error}") from error
    triangles = struct.pack("<12I", *_FACES)
    decimals = max(len(word.partition(b".")[2]) for word in words)
    return alone(RawMesh(points, triangles, "written-digits", units="mm", decimals=decimals))


def render(reports: Reports) -> Iterable[str]:
    """Yield a line for each report."""
    for name, report in reports.items():
        yield f"{name}: {report.summary.verdict}\n"


@click.command("corners")
@click.argument("path")
def command(path: str) -> int:
    """Count the corners of a tetrahedron."""
    click.echo(sum(1 for line in Path(path).read_text().splitlines() if line.strip()))
    return 0
