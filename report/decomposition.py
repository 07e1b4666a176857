"""The report of `satcheck decompose`: the convex parts of bodies, with their measured error."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, UnsetType

from satcheck.report.report import Issue
from satcheck.report.values import Code, Count, Length, Size, Tool, Value


class Part(Value, frozen=True):
    """A convex mesh. name: of its node or object in the file."""

    name: str
    vertices: Count
    triangles: Count


class Remark(Value, frozen=True):
    """The reason why a body has no parts, or a remark about its parts."""

    code: Code
    message: str


class DecomposedBody(Value, frozen=True, kw_only=True):
    """A body with its parts, or with the reason why it has none.

    triangles: of the body. outside: the parts stick out of the mesh by at most this. missing: the
    mesh sticks out of the union of the parts by at most this. encloses: whether it is proven that
    the parts, as written, contain the surface of the mesh; None: not asked. failure: why there are
    no parts; None: there are parts. seconds: wall clock of the computation, even if the parts came
    from the cache.
    """

    id: str
    file: str
    triangles: Count
    parts: tuple[Part, ...] | None = None
    outside: Length | None = None
    missing: Length | None = None
    encloses: bool | None = None
    failure: Remark | None = None
    seconds: Length | UnsetType = UNSET
    from_cache: bool | UnsetType = UNSET
    notes: tuple[Remark, ...] | UnsetType = UNSET


class DecompositionOptions(Value, frozen=True, kw_only=True):
    """threshold: the concavity at which CoACD stops splitting, in its own measure. seed: of its
    random search. max_parts: of a mesh. max_vertices: of a part; None: any number. enclose: the
    parts have to contain the mesh. seconds: the time limit for one body."""

    threshold: Annotated[float, Meta(gt=0, le=1)]
    seed: Count
    max_parts: Count | None
    max_vertices: Count | None
    enclose: bool
    seconds: Size


class DecompositionReport(Value, frozen=True, kw_only=True):
    """The convex parts of bodies, with their measured error. World frame, lengths in the units of
    the files.

    units: as the inputs declare them. output: the file the parts were written to; None: no file.
    rounding: the largest distance between a vertex in the file and the vertex of its part, because
    GLB and STL hold 32-bit floats; None: no file. bodies: in the order of the inputs. issues: about
    the inputs.
    """

    schema: Literal["satcheck.decomposition/1"] = "satcheck.decomposition/1"
    tool: Tool
    units: str | None
    settings: DecompositionOptions
    output: str | None
    rounding: Length | None
    bodies: tuple[DecomposedBody, ...]
    issues: tuple[Issue, ...]
