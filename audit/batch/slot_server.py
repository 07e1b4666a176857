"""The child of a slot: checks one world for each request (`core.worker`)."""

from __future__ import annotations

import gc
import json
import os
import re
import time
from collections.abc import Mapping
from functools import lru_cache, partial
from pathlib import Path
from typing import NamedTuple, NoReturn

import msgspec
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.batch.check_world import check_world, unreadable_asset, without_unused_rules
from satcheck.audit.batch.key import Digests, inputs_of, key_of, terms_of
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.remote import Copies, make_room
from satcheck.core import keep_freed_memory
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import Care, Loss, careful, end_at_memory_error
from satcheck.report.assets import Asset, AssetVerdict, InputFile, Result
from satcheck.report.json import line_of, read_line
from satcheck.report.report import Issue
from satcheck.scene.access import FilesRead, files_read, note
from satcheck.scene.mesh_files import KnownMeshes

# A line on standard error names the risky step that begins, in hexadecimal digits, as the name may
# hold anything, and says when: in seconds of a clock that all processes share.
STEP_LINE = re.compile(r"^satcheck step (\S+) ([0-9a-f]*)$", re.MULTILINE)

# A scene names meshes, these name buffers: more rounds of fetching are a circle.
_MOST_ROUNDS = 8

# Issues that end when a package is installed, which no file shows.
_NOT_INSTALLED = frozenset(("missing-extra", "unsupported-format"))
# What this process keeps for the next world. A triangle takes about 200 bytes.
_KEPT_TRIANGLES = 1_000_000
# New objects before Python looks for cycles among them, of which reports have none.
_GARBAGE = 50_000
_meshes = KnownMeshes(_KEPT_TRIANGLES)
_digests = Digests()


class Wanted(Struct, frozen=True):
    """The wishes for a check beside its answer. kept: the result is for a file that a later run
    resumes, which has no times; only such a result has a key. threads: for one check, as the other
    slots have the other cores."""

    kept: bool = True
    threads: int = 1


class Job(Struct, frozen=True):
    """left_out: None: a plain check. Else a careful one, without these steps. copies: a folder for
    copies of remote files, the same for each world of a slot."""

    world: World
    left_out: Mapping[str, Loss] | None = None
    copies: str | None = None


class Answer(Struct, frozen=True):
    """line: the Result as a line of JSON. unused: issues of shared rules that it does not need."""

    world: World
    verdict: AssetVerdict
    line: bytes
    unused: tuple[Issue, ...] = ()


# An answer without its world.
_Made = tuple[AssetVerdict, bytes, tuple[Issue, ...]]
_DECODER = msgspec.msgpack.Decoder(_Made)


class Terms(NamedTuple):
    """What all worlds of a slot share. digest: of `terms_of`; of_limits: with the limits."""

    options: CheckOptions
    digest: str
    of_limits: str
    wanted: Wanted


def text_of(value: object) -> bytes:
    """Return one line of JSON. msgspec writes no infinity, and no name that is not UTF-8."""
    return json.dumps(msgspec.to_builtins(value)).encode()


def request_of(job: Job, terms: bytes) -> bytes:
    """terms: the text of the options, the limits and the wishes, which has no line end."""
    try:
        return terms + b"\n" + msgspec.json.encode(job)
    except UnicodeEncodeError:
        return terms + b"\n" + text_of(job)


def answer_in(reply: bytes, world: World) -> Answer:
    return Answer(world, *_DECODER.decode(reply))


def serve(request: bytes) -> bytes:
    shared, _, text = request.partition(b"\n")
    terms = _prepared(shared)
    job = read_line(text, Job)
    with careful(None if job.left_out is None else Care(job.left_out, _tell)):
        return msgspec.msgpack.encode(_result(job, terms))


@lru_cache(maxsize=1)
def _prepared(text: bytes) -> Terms:
    """Make this process ready for worlds on these terms."""
    keep_freed_memory()
    gc.set_threshold(_GARBAGE)
    end_at_memory_error(_end)
    options, limits, wanted = msgspec.convert(json.loads(text), tuple[CheckOptions, Limits, Wanted])
    options = replace(options, settings={**options.settings, "jobs": wanted.threads})
    return Terms(options, terms_of(options), terms_of(options, limits), wanted)


def _tell(step: str) -> None:
    name = step.encode("utf-8", "surrogateescape").hex()
    os.write(2, f"satcheck step {time.monotonic()} {name}\n".encode())


def _end() -> NoReturn:
    """The parent sees a lack of memory in the last line."""
    os.write(2, b"MemoryError\n")
    os._exit(1)


def _result(job: Job, terms: Terms) -> _Made:
    world, options, copies = job.world, terms.options, None
    if job.copies is not None:
        make_room(Path(job.copies))
        copies = Copies(Path(job.copies), world, anywhere=options.allow_outside)
        try:
            checked, unused, files = _checked_copies(world, options, copies)
        except SatcheckError as error:  # of the fetch: the next run tries again
            lost = result_of(world, unreadable_asset(world[0], error))
            return lost.verdict, line_of(lost), ()
    else:
        checked, unused, files = _checked(world, options)
    inputs = inputs_of(files, partial(_digests.digest, files))
    inputs = inputs if copies is None else copies.inputs(inputs)
    lacking = any(issue.code in _NOT_INSTALLED for issue in checked.report.issues)
    of_terms = terms.of_limits if job.left_out else terms.digest
    is_known = terms.wanted.kept and not lacking and files.are_certain()
    key = key_of(world, of_terms, inputs, options.folders) if is_known else None
    line = line_of(result_of(world, checked, inputs, key), timings=not terms.wanted.kept)
    return checked.verdict, line if copies is None else copies.with_urls(line), unused


def _checked_copies(
    world: World, options: CheckOptions, copies: Copies
) -> tuple[Asset, tuple[Issue, ...], FilesRead]:
    """Repeats the check as long as it looks for files that can be fetched. Raises SatcheckError."""
    paths = tuple(map(copies.path, world))
    options = replace(options, folders=())  # those of this machine are not around a remote scene
    copies.fetch(paths)
    for _ in range(_MOST_ROUNDS):
        checked, unused, files = _checked(paths, options)
        if not copies.fetch(files):
            return checked, unused, files
    reason = f"names files that name files, and so on, {_MOST_ROUNDS} times: copy it and check that"
    raise SatcheckError("too-many-files", reason, file=world[0])


def _checked(world: World, options: CheckOptions) -> tuple[Asset, tuple[Issue, ...], FilesRead]:
    with files_read() as files:
        for name in world:
            note(name)
        checked = check_world(world, options, known=_meshes)
    return *without_unused_rules(checked, options.rules), files


def result_of(
    world: World, checked: Asset, inputs: tuple[InputFile, ...] = (), key: str | None = None
) -> Result:
    """key: None: the next run, if there is one, checks the world again."""
    return Result(
        files=world, key=key, verdict=checked.verdict, inputs=inputs, report=checked.report
    )
