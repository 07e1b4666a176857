"""The child of a slot: checks the worlds of a chunk one after another (`core.worker`)."""

from __future__ import annotations

import json
from collections.abc import Sequence

import msgspec
from msgspec import Struct
from msgspec.structs import replace

from satcheck.batch.check_options import CheckOptions, World
from satcheck.batch.check_world import check_world
from satcheck.batch.key import digest, inputs_of, key_of, terms_of
from satcheck.core import keep_freed_memory
from satcheck.report.assets import AssetVerdict
from satcheck.report.batch import Result
from satcheck.report.json import line_without_times
from satcheck.scene.files_read import files_read, note


class Chunk(Struct, frozen=True):
    worlds: tuple[World, ...]
    options: CheckOptions


class Answer(Struct, frozen=True):
    """line: the Result as a line of JSON."""

    world: World
    verdict: AssetVerdict
    line: bytes


def request_of(chunk: Chunk) -> bytes:
    """In ASCII, because msgspec writes no name of a file that is not UTF-8."""
    return json.dumps(msgspec.to_builtins(chunk)).encode()


def answers_in(reply: bytes, worlds: Sequence[World]) -> list[Answer]:
    """Of these worlds, in this order."""
    verdicts_and_lines = msgspec.msgpack.decode(reply, type=list[tuple[AssetVerdict, bytes]])
    return [Answer(world, *each) for world, each in zip(worlds, verdicts_and_lines, strict=True)]


def serve(request: bytes) -> bytes:
    keep_freed_memory()
    chunk = msgspec.convert(json.loads(request), Chunk)
    # A slot is one thread: the others have the other cores.
    options = replace(chunk.options, settings={**chunk.options.settings, "jobs": 1})
    terms = terms_of(options)
    answers = (_answer(world, options, terms) for world in chunk.worlds)
    return msgspec.msgpack.encode([(each.verdict, each.line) for each in answers])


def _answer(world: World, options: CheckOptions, terms: str) -> Answer:
    with files_read() as files:
        for name in world:
            note(name)
        checked = check_world(world, options)
    inputs = inputs_of(files, digest)
    result = Result(
        files=world,
        key=key_of(world, terms, inputs) if files.are_certain() else None,
        verdict=checked.verdict,
        inputs=inputs,
        report=checked.report,
    )
    return answer(result)


def answer(result: Result) -> Answer:
    return Answer(result.files, result.verdict, line_without_times(result))
