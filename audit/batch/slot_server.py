"""The child of a slot: checks the worlds of a chunk one after another (`core.worker`)."""

from __future__ import annotations

import gc
import json
import os
import re
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NoReturn

import msgspec
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit.batch.check_world import check_world, unreadable_asset, without_unused_rules
from satcheck.audit.batch.key import Digests, inputs_of, key_of, terms_of
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.remote import Copies, is_remote, make_room
from satcheck.core import keep_freed_memory
from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import Care, Loss, careful, end_at_memory_error
from satcheck.report.assets import Asset, AssetVerdict, InputFile, Result
from satcheck.report.json import line_of
from satcheck.report.report import Issue
from satcheck.scene.mesh_files import KnownMeshes
from satcheck.scene.opening import FilesRead, files_read, note

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
    resumes, which has no times. threads: for one check, as the other slots have the other cores."""

    kept: bool = True
    threads: int = 1


class Chunk(Struct, frozen=True):
    """left_out: None: a plain check. Else a careful one, without these steps. copies: a folder for
    copies of remote files, the same for each chunk of a slot."""

    worlds: tuple[World, ...]
    options: CheckOptions
    limits: Limits
    wanted: Wanted = Wanted()
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


def request_of(chunk: Chunk) -> bytes:
    """In ASCII, because msgspec writes no name of a file that is not UTF-8."""
    return json.dumps(msgspec.to_builtins(chunk)).encode()


def answers_in(reply: bytes, worlds: Sequence[World]) -> list[Answer]:
    """Yield the answers of these worlds, in this order."""
    made = msgspec.msgpack.decode(reply, type=list[_Made])
    return [Answer(world, *each) for world, each in zip(worlds, made, strict=True)]


def serve(request: bytes) -> bytes:
    keep_freed_memory()
    gc.set_threshold(_GARBAGE)
    end_at_memory_error(_end)
    chunk = msgspec.convert(json.loads(request), Chunk)
    settings = {**chunk.options.settings, "jobs": chunk.wanted.threads}
    options = replace(chunk.options, settings=settings)
    care = None if chunk.left_out is None else Care(chunk.left_out, _tell)
    if chunk.copies is not None:
        make_room(Path(chunk.copies))
    with careful(care):
        terms = terms_of(options, chunk.limits if chunk.left_out else None)
        made = [_result(world, options, terms, chunk) for world in chunk.worlds]
    return msgspec.msgpack.encode(made)


def _tell(step: str) -> None:
    name = step.encode("utf-8", "surrogateescape").hex()
    os.write(2, f"satcheck step {time.monotonic()} {name}\n".encode())


def _end() -> NoReturn:
    """The parent sees a lack of memory in the last line."""
    os.write(2, b"MemoryError\n")
    os._exit(1)


def _result(world: World, options: CheckOptions, terms: str, chunk: Chunk) -> _Made:
    copies = None
    if chunk.copies is not None and is_remote(world):
        copies = Copies(Path(chunk.copies), world, anywhere=options.allow_outside)
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
    is_known = files.are_certain() and not lacking
    key = key_of(world, terms, inputs, options.folders) if is_known else None
    line = line_of(result_of(world, checked, inputs, key), timings=not chunk.wanted.kept)
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
    """key: None: the next run checks the world again."""
    return Result(
        files=world, key=key, verdict=checked.verdict, inputs=inputs, report=checked.report
    )
