"""From the options to a report, a document and an exit code."""

from __future__ import annotations

import gc
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satcheck.cli import exit_codes
from satcheck.cli.lengths import in_units_of
from satcheck.cli.output import Document, cannot_write, talk
from satcheck.cli.refusals import failure, wrong_usage
from satcheck.core.frozen import frozen

if TYPE_CHECKING:
    from typing import Protocol

    from satcheck.audit.report.report import Report
    from satcheck.cli.output import Page
    from satcheck.cli.posing import Posing
    from satcheck.scene import Scene
    from satcheck.scene.scene_builder import Split
    from satcheck.scene.units import Length

    class Inputs(Protocol):
        """The options of a command that say what is read, and how."""

        @property
        def paths(self) -> tuple[str, ...]: ...
        @property
        def packages(self) -> Mapping[str, Path]: ...
        @property
        def split(self) -> Split | None: ...
        @property
        def allow_outside(self) -> bool: ...
        @property
        def units(self) -> str | None: ...


# With -o at most this many warnings are repeated on stderr.
WARNINGS = 5


# Up to this, a check ends before the garbage collector could pay.
SMALL_BODIES = 2
SMALL_TRIANGLES = 1000
# Objects made between two searches for cycles: of what a check makes almost none is in one.
COLLECT_AFTER = 50_000


@frozen
class Choices:
    """The options of the command line."""

    paths: tuple[str, ...]
    form: str
    output: Path | None
    explain: bool
    depth: bool | None
    contacts: bool
    volume: bool
    clearance: Length | None
    tolerance: Length | None
    accuracy: str
    depth_width: float
    depth_budget: float
    split: Split | None
    units: str | None
    fail_on: str
    allow_open: bool
    cross_check: bool
    planar: str | None
    certificate: bool
    jobs: int
    cache: bool
    timings: bool
    exit_zero: bool
    debug: bool
    packages: Mapping[str, Path]
    allow_outside: bool
    posing: Posing


def run(choices: Choices) -> int:
    """Check, write the document, tell the errors on stderr; returns the exit code."""
    refuse_early(choices.paths, choices.output, others=choices.posing.pose)
    document = Document()
    scene = load_inputs(
        choices,
        hashed=choices.form == "json",
        meanwhile=lambda: _import_what_follows(choices.form),
    )
    if len(scene.bodies) > SMALL_BODIES or any(
        body.file.topology.triangles > SMALL_TRIANGLES for body in scene.bodies
    ):
        gc.enable()
        gc.set_threshold(COLLECT_AFTER)
    failed = any(issue.severity == "error" for issue in scene.issues)
    if failed and len(scene.bodies) < 2 and choices.form == "table":
        return exit_codes.ERROR  # every pair would be an empty row, and the error is told
    if choices.posing.given:
        from satcheck.cli.posing import poses_of
        from satcheck.scene.robot import posed

        poses = poses_of(scene, choices.posing)
        if isinstance(poses, list):
            from satcheck.cli.sampling import check_and_tell

            return check_and_tell(scene, poses, choices, document)
        scene = posed(scene, poses)
    report = _report(scene, choices)
    utf8 = choices.form == "json"
    document.deliver(lambda page: _render(report, choices, page), choices.output, utf8=utf8)
    _tell(report, scene, choices)
    return exit_codes.of_report(report, exit_zero=choices.exit_zero)


def _import_what_follows(form: str) -> None:
    """What a check and its document import anyway, for the time in which others read."""
    import satcheck.audit

    if form == "table":
        import satcheck.cli.report.table
    else:
        import satcheck.cli.report.json  # noqa: F401


def refuse_early(
    paths: tuple[str, ...],
    output: Path | None,
    others: tuple[str, ...] = (),
    option: str = "-o",
) -> None:
    """What can be seen to fail before any work is done. others: more files that are read. option:
    that names the output."""
    if not paths:
        raise wrong_usage("give two or more mesh files, or a scene file")
    if output and not output.absolute().parent.is_dir():
        raise cannot_write(str(output), "its folder does not exist")
    if output is not None and any(_is_an_input(output, path) for path in (*paths, *others)):
        raise wrong_usage(f"{option} {output} would overwrite an input")


def _is_an_input(output: Path, path: str) -> bool:
    try:
        return output.samefile(path)
    except OSError:  # one of them is not there yet
        return output.absolute() == Path(path).absolute()


