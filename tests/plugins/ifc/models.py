"""Small IFC files written by hand: boxes, with placements, relations and units."""

from __future__ import annotations

from collections.abc import Sequence

HEAD = (
    "ISO-10303-21;HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');"
    "FILE_SCHEMA(('{schema}'));ENDSEC;DATA;"
)
FOOT = "ENDSEC;END-ISO-10303-21;"
MILLIMETRES = "IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)"
METRES = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)"
CONTEXT = "IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,{wcs},$)"


class Model:
    """Collects instances. Every method adds some, and returns the reference to the last one."""

    def __init__(self, unit: str = METRES, schema: str = "IFC4", context: str = CONTEXT) -> None:
        self._schema = schema
        self._lines: list[str] = []
        self._guids = 0
        self.origin = self.placement(0, 0, 0)
        self.context = self.add(context.format(wcs=self.origin)) if context else "$"
        units = self.add(f"IFCUNITASSIGNMENT(({self.add(unit)}))") if unit else "$"
        contexts = f"({self.context})" if context else "$"
        self.add(f"IFCPROJECT('{self.guid()}',$,'Project',$,$,$,$,{contexts},{units})")

    def add(self, text: str) -> str:
        self._lines.append(text)
        return f"#{len(self._lines)}"

    def guid(self) -> str:
        self._guids += 1
        return f"0000000000000000000{self._guids:03d}"

    def placement(self, x: float, y: float, z: float) -> str:
        point = self.add(f"IFCCARTESIANPOINT(({float(x)},{float(y)},{float(z)}))")
        return self.add(f"IFCAXIS2PLACEMENT3D({point},$,$)")

    def local(self, at: Sequence[float] = (0, 0, 0), within: str = "$") -> str:
        return self.add(f"IFCLOCALPLACEMENT({within},{self.placement(*at)})")

    def block(self, size: Sequence[float]) -> str:
        """A solid from its lowest corner."""
        x, y, z = map(float, size)
        centre = self.add(f"IFCCARTESIANPOINT(({x / 2},{y / 2}))")
        place = self.add(f"IFCAXIS2PLACEMENT2D({centre},$)")
        profile = self.add(f"IFCRECTANGLEPROFILEDEF(.AREA.,$,{place},{x},{y})")
        up = self.add("IFCDIRECTION((0.,0.,1.))")
        return self.add(f"IFCEXTRUDEDAREASOLID({profile},{self.origin},{up},{z})")

    def shape(self, *items: str, identifier: str = "'Body'", kind: str = "SweptSolid") -> str:
        return self.add(
            f"IFCSHAPEREPRESENTATION({self.context},{identifier},'{kind}',({','.join(items)}))"
        )

    def element(
        self,
        shape: str | None,
        at: Sequence[float] = (0, 0, 0),
        kind: str = "IFCBUILDINGELEMENTPROXY",
        more: str = ",$,$",
        name: str = "$",
        guid: str | None = None,
    ) -> str:
        """more: its attributes after the representation."""
        product = self.add(f"IFCPRODUCTDEFINITIONSHAPE($,$,({shape}))") if shape else "$"
        place = self.local(at)
        return self.add(f"{kind}('{guid or self.guid()}',$,{name},$,$,{place},{product}{more})")

    def box(self, size: Sequence[float], at: Sequence[float] = (0, 0, 0), **more: str) -> str:
        return self.element(self.shape(self.block(size)), at, **more)

    def relation(self, kind: str, rest: str) -> str:
        return self.add(f"{kind}('{self.guid()}',$,$,$,{rest})")

    def text(self) -> str:
        lines = "".join(f"#{number}={line};" for number, line in enumerate(self._lines, 1))
        return HEAD.format(schema=self._schema) + lines + FOOT

    def bytes(self) -> bytes:
        return self.text().encode()
