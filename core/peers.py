"""Queries other libraries in child processes, because they may abort, hang or be wrong.

manifold3d measures the overlap of two solids, its volume or its surface. python-fcl is a second
opinion on whether surfaces meet.
"""

from __future__ import annotations

import math
from contextlib import ExitStack
from types import TracebackType
from typing import Any, Final

import msgspec
from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.core.worker_errors import WorkerError

_MANIFOLD_SERVER: Final = "satcheck.core.manifold_server"
_FCL_SERVER: Final = "satcheck.core.fcl_server"


class OverlapVolume(Struct, frozen=True):
    """volume: in float64. error: the largest change of the volume if both surfaces move by the
    tolerance of the Boolean. It is an estimate and not a proof."""

    volume: float
    error: float


class VolumeMeter:
    """Measures common volumes, one pair after another, in one child. Use it in a `with` statement.

    seconds: for one pair. megabytes: of the child. Nothing starts before the first pair.
    """

    def __init__(self, *, seconds: float, megabytes: int) -> None:
        from satcheck.core.worker import Worker

        self._seconds = seconds
        self._worker = Worker(_MANIFOLD_SERVER, megabytes=megabytes)

    def __enter__(self) -> VolumeMeter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._worker.close()

    def measure(self, a: Mesh, b: Mesh) -> OverlapVolume:
        """The common volume of two solids whose winding numbers are 0 and 1 only.

        Raises SatcheckError: `volume-refused` if manifold3d cannot use a mesh,
        `volume-failed` if the child gave no answer.
        """
        answer = self._answer("volume", a, b)
        scale = 3 * answer["exponent"]
        volume = math.ldexp(answer["volume"], scale)
        return OverlapVolume(volume, math.ldexp(answer["error"], scale))

    def common(self, a: Mesh, b: Mesh) -> Mesh | None:
        """The surface of the overlap of two solids; None: it is empty. Conditions and errors are
        those of `measure`."""
        vertices, triangles = self._answer("mesh", a, b)["mesh"]
        return Mesh.from_bytes(vertices, triangles) if triangles else None

    def _answer(self, wanted: str, a: Mesh, b: Mesh) -> dict[str, Any]:
        request = msgspec.msgpack.encode((wanted, [*a.to_bytes(), *b.to_bytes()]))
        try:
            reply = self._worker.ask(request, seconds=self._seconds)
        except WorkerError as error:
            raise SatcheckError("volume-failed", f"no volume: {error.message}") from error
        answer: dict[str, Any] = msgspec.msgpack.decode(reply)
        if "refused" in answer:
            which = {0: "A: ", 1: "B: "}.get(answer["which"], "")
            raise SatcheckError("volume-refused", f"manifold3d says {which}{answer['refused']}")
        return answer


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
