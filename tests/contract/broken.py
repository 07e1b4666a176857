"""Say how the answer to a call breaks the contract, with the command under test."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tests.cli.process import satcheck
from tests.contract.adapter import Facts
from tests.contract.cases import Arguments, Call
from tests.contract.compare import differences
from tests.contract.runs import facts, pinned

facts_of_group = cache(pinned)


def broken(group: str, call: Call) -> list[str]:
    return differences(facts_of_group(group)[call.name], answered(call))


def answered(call: Call) -> Facts:
    return facts(call, _run)


def _run(arguments: Arguments, folder: Path) -> tuple[int, str]:
    done = satcheck(*arguments, cwd=folder)
    return done.code, done.out