def load(
    paths: tuple[str, ...],
    packages: Mapping[str, Path] | None = None,
    split: Split | None = None,
    allow_outside: bool = False,
    units: str | None = None,
    hashed: bool = True,
    meanwhile: Callable[[], object] | None = None,
) -> Scene:
    """The bodies; inputs that cannot be used are told on stderr. UsageError for one body alone, and
    for a split of what says itself what its bodies are; ClickException where nothing is left.
    units, meanwhile: see load_scene. hashed: whether the document states the SHA-256 of files."""
    from satcheck.core import keep_freed_memory
    from satcheck.scene import load_scene
    from satcheck.scene.loader import is_mesh

    if split and not any(map(is_mesh, paths)):
        raise wrong_usage("--split is about mesh files: a scene says what its bodies are")
    keep_freed_memory()
    scene = load_scene(
        paths,
        split=split,
        packages=packages,
        allow_outside=allow_outside,
        units=units,
        hashed=hashed,
        meanwhile=meanwhile,
    )
    from satcheck.cli.report.words import issue_line

    for issue in dict.fromkeys(issue for issue in scene.issues if issue.severity == "error"):
        talk(f"satcheck: {issue_line(issue)}")
    _hint(paths[0])
    if len(scene.bodies) + len(scene.unreadable) < 2:
        if scene.unreadable:
            raise failure("an input could not be used: there is no pair to check")
        what = "one body alone cannot collide" if scene.bodies else "there is no body"
        raise wrong_usage(f"{what}: {_advice(paths, split)}")
    return scene


def load_inputs(
    choices: Inputs, hashed: bool = True, meanwhile: Callable[[], object] | None = None
) -> Scene:
    """As `load`, with the options of a command."""
    return load(
        choices.paths,
        choices.packages,
        choices.split,
        choices.allow_outside,
        choices.units,
        hashed,
        meanwhile,
    )


def _advice(paths: tuple[str, ...], split: Split | None) -> str:
    from satcheck.scene.loader import is_mesh

    only = next(filter(is_mesh, paths), None)
    if only is None:
        return f"give mesh files beside {paths[0]}, or a scene of two bodies"
    if split == "components":
        return f"{only} is one connected component"
    others = "--split components makes a body of each connected component"
    return f"give two or more mesh files, or a scene file; {others}"


def _hint(first: str) -> None:
    """The first word is a path unless it names a command; a misspelt command is a missing path."""
    if "." in first or Path(first).exists():
        return
    from satcheck.cli.command import meant

    if name := meant(first):
        talk(f"satcheck: did you mean the command `satcheck {name}`?")


def _report(scene: Scene, choices: Choices) -> Report:
    from satcheck.audit import check
    from satcheck.cli.progress import Bar

    settings = settings_of(choices, scene)
    try:
        with Bar() as bar:
            return check(scene, settings, progress=bar)
    except SystemExit as stop:  # a library that ends the process must not look like an answer
        raise RuntimeError(f"a library called exit({stop.code!r})") from stop


def settings_of(choices: Choices, scene: Scene) -> Any:
    from satcheck.audit import Settings

    def length(given: Length | None, option: str) -> float | None:
        return None if given is None else in_units_of(given, scene.units, option)

    return Settings(
        depth=choices.depth,
        contacts=choices.contacts,
        volume=choices.volume,
        clearance=length(choices.clearance, "--clearance"),
        tolerance=length(choices.tolerance, "--tolerance"),
        accuracy=choices.accuracy,  # type: ignore[arg-type]  # one of ACCURACIES, click saw to it
        depth_width=choices.depth_width,
        depth_budget=choices.depth_budget,
        fail_on=choices.fail_on,  # type: ignore[arg-type]  # one of FAIL_ON likewise
        allow_open=choices.allow_open,
        cross_check=choices.cross_check,
        planar=choices.planar,  # type: ignore[arg-type]  # one of PLANES, click saw to it
        certificate=choices.certificate,
        jobs=choices.jobs,
        cache=choices.cache,
        timings=choices.timings,
    )


def _render(report: Report, choices: Choices, page: Page) -> str | list[str]:
    if choices.form == "json":
        from satcheck.cli.report.json import render

        return render(report, timings=choices.timings)
    from satcheck.cli.report.table import render as render_table

    return render_table(report, page, explain=choices.explain, timings=choices.timings)


def _tell(report: Report, scene: Scene, choices: Choices) -> None:
    """Errors of the run on stderr; with -o also the warnings, the summary, where the report is."""
    from satcheck.cli.report.summary import summary_line
    from satcheck.cli.report.words import counted, issue_line

    for trace in report.tracebacks if choices.debug else ():
        talk(trace.rstrip())
    told = {(issue.code, issue.body, issue.message) for issue in scene.issues}
    for issue in report.issues:
        if issue.severity == "error" and (issue.code, issue.body, issue.message) not in told:
            talk(f"satcheck: {issue_line(issue)}")
    if not choices.output:
        return
    warnings = [issue for issue in report.issues if issue.severity == "warning"]
    for issue in warnings[:WARNINGS]:
        talk(f"satcheck: {issue_line(issue)}")
    if len(warnings) > WARNINGS:
        talk(f"satcheck: {counted(len(warnings) - WARNINGS, 'more warning')}: see the report")
    talk(f"{summary_line(report)} Report: {choices.output}")
