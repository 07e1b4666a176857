"""The child of a slot: checks the worlds of a chunk one after another (`core.worker`)."""

from __future__ import annotations

import msgspec
from msgspec import Struct
from msgspec.structs import replace

from satcheck.batch.check_options import CheckOptions, World
from satcheck.batch.check_world import check_world
from satcheck.batch.key import digest, inputs_of, key_of
from satcheck.core import keep_freed_memory
from satcheck.report.assets import AssetVerdict
from satcheck.report.batch import Result
from satcheck.report.json import line_without_times
from satcheck.scene.files_read import files_read


class Chunk(Struct, frozen=True):
    worlds: tuple[World, ...]
    options: CheckOptions


class Answer(Struct, frozen=True):
    """line: the Result as a line of JSON."""

    world: World
    verdict: AssetVerdict
    line: bytes


def serve(request: bytes) -> bytes:
    keep_freed_memory()
    chunk = msgspec.msgpack.decode(request, type=Chunk)
    # A slot is one thread: the others have the other cores.
    options = replace(chunk.options, settings={**chunk.options.settings, "jobs": 1})
    return msgspec.msgpack.encode([_answer(world, options) for world in chunk.worlds])


def _answer(world: World, options: CheckOptions) -> Answer:
    with files_read() as files:
        checked = check_world(world, options)
    inputs = inputs_of(files, digest)
    result = Result(
        files=world,
        key=key_of(world, options, inputs),
        verdict=checked.verdict,
        inputs=inputs,
        report=checked.report,
    )
    return answer(result)


def answer(result: Result) -> Answer:
    return Answer(result.files, result.verdict, line_without_times(result))
