"""The file of a baseline."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.report.baseline import SCHEMA, Baseline
from satcheck.scene.opening import Signature, followed, note, read_whole, signature

MOST_BYTES = 1 << 28


class _Head(msgspec.Struct, frozen=True):
    schema: str


def read_baseline(path: Path) -> Baseline:
    """Raises SatcheckError: `bad-baseline`, or a code about the file."""
    try:
        text = read_whole(str(path), path, MOST_BYTES)
        schema = msgspec.json.decode(text, type=_Head).schema
        if schema != SCHEMA and schema.startswith(SCHEMA.rstrip("1")):
            reason = "of another version of satcheck: write it again"
            raise SatcheckError("bad-baseline", reason, file=str(path))
        return msgspec.json.decode(text, type=Baseline)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise SatcheckError("bad-baseline", f"no baseline: {error}", file=str(path)) from None


def current_baseline(path: Path) -> Baseline:
    """The same for many assets: the file is read once, and again when it has changed."""
    note(path)
    return _read_once(path, signature(str(path)))


@lru_cache(maxsize=1)
def _read_once(path: Path, _: Signature) -> Baseline:
    return read_baseline(path)


def asset_key(asset: str, baseline: Path) -> str:
    """The name of an asset in a baseline: relative to the folder of the baseline, with `/`, so that
    it does not depend on where the command runs, nor on links that lead to a folder."""
    file = followed(Path(asset).parent) / Path(asset).name
    return Path(os.path.relpath(file, followed(baseline.parent))).as_posix()


def names_in_baseline(paths: Sequence[str], baseline: Path) -> tuple[str, ...]:
    """What a baseline may call the input of a plain check. One file is the asset that
    `satcheck each` checks: its bodies have the same ids."""
    return (asset_key(paths[0], baseline), "") if len(paths) == 1 else ("",)
