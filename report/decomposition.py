"""The convex parts of bodies, with their measured error: what `satcheck decompose` did."""

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
    """Why a body has no parts, or what a reader of its parts should know."""

    code: Code
    message: str


class DecomposedBody(Value, frozen=True, kw_only=True):
    """A body, and its parts or why there are none.

    triangles: of the body. outside: the parts stick out of the mesh by at most this. missing: the
    mesh sticks out of the union of the parts by at most this. failure: why there are no parts;
    None: there are. seconds: wall clock of the computation, also if the parts came from the cache.
    """

    id: str
    file: str
    triangles: Count
    parts: tuple[Part, ...] | None = None
    outside: Length | None = None
    missing: Length | None = None
    failure: Remark | None = None
    seconds: Length | UnsetType = UNSET
    from_cache: bool | UnsetType = UNSET
    notes: tuple[Remark, ...] | UnsetType = UNSET


class DecompositionOptions(Value, frozen=True, kw_only=True):
    """threshold: the concavity at which CoACD stops splitting, in its own measure. seed: of its
    random search. seconds: the time limit of one body."""

    threshold: Annotated[float, Meta(gt=0, le=1)]
    seed: Count
    seconds: Size


class DecompositionReport(Value, frozen=True, kw_only=True):
    """Bodies as convex parts, with their measured error. World frame, lengths in the units of the
    files.

    units: as the inputs declare them. output: the file the parts were written to; None: no file.
    rounding: how far a vertex in that file is at most from the vertex of its part: GLB and STL hold
    32-bit floats; None: no file. bodies: in the order of the inputs. issues: about the inputs.
    """

    schema: Literal["satcheck.decomposition/1"] = "satcheck.decomposition/1"
    tool: Tool
    units: str | None
    settings: DecompositionOptions
    output: str | None
    rounding: Length | None
    bodies: tuple[DecomposedBody, ...]
    issues: tuple[Issue, ...]
