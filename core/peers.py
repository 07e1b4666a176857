"""Queries other libraries in child processes, because they may abort, hang or be wrong."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Final

import msgspec

from satcheck.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.core.overlap_volume import OverlapVolume, VolumeMeter
from satcheck.core.worker_errors import WorkerError

_FCL_SERVER: Final = "satcheck.core.fcl_server"


class Peers:
    """python-fcl and manifold3d. Use it in a `with` statement. A child starts with its first query.

    seconds: for one query. megabytes: of each child.
    """

    def __init__(self, *, seconds: float, megabytes: int, fcl_server: str = _FCL_SERVER) -> None:
        from satcheck.core.worker import Worker

        self._seconds = seconds
        self._fcl = Worker(fcl_server, megabytes=megabytes)
        self._meter = VolumeMeter(seconds=seconds, megabytes=megabytes)
        self._open = ExitStack()

    def __enter__(self) -> Peers:
        self._open.enter_context(self._fcl)
        self._open.enter_context(self._meter)
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def surfaces_meet(self, a: Mesh, b: Mesh) -> bool:
        """The answer of python-fcl. Raises SatcheckError (`cross-check-failed`) if it gives
        none."""
        try:
            reply = self._fcl.ask(
                msgspec.msgpack.encode([*a.to_bytes(), *b.to_bytes()]), seconds=self._seconds
            )
        except WorkerError as error:
            raise SatcheckError("cross-check-failed", error.message) from error
        return reply == b"meet"

    def common_volume(self, a: Mesh, b: Mesh) -> OverlapVolume:
        """The answer of manifold3d. Raises SatcheckError if it cannot use a mesh or gives no
        answer."""
        return self._meter.measure(a, b)
