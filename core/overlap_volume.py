"""Measures the overlap of two solids, its volume or its surface, with manifold3d in a child."""

from __future__ import annotations

import math
from types import TracebackType
from typing import Any, Final

import msgspec
from msgspec import Struct

from satcheck._native.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.core.worker_errors import WorkerError

_SERVER: Final = "satcheck.core.manifold_server"


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
        self._worker = Worker(_SERVER, megabytes=megabytes)

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
