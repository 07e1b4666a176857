"""`satcheck decompose MESH`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import click
from msgspec.structs import astuple, replace

from satcheck.audit.summary import tool
from satcheck.audit.words import at_most, counted, duration, with_unit
from satcheck.cli import exit_codes, option, scene_option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.format_option import deliver, form_option, plain_call, product_and_report
from satcheck.cli.formats.tables import Column, fitted_each, joined, table
from satcheck.cli.inputs import Inputs, load
from satcheck.cli.output import Page, harmless, issue_line, talk, write_file
from satcheck.cli.progress import counting
from satcheck.cli.robot_parts import URDF, in_links, write_urdf
from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import HalfSpace, is_curved
from satcheck.core.steps import step
from satcheck.decompose import Decomposition, DecompositionError, Limits, decompose, user_cache
from satcheck.decompose.computation import placed
from satcheck.decompose.settings import ENGINES, LEAST_VERTICES
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
# Parts and vertices.
_ENGINES = ", ".join(f"{name} ({e.parts or 'any'} x {e.vertices})" for name, e in ENGINES.items())

# A body, and its convex parts in world coordinates or why there are none.
_Split = tuple[Body, Decomposition | SatcheckError]


@click.command("decompose", cls=Command, context_settings=HELP_NAMES)
@option.paths("MESH ...")
@click.option(
    "--threshold",
    type=option.Number(0, 1, min_open=True),
    metavar="RATIO",
    default=option.DEFAULTS.part_threshold,
    show_default=True,
    help="Split until parts are this close to convex, in CoACD's measure. A smaller one gives more "
    "parts, which fit better.",
)
@click.option(
    "--seed",
    type=option.Whole(min=0, max=2**32 - 1),
    metavar="N",
    default=option.DEFAULTS.part_seed,
    show_default=True,
    help="The seed of CoACD's random search: the same seed gives the same parts.",
)
@click.option(
    "--max-parts",
    type=option.Whole(min=1),
    metavar="N",
    help="At most N parts for a body: those are merged whose hull adds the least volume.",
)
@click.option(
    "--max-vertices",
    type=option.Whole(min=LEAST_VERTICES),
    metavar="N",
    help="At most N vertices for a part.",
)
@click.option(
    "--enclose",
    is_flag=True,
    help="Grow the parts until they are proven to contain the body, in the 32-bit numbers that "
    "engines read.",
)
@click.option(
    "--for",
    "engine",
    type=click.Choice(tuple(ENGINES)),
    metavar="ENGINE",
    help=f"The limits that an engine documents, as parts and vertices: {_ENGINES}. --max-parts "
    "and --max-vertices override them.",
)
@form_option
@option.outputs(
    f"Write the parts to FILE ({_FILES}): a node of a GLB or an object of an OBJ file each; an STL "
    "file holds them all. A .urdf is the robot with its parts for collision geometry, which lie in "
    "a folder beside it. Or the report (.json). Repeatable."
)
@scene_option.split
@scene_option.units
@scene_option.reading("body-seconds")
@scene_option.package
@scene_option.geometry
@option.common
def command(
    outputs: tuple[Path, ...],
    threshold: float,
    seed: int,
    max_parts: int | None,
    max_vertices: int | None,
    enclose: bool,
    engine: str | None,
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
    parts_out, output = product_and_report(outputs, (*written_meshes.FORMATS, URDF), form)
    if not options["paths"]:
        raise click.UsageError("give a mesh file or a scene")
    inputs, form, document = plain_call(options, form, output, parts_out)
    scene = load(inputs, least=1)
    if parts_out is not None:
        scene.require_one_unit()
    if not scene.bodies and form == "table":
        return exit_codes.ERROR  # the error is told
    known = ENGINES.get(engine or "", Limits())
    settings = DecompositionOptions(
        threshold=threshold,
        seed=seed,
        max_parts=max_parts or known.parts,
        max_vertices=max_vertices or known.vertices,
        enclose=enclose,
        seconds=inputs.limit["body-seconds"],
    )
    ending = "" if parts_out is None else parts_out.suffix.lower()
    bodies = _Splitter(settings).split_each(in_links(scene) if ending == URDF else scene.bodies)
    has_parts = any(isinstance(result, Decomposition) for _, result in bodies)
    if parts_out is not None and has_parts:
        _write(parts_out, bodies, scene, inputs)
    report = _report(settings, scene, bodies, parts_out)
    has_failed = _tell_failures(report)
    deliver(document, report, form, output, partial(_table, report))
    if scene.unreadable or not has_parts:
        return exit_codes.ERROR
    return exit_codes.INCOMPLETE if has_failed else exit_codes.CLEAN


def _report(
    settings: DecompositionOptions, scene: Scene, bodies: Sequence[_Split], written: Path | None
) -> DecompositionReport:
    """written: the file with the parts; None: there is none."""
    rounding = None
    if written is not None:
        parts = [part for each in bodies for part in _named(*each)]
        rounding = written_meshes.rounding(parts, written.suffix.lower())
    return DecompositionReport(
        tool=tool(),
        units=scene.units,
        settings=settings,
        output=None if written is None else written.as_posix(),
        rounding=rounding,
        bodies=tuple(_body_report(*each, settings.enclose or None) for each in bodies),
        issues=tuple(Issue(*astuple(issue)) for issue in scene.issues),
    )


def _tell_failures(report: DecompositionReport) -> bool:
    """Return whether there are any."""
    failures = [(each.id, each.failure) for each in report.bodies if each.failure is not None]
    for id_, failure in failures:
        talk(harmless(f"satcheck: error: {id_}: {failure.message} [{failure.code}]"))
    return bool(failures)


def _write(output: Path, bodies: Sequence[_Split], scene: Scene, inputs: Inputs) -> None:
    named = {body.id: list(_named(body, result)) for body, result in bodies}
    if (ending := output.suffix.lower()) == URDF:
        write_urdf(output, scene, named, inputs)
    else:
        parts = list(chain.from_iterable(named.values()))
        write_file(output, written_meshes.written(parts, ending, scene.units))


class _Splitter:
    """Splits bodies: each distinct mesh once, and fits its parts once to each of its places."""

    def __init__(self, asked: DecompositionOptions) -> None:
        self._split = partial(
            decompose,
            threshold=asked.threshold,
            seed=asked.seed,
            seconds=asked.seconds,
            cache=user_cache(),
        )
        limits = Limits(asked.max_parts, asked.max_vertices, asked.enclose)
        self._place = partial(placed, limits=limits, seconds=asked.seconds)
        self._seconds = asked.seconds
        self._known: dict[object, Decomposition | SatcheckError] = {}

    def split_each(self, bodies: Sequence[Body]) -> list[_Split]:
        done = []
        for number, body in enumerate(counting(bodies, "bodies", "splitting"), 1):
            done.append((body, self._parts(body, f"{body.id}, {number} of {len(bodies)}")))
        return done

    def _parts(self, body: Body, name: str) -> Decomposition | SatcheckError:
        if isinstance(body.shape, HalfSpace):
            return SatcheckError("half-space", "a half space is convex, and has no end")
        if is_curved(body.shape):
            return SatcheckError("curved-shape", "a curved shape is convex, and has no triangles")
        mesh, transform = body.file.mesh, body.transform
        content = mesh.to_bytes()
        with step(f"splitting {name}", self._seconds):
            parts = self._once(content, partial(self._split, mesh))
        if isinstance(parts, SatcheckError):
            return parts
        with step(f"fitting the parts of {name}", self._seconds):
            return self._once(
                (content, transform), lambda: self._place(body.world_mesh(), parts, transform)
            )

    def _once(
        self, key: object, make: Callable[[], Decomposition]
    ) -> Decomposition | SatcheckError:
        if key not in self._known:
            try:
                self._known[key] = make()
            except (OverflowError, ValueError) as error:
                self._known[key] = SatcheckError("out-of-range", str(error))
            except DecompositionError as error:
                self._known[key] = error
        return self._known[key]


def _named(body: Body, result: Decomposition | SatcheckError) -> Iterator[written_meshes.Part]:
    if isinstance(result, Decomposition):
        for number, part in enumerate(result.parts, 1):
            yield f"{body.id}-{number}", part.to_mesh()


def _body_report(
    body: Body, result: Decomposition | SatcheckError, encloses: bool | None
) -> DecomposedBody:
    mesh = body.file
    report = DecomposedBody(id=body.id, file=mesh.path, triangles=mesh.mesh.triangle_count)
    if isinstance(result, SatcheckError):
        return replace(report, failure=Remark(result.code, str(result)))
    return replace(
        report,
        parts=tuple(
            Part(name, part.vertex_count, part.triangle_count)
            for name, part in _named(body, result)
        ),
        outside=result.outside,
        missing=result.missing,
        encloses=encloses,
        seconds=result.seconds,
        from_cache=result.from_cache,
        notes=tuple(Remark(note.code, note.message) for note in result.notes),
    )


def _table(report: DecompositionReport, page: Page) -> str:
    unit = unit_of(report.units)
    named = f" ({unit})" if unit else ""
    made = [body for body in report.bodies if body.failure is None]
    cells = {
        "triangles": [f"{body.triangles:,}" for body in made],
        "parts": [f"{len(body.parts or ()):,}" for body in made],
        f"parts stick out{named}": [_error(body.outside) for body in made],
        f"mesh sticks out{named}": ["0, proven" if b.encloses else _error(b.missing) for b in made],
        "time": ["cached" if b.from_cache else duration((b.seconds or 0.0) * 1e6) for b in made],
    }
    columns = [Column("body", tuple(body.id for body in made), named=True)]
    columns += [Column(key, tuple(own), right=True, folds=True) for key, own in cells.items()]
    lines = table(columns, page) if made else []
    said = [f"note: {b.id}: {note.message} [{note.code}]" for b in made for note in b.notes or ()]
    said += [issue_line(issue) for issue in report.issues if issue.severity == "warning"]
    return joined([*lines, *fitted_each([*said, _summary(report, made, unit)], page)], page)


def _error(length: float | None) -> str:
    """Return a measured upper bound."""
    return f"<= {at_most(length)}" if length else "0"


def _summary(report: DecompositionReport, made: list[DecomposedBody], unit: str | None) -> str:
    parts = sum(len(body.parts or ()) for body in made)
    whole = f"{counted(len(made), 'body', 'bodies')}, {counted(parts, 'convex part')}."
    if failed := len(report.bodies) - len(made):
        whole += f" {counted(failed, 'body has', 'bodies have')} none."
    if report.output is None or not parts:
        return whole
    whole += f" Written to {report.output}"
    if not report.rounding:
        return f"{whole}."
    error = with_unit(at_most(report.rounding), unit)
    return f"{whole}, whose 32-bit numbers move a vertex by {error}."
