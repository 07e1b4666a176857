"""What the files of bodies say about more than one of them: units, and warnings to be said once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from satcheck.core.frozen import replace
from satcheck.scene.bodies import Body
from satcheck.scene.issue import Issue, issue
from satcheck.scene.units import is_unit, unit_of


def common_units(declared: Mapping[str, str | None], *, labelled: bool) -> str | None:
    """The units of the inputs, by their paths, where they agree; a label of ours where known.

    labelled: scenes or robots among them say what the numbers of all others are, too.
    """
    units = [unit for unit in declared.values() if unit or not labelled]
    names = {unit_of(unit) or unit for unit in units}
    found = units[0] if len(names) == 1 else None
    return found if labelled or (found and is_unit(found)) else None


def units_differ(declared: Mapping[str, str | None]) -> Issue | None:
    """A warning where two inputs declare different units: nothing is converted."""
    named = [(path, unit) for path, declares in declared.items() if (unit := unit_of(declares))]
    for path, unit in named[1:]:
        first, its = named[0]
        if unit != its:
            message = (
                f"{path} is in {unit}, {first} in {its}: nothing is converted, "
                "so their bodies are of the wrong size to each other"
            )
            return issue("units-differ", message, file=path)
    return None


def issues_of_files(bodies: Sequence[Body]) -> list[Issue]:
    """Each file's warnings once: with the body's id where only one body uses the file."""
    users: dict[tuple[str, str | None], list[Body]] = {}
    for body in bodies:
        users.setdefault((body.file.path, body.file.part), []).append(body)
    return [
        _shared(found, together) for together in users.values() for found in together[0].file.issues
    ]


def _shared(found: Issue, bodies: list[Body]) -> Issue:
    part, message = bodies[0].file.part, found.message
    if len(bodies) == 1:
        return replace(found, body=bodies[0].id)
    return found if part is None else replace(found, message=f"mesh {part!r}: {message}")
