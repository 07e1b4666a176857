"""What two solids have in common, its volume or its surface, by manifold3d in a child process."""

from __future__ import annotations

import math
from types import TracebackType
from typing import Any, Final

import msgspec
from msgspec import Struct

from satcheck._native.core import Mesh
from satcheck.core.errors import SatcheckError
from satcheck.core.worker import Worker, WorkerError

_SERVER: Final = "satcheck.core.manifold_server"


class OverlapVolume(Struct, frozen=True):
    """volume: in float64. error: what moving both surfaces by the tolerance of the Boolean changes
    at most; an estimate of how far off it is, not a proof."""

    volume: float
    error: float


class VolumeMeter:
    """Measures common volumes, one pair after another in one child; to be used in a `with`.

    seconds: for one pair. megabytes: of the child. Nothing starts before the first pair.
    """

    def __init__(self, *, seconds: float, megabytes: int) -> None:
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
        """Of two solids whose winding numbers are 0 and 1 only.

        Raises SatcheckError: `volume-refused` when manifold3d cannot use one of the meshes,
        `volume-out-of-range` when it is no float64, `volume-failed` when the child gave no answer.
        """
        answer = self._answer("volume", a, b)
        scale = 3 * answer["exponent"]
        try:
            volume = math.ldexp(answer["volume"], scale)
            return OverlapVolume(volume, math.ldexp(answer["error"], scale))
        except OverflowError as error:
            raise SatcheckError("volume-out-of-range", "the volume is no float64") from error

    def common(self, a: Mesh, b: Mesh) -> Mesh | None:
        """The surface of what they have in common; None: nothing. Of solids as in `measure`, and
        it raises the same errors."""
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
