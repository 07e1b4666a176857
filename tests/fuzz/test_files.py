"""A few damaged files of each kind; `python -m tests.fuzz.files` tries any number."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz.files import fault_of, file_of, workplace
from tests.fuzz.readers import READERS, attempt, name_of, seeds

COUNT = 25


@pytest.mark.parametrize("kind", READERS)
def test_damage_is_an_error_with_a_code(kind: str, tmp_path: Path) -> None:
    path = workplace(tmp_path) / name_of(kind)
    for number in range(COUNT):
        path.write_bytes(file_of(kind, 0, number))
        code, fault = fault_of(kind, path)
        assert not fault, (kind, number, fault)
        assert code == "" or code.replace("-", "").isalnum()


@pytest.mark.parametrize("kind", READERS)
def test_some_file_of_the_kind_is_good(kind: str, tmp_path: Path) -> None:
    """Damage to files that are refused anyway would try nothing."""
    path = workplace(tmp_path) / name_of(kind)
    codes = set()
    for seed in seeds(kind):
        path.write_bytes(seed)
        codes.add(attempt(kind, path))
    assert "" in codes, codes


# (kind, seed, number) of files that once raised what no reader should raise.
FAULTS = [
    *(("glb", 0, 432), ("gltf", 1, 2479), ("xaml", 0, 216), ("baseline", 0, 102)),
    *(("verify", 2, 17), ("view", 0, 8), ("view", 2, 324)),
]


@pytest.mark.parametrize(("kind", "seed", "number"), FAULTS)
def test_files_that_were_faults(kind: str, seed: int, number: int, tmp_path: Path) -> None:
    path = workplace(tmp_path) / name_of(kind)
    path.write_bytes(file_of(kind, seed, number))
    code, fault = fault_of(kind, path)
    assert not fault, fault
    assert code or kind == "view"
