"""`satcheck decompose MESH`."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import click
from msgspec import Struct
from msgspec.structs import astuple, replace

from satcheck.audit.summary import tool
from satcheck.audit.words import at_most, counted, duration, with_unit
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call, product_and_report
from satcheck.cli.formats.tables import Column, fitted_each, joined, table
from satcheck.cli.inputs import load, refuse_early
from satcheck.cli.output import Page, harmless, issue_line, talk, write_file
from satcheck.cli.progress import Bar
from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import HalfSpace, is_curved
from satcheck.core.steps import step
from satcheck.decompose import Cache, Decomposition, DecompositionError, decompose, user_cache
from satcheck.report.decomposition import (
    DecomposedBody,
    DecompositionOptions,
    DecompositionReport,
    Part,
    Remark,
)
from satcheck.report.report import Issue
from satcheck.scene import Body, Scene, written_meshes
from satcheck.scene.units import unit_of

_FILES = ", ".join(written_meshes.FORMATS)


class _Parts(Struct, frozen=True):
    """A body, and its convex parts in world coordinates or why there are none."""

    body: Body
    result: Decomposition | SatcheckError

    @property
    def has_parts(self) -> bool:
        return isinstance(self.result, Decomposition)

    def named(self) -> Iterator[written_meshes.Part]:
        if isinstance(self.result, Decomposition):
            for number, part in enumerate(self.result.parts, 1):
                yield f"{self.body.id}-{number}", part.to_mesh()


@click.command("decompose", cls=Command, context_settings=HELP_NAMES)
@option.paths("MESH")
@click.option(
    "--threshold",
    type=click.FloatRange(0, 1, min_open=True),
    metavar="RATIO",
    default=option.DEFAULTS.part_threshold,
    show_default=True,
    help="Split until parts are this close to convex, in CoACD's measure. A smaller one gives more "
    "parts, which fit better.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0, max=2**32 - 1),
    metavar="N",
    default=option.DEFAULTS.part_seed,
    show_default=True,
    help="The seed of CoACD's random search: the same seed gives the same parts.",
)
@form_option
@option.outputs(
    f"Write the parts to FILE ({_FILES}): a node of a GLB or an object of an OBJ file each; an STL "
    "file holds them all. Or the report (.json). Repeatable."
)
@scene_option.split
@scene_option.units
@scene_option.outside
@option.limits("body-seconds")
@scene_option.read
@option.common
def command(
    outputs: tuple[Path, ...],
    threshold: float,
    seed: int,
    form: str | None,
    **options: Any,
) -> int:
    """Split meshes into convex parts, for physics engines.

    MESH is a mesh file or a scene. Each body is split by CoACD. A body that is convex already is
    its own part. For each body the report gives upper bounds on how far the parts stick out of
    the mesh, and the mesh out of the parts. A mesh that is not closed is rebuilt from voxels
    first, which thickens it. The parts lie where the input places them.

    A cache keeps the parts: the folder `decompositions` below SATCHECK_CACHE_DIR, or else below
    ~/.cache/satcheck (macOS: ~/Library/Caches/satcheck, Windows: %LOCALAPPDATA%\\satcheck\\Cache).
    Delete the folder to clear the cache; SATCHECK_CACHE=off does without it.

    Exit codes: 0, every body has its parts; 2, wrong usage, an unreadable input, no parts at all,
    or an internal error; 3, some bodies have no parts.
    """
    parts_out, output = product_and_report(outputs, written_meshes.FORMATS, form)
    if not options["paths"]:
        raise click.UsageError("give a mesh file or a scene")
    inputs, form, document = plain_call(options, form, output)
    refuse_early(inputs, parts_out)
    seconds = inputs.limit["body-seconds"]
    scene = load(inputs, least=1)
    if parts_out is not None:
        scene.require_one_unit()
    if not scene.bodies and form == "table":
        return exit_codes.ERROR  # the error is told
    store = user_cache()
    bodies = []
    with Bar("bodies") as bar:
        for number, body in enumerate(scene.bodies, 1):
            with step(f"splitting {body.id}, {number} of {len(scene.bodies)}"):
                bodies.append(_Parts(body, _split(body, threshold, seed, seconds, store)))
            if bar is not None:
                bar(number, len(scene.bodies))
    parts = [part for each in bodies for part in each.named()]
    if parts_out is not None and parts:
        write_file(parts_out, written_meshes.written(parts, parts_out.suffix.lower(), scene.units))
    for each in bodies:
        if isinstance(each.result, SatcheckError):
            said = f"satcheck: error: {each.body.id}: {each.result} [{each.result.code}]"
            talk(harmless(said))
    settings = DecompositionOptions(threshold=threshold, seed=seed, seconds=seconds)
    report = _report(bodies, scene, settings, parts_out)
    deliver(document, report, form, output, partial(_table, bodies, scene, parts_out))
    if scene.unreadable or not parts:
        return exit_codes.ERROR
    whole = all(each.has_parts for each in bodies)
    return exit_codes.CLEAN if whole else exit_codes.INCOMPLETE


def _split(
    body: Body, threshold: float, seed: int, seconds: float, cache: Cache | None
) -> Decomposition | SatcheckError:
    if isinstance(body.shape, HalfSpace):
        return SatcheckError("half-space", "a half space is convex, and has no end")
    if is_curved(body.shape):
        return SatcheckError("curved-shape", "a curved shape is convex, and has no triangles")
    try:
        return decompose(
            body.world_mesh(), threshold=threshold, seed=seed, seconds=seconds, cache=cache
        )
    except (OverflowError, ValueError) as error:
        return SatcheckError("out-of-range", str(error))
    except DecompositionError as error:
        return error


def _rounding(bodies: list[_Parts], output: Path | None) -> float | None:
    """Return the rounding of the file that was written."""
    parts = [part for each in bodies for part in each.named()]
    return None if output is None else written_meshes.rounding(parts, output.suffix.lower())


def _report(
    bodies: list[_Parts], scene: Scene, settings: DecompositionOptions, output: Path | None
) -> DecompositionReport:
    return DecompositionReport(
        tool=tool(),
        units=scene.units,
        settings=settings,
        output=None if output is None else output.as_posix(),
        rounding=_rounding(bodies, output),
        bodies=tuple(map(_body_report, bodies)),
        issues=tuple(Issue(*astuple(issue)) for issue in scene.issues),
    )


def _body_report(parts: _Parts) -> DecomposedBody:
    result, mesh = parts.result, parts.body.file
    body = DecomposedBody(id=parts.body.id, file=mesh.path, triangles=mesh.mesh.triangle_count)
    if isinstance(result, SatcheckError):
        return replace(body, failure=Remark(result.code, str(result)))
    return replace(
        body,
        parts=tuple(
            Part(name, part.vertex_count, part.triangle_count) for name, part in parts.named()
        ),
        outside=result.outside,
        missing=result.missing,
        seconds=result.seconds,
        from_cache=result.from_cache,
        notes=tuple(Remark(note.code, note.message) for note in result.notes),
    )


def _table(bodies: list[_Parts], scene: Scene, output: Path | None, page: Page) -> str:
    unit = unit_of(scene.units)
    named = f" ({unit})" if unit else ""
    rows = [
        (
            each.body.id,
            f"{each.body.file.mesh.triangle_count:,}",
            f"{len(each.result.parts):,}",
            _error(each.result.outside),
            _error(each.result.missing),
            "cached" if each.result.from_cache else duration(each.result.seconds * 1e6),
        )
        for each in bodies
        if isinstance(each.result, Decomposition)
    ]
    lines = []
    if rows:
        body, *figures = zip(*rows, strict=True)
        names = ("triangles", "parts", f"parts stick out{named}", f"mesh sticks out{named}", "time")
        columns = [Column("body", body, named=True)]
        columns += [
            Column(name, cells, right=True, folds=True)
            for name, cells in zip(names, figures, strict=True)
        ]
        lines += table(columns, page)
    lines += fitted_each((*_remarks(bodies, scene), _summary(bodies, output, unit)), page)
    return joined(lines, page)


def _error(length: float) -> str:
    """Measured as an upper bound."""
    return "0" if length == 0 else f"<= {at_most(length)}"


def _remarks(bodies: list[_Parts], scene: Scene) -> Iterator[str]:
    for each in bodies:
        if isinstance(each.result, Decomposition):
            for note in each.result.notes:
                yield f"note: {each.body.id}: {note.message} [{note.code}]"
    for issue in scene.issues:
        if issue.severity == "warning":
            yield issue_line(issue)


def _summary(bodies: list[_Parts], output: Path | None, unit: str | None) -> str:
    made = [each.result for each in bodies if isinstance(each.result, Decomposition)]
    parts = sum(len(result.parts) for result in made)
    whole = f"{counted(len(made), 'body', 'bodies')}, {counted(parts, 'convex part')}."
    if failed := len(bodies) - len(made):
        whole += f" {counted(failed, 'body has', 'bodies have')} none."
    if output is None or not parts:
        return whole
    whole += f" Written to {output}"
    error = _rounding(bodies, output)
    if not error:
        return f"{whole}."
    return f"{whole}, whose 32-bit numbers move a vertex by {with_unit(at_most(error), unit)}."
