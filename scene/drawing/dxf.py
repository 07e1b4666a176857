"""Reads DXF with ezdxf: the closed lines and filled areas that are visible in the model space.

A block reference is one shape, with the closed lines inside others as holes. A closed line outside
any block is a shape of its own. The format does not say whether a line inside another is a hole or
a misplaced part. A hole that is read as a part shows up as an overlap, while a part that is read as
a hole would hide one. Separate lines and arcs that join end to end form a closed line.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator
from typing import Any

from msgspec.structs import replace

from satcheck.scene.drawing.contour import (
    Affine,
    Contour,
    Drawing,
    DrawnShape,
    RefusedShape,
    Tracer,
)
from satcheck.scene.drawing.dxf_entities import ANNOTATIONS, Outline, outline_of
from satcheck.scene.drawing.joining import Line, join
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.limits import MAX_DEPTH
from satcheck.scene.loading.placing import refuse_explosion

_UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 13: "um"}
_OF_THE_REFERENCE = "0"  # entities of a block on this layer take the layer of the block reference


def read_dxf(data: bytes) -> Drawing:
    """The shapes of a drawing; raises MeshFileError without a file name."""
    from ezdxf import recover
    from ezdxf.lldxf.const import DXFError

    if not data.rstrip(b"\0 \r\n\t").endswith(b"EOF"):  # ezdxf silently repairs truncated files
        raise MeshFileError("bad-record", "not a DXF file, or truncated: it does not end with EOF")
    try:
        document, auditor = recover.read(io.BytesIO(data))
    except (DXFError, OSError, ValueError) as error:
        raise MeshFileError("bad-record", f"not readable as DXF: {error}") from None
    if auditor.has_errors:
        raise MeshFileError("bad-record", f"damaged: {auditor.errors[0].message}")
    units = _UNITS.get(int(document.header.get("$INSUNITS", 0)))
    reading = _Reading(document)
    shapes = tuple(reading.shapes())
    return Drawing(shapes, units, tuple(sorted(reading.warnings)))


class _Reading:
    def __init__(self, document: Any) -> None:
        self._document = document
        self._blocks: dict[tuple[str, str], list[Outline]] = {}
        self.warnings: set[str] = set()

    def shapes(self) -> Iterator[DrawnShape | RefusedShape]:
        space = self._document.modelspace()
        root = str(space.block_record_name)
        refuse_explosion([root], self._held, self._size, lambda name: f"block {name!r}", MAX_DEPTH)
        loose: list[Outline] = []
        for entity in self._shown(space, _OF_THE_REFERENCE):
            kind, handle = entity.dxftype(), entity.dxf.handle
            is_block = kind == "INSERT"
            name = f"{entity.dxf.name if is_block else kind}/{handle}"
            try:
                if is_block:
                    yield from self._references(name, entity)
                elif outline := outline_of(entity):
                    if outline.kind == "filled":
                        yield DrawnShape(name, (), "nonzero", self._closed([outline]))
                    else:
                        loose.append(outline)
            except MeshFileError as error:
                yield RefusedShape(name, error.code, error.message)
        try:
            for number, contour in enumerate(self._contours(loose), 1):
                yield DrawnShape(f"contour{number}", (contour,), "nonzero")
        except MeshFileError as error:
            yield RefusedShape("lines", error.code, error.message)

    def _held(self, block: str) -> Iterator[tuple[str, int]]:
        entities = self._document.blocks.get(block) or ()
        references = [entity for entity in entities if entity.dxftype() == "INSERT"]
        yield from ((entity.dxf.name, max(1, entity.mcount)) for entity in references)

    def _size(self, block: str) -> int:
        return len(self._document.blocks.get(block) or ())

    def _shown(self, entities: Iterable[Any], layer: str) -> Iterator[Any]:
        """The visible entities. layer: of the block reference."""
        for entity in entities:
            if self._is_hidden(entity, layer):
                self.warnings.add("entities that are invisible, or on layers off, are left out")
            elif entity.dxftype() in ANNOTATIONS:
                self.warnings.add("annotations are ignored")
            else:
                yield entity

    def _is_hidden(self, entity: Any, reference: str) -> bool:
        name = self._layer(entity, reference)
        layers = self._document.layers
        layer = layers.get(name) if layers.has_entry(name) else None
        if entity.dxf.get("invisible", 0) or (layer is not None and layer.is_frozen()):
            return True
        # Entities of a block follow their own layers, unless the layer of the reference is
        # frozen.
        return layer is not None and layer.is_off() and entity.dxftype() != "INSERT"

    def _layer(self, entity: Any, reference: str) -> str:
        name = str(entity.dxf.layer)
        return reference if name == _OF_THE_REFERENCE else name

    def _references(self, name: str, insert: Any) -> Iterator[DrawnShape]:
        """A shape for each copy of an array."""
        within = self._within(insert, _OF_THE_REFERENCE)
        affines = _affines(insert)
        for number, affine in enumerate(affines, 1):
            outlines = [outline.mapped(affine) for outline in within]
            contours = tuple(self._contours([o for o in outlines if o.kind != "filled"]))
            filled = self._closed([o for o in outlines if o.kind == "filled"])
            if contours or filled:
                copy = name if len(affines) == 1 else f"{name}/{number}"
                yield DrawnShape(copy, contours, "evenodd", filled)

    def _within(self, insert: Any, reference: str) -> list[Outline]:
        """The outlines of a block, in its own coordinates; cached for each layer."""
        layer = self._layer(insert, reference)
        key = (insert.dxf.name, layer)
        if key not in self._blocks:
            self._blocks[key] = list(self._block(insert, layer))
        return self._blocks[key]

    def _block(self, insert: Any, layer: str) -> Iterator[Outline]:
        from ezdxf.xclip import XClip

        if XClip(insert).has_clipping_path:
            self.warnings.add("clipped block references are taken whole")
        block = insert.block()
        if block is None or block.block.is_xref:
            what = f"block {insert.dxf.name!r} is in another file, or missing"
            raise MeshFileError("missing-resource", what)
        for entity in self._shown(block, layer):
            if entity.dxftype() != "INSERT":
                if outline := outline_of(entity):
                    yield outline
                continue
            inner = self._within(entity, layer)
            for affine in _affines(entity):
                yield from (outline.mapped(affine) for outline in inner)

    def _contours(self, outlines: Iterable[Outline]) -> Iterator[Contour]:
        """Yields closed contours first. Raises MeshFileError if the other lines branch."""
        outlines = list(outlines)
        yield from self._closed([o for o in outlines if o.kind == "closed"])
        joined = join([Line(o.points, o.deviation) for o in outlines if o.kind == "open"])
        if joined.branching:
            message = "lines meet three or more at a point: draw each outline as a closed polyline"
            raise MeshFileError("unsupported-feature", message)
        if joined.repeated:
            self.warnings.add("lines that are drawn twice are taken once")
        if joined.dead_ends:
            self.warnings.add("open lines are ignored")
        for loop in joined.loops:
            yield from self._closed([Outline(loop.points, loop.deviation, "closed")])

    @staticmethod
    def _closed(outlines: Iterable[Outline]) -> tuple[Contour, ...]:
        contours = []
        for outline in outlines:
            tracer = Tracer(outline.points[0])
            tracer.points(list(outline.points[1:]), outline.deviation)
            contour = tracer.closed()
            if contour is not None:
                contours.append(replace(contour, inscribed=outline.inscribed))
        return tuple(contours)


def _affines(insert: Any) -> list[Affine]:
    """The transforms of its copies, seen from above."""
    copies = insert.multi_insert() if insert.mcount > 1 else [insert]
    return [_affine(copy) for copy in copies]


def _affine(insert: Any) -> Affine:
    rows = [tuple(map(float, row)) for row in insert.matrix44().rows()]  # maps row vectors
    if rows[2][0] != 0 or rows[2][1] != 0:
        message = f"block {insert.dxf.name!r} is turned out of the plane of the drawing"
        raise MeshFileError("unsupported-feature", message)
    return (rows[0][0], rows[1][0], rows[3][0], rows[0][1], rows[1][1], rows[3][1])
