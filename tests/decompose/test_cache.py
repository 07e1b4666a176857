"""decompose/cache.py: a reader gets the whole payload or nothing, whatever happened on disk."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

import pytest

from satcheck.decompose.cache import DIRECTORY_VARIABLE, Cache

KEY = bytes(range(32))
OTHER_KEY = bytes(32)


def entry_of(cache: Cache, key: bytes = KEY) -> Path:
    return cache.path / f"{key.hex()}.parts"


def test_what_is_stored_is_loaded(cache: Cache) -> None:
    assert cache.load(KEY) is None
    cache.store(KEY, b"payload")
    assert cache.load(KEY) == b"payload"
    assert cache.load(OTHER_KEY) is None


def test_nothing_is_created_by_looking(cache: Cache) -> None:
    cache.load(KEY)
    assert not cache.path.exists()


@pytest.mark.parametrize("position", range(0, 79, 6))
def test_a_flipped_bit_anywhere_is_a_miss(cache: Cache, position: int) -> None:
    cache.store(KEY, b"payload")
    data = bytearray(entry_of(cache).read_bytes())
    assert len(data) == 79
    data[position] ^= 0x10
    entry_of(cache).write_bytes(data)
    assert cache.load(KEY) is None


@pytest.mark.parametrize("length", [0, 7, 71, 72, 78])
def test_a_truncated_entry_is_a_miss_and_is_replaced(cache: Cache, length: int) -> None:
    cache.store(KEY, b"payload")
    entry_of(cache).write_bytes(entry_of(cache).read_bytes()[:length])
    assert cache.load(KEY) is None
    cache.store(KEY, b"payload")
    assert cache.load(KEY) == b"payload"


def test_an_entry_under_another_name_is_a_miss(cache: Cache) -> None:
    cache.store(KEY, b"payload")
    entry_of(cache).rename(entry_of(cache, OTHER_KEY))
    assert cache.load(OTHER_KEY) is None


def test_a_folder_in_the_place_of_an_entry_is_a_miss(cache: Cache) -> None:
    entry_of(cache).mkdir(parents=True)
    assert cache.load(KEY) is None


def test_a_failed_store_leaves_nothing_behind(
    cache: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full_disk(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(OSError, match="No space left"):
        cache.store(KEY, b"payload")
    assert list(cache.path.iterdir()) == []


def test_single_flight_lets_one_in_at_a_time(cache: Cache) -> None:
    inside = 0
    most_inside = 0
    gate = threading.Lock()

    def enter() -> None:
        nonlocal inside, most_inside
        with cache.single_flight(KEY, 10.0):
            with gate:
                inside += 1
                most_inside = max(most_inside, inside)
            threading.Event().wait(0.05)
            with gate:
                inside -= 1

    threads = [threading.Thread(target=enter) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most_inside == 1


def test_waiting_for_a_lock_ends(cache: Cache) -> None:
    with (
        cache.single_flight(KEY, 1.0),
        pytest.raises(TimeoutError, match="held"),
        cache.single_flight(KEY, 0.1),
    ):
        pass


def test_the_directory_comes_from_the_environment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(DIRECTORY_VARIABLE, str(tmp_path))
    assert Cache().path.parent == tmp_path


@pytest.mark.skipif(sys.platform != "linux", reason="XDG directories")
def test_the_directory_is_the_user_cache_otherwise(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(DIRECTORY_VARIABLE, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert Cache().path.parent == tmp_path / "satcheck"
