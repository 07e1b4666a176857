"""Which worlds a shard has."""

from __future__ import annotations

from satcheck.audit.batch.manifest import Shard

WORLDS = [(f"scenes/{number}.toml",) for number in range(10_000)]


def test_each_world_is_in_one_shard() -> None:
    shards = [Shard(number, 7) for number in range(1, 8)]
    assert {sum(shard.has(world) for shard in shards) for world in WORLDS} == {1}
    assert all(Shard(1, 1).has(world) for world in WORLDS)


def test_shards_are_of_similar_size() -> None:
    """The number of worlds in one of 8 shards is binomial: 1,250 with a deviation of 33. Six of
    these are no chance."""
    for number in range(1, 9):
        assert abs(sum(Shard(number, 8).has(world) for world in WORLDS) - 1250) < 6 * 33


def test_the_shard_of_a_world_never_changes() -> None:
    """Shards of one batch may be checked years apart, by other versions."""
    of_three = [next(n for n in (1, 2, 3) if Shard(n, 3).has(w)) for w in WORLDS[:9]]
    assert of_three == [3, 3, 1, 2, 2, 3, 1, 3, 3]
    assert Shard(298, 1000).has(("a", "bc"))
    assert not Shard(298, 1000).has(("ab", "c"))
