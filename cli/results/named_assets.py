"""Assets, as renderers iterate over them: from memory, or from results files."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from satcheck.batch.stored import StoredResults
from satcheck.report.assets import Asset
from satcheck.report.report import Report


class Assets:
    """The reports of assets by name (`cli.formats.ci.Reports`)."""

    def __init__(self, assets: Collection[Asset]) -> None:
        self._assets = assets

    def __len__(self) -> int:
        return len(self._assets)

    def __iter__(self) -> Iterator[Asset]:
        return iter(self._assets)

    def items(self) -> Iterator[tuple[str, Report]]:
        return ((asset.file, asset.report) for asset in self)

    def values(self) -> Iterator[Report]:
        return (asset.report for asset in self)


class StoredAssets(Assets):
    """Each iteration reads the files again."""

    def __init__(self, results: StoredResults) -> None:
        self._results = results

    def __len__(self) -> int:
        return len(self._results)

    def __iter__(self) -> Iterator[Asset]:
        return (stored.asset for stored in self._results)
