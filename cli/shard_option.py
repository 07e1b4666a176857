"""The type of the option `--shard I/N`."""

from __future__ import annotations

import re

import click

from satcheck.batch.shard import Shard

_FORM = re.compile(r"(\d{1,9})/(\d{1,9})")


class ShardType(click.ParamType[Shard]):
    name = "shard"

    def convert(
        self, value: object, param: click.Parameter | None, ctx: click.Context | None
    ) -> Shard:
        if isinstance(value, Shard):
            return value
        given = _FORM.fullmatch(str(value))
        if given is None:
            self.fail(f"{value!r} is not I/N, as 3/8", param, ctx)
        shard = Shard(int(given[1]), int(given[2]))
        if not 1 <= shard.number <= shard.count:
            self.fail(f"{value}: the first number is from 1 to the second", param, ctx)
        return shard
