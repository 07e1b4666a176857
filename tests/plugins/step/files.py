"""Writes small STEP files: boxes and cylinders as boundary surfaces, and an assembly of them."""

from __future__ import annotations

from collections.abc import Sequence

Point = tuple[float, float, float]
_UNITS = {
    "mm": "SI_UNIT(.MILLI.,.METRE.)",
    "m": "SI_UNIT($,.METRE.)",
}
_SIDES = (  # corners of a box, counter-clockwise from outside; corner = x + 2 y + 4 z
    (0, 2, 3, 1),
    (4, 5, 7, 6),
    (0, 1, 5, 4),
    (2, 6, 7, 3),
    (0, 4, 6, 2),
    (1, 3, 7, 5),
)


class StepFile:
    """Records with numbers. Each method returns the number of the record that it is about."""

    def __init__(self, unit: str = "mm") -> None:
        self._records: list[str] = []
        self._unit = unit
        application = self.add("APPLICATION_CONTEXT('mechanical design')")
        self._product_context = self.add(f"PRODUCT_CONTEXT('',#{application},'mechanical')")
        self._definition_context = self.add(
            f"PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"
        )
        self.context = self._context(unit)
        self.origin = self.frame((0, 0, 0))

    def add(self, record: str) -> int:
        self._records.append(record)
        return len(self._records)

    def text(self, schema: str = "AUTOMOTIVE_DESIGN") -> str:
        lines = [f"#{number}={record};" for number, record in enumerate(self._records, 1)]
        return "\n".join(
            [
                "ISO-10303-21;",
                "HEADER;",
                "FILE_DESCRIPTION((''),'2;1');",
                "FILE_NAME('','',(''),(''),'','','');",
                f"FILE_SCHEMA(('{schema}'));",
                "ENDSEC;",
                "DATA;",
                *lines,
                "ENDSEC;",
                "END-ISO-10303-21;",
                "",
            ]
        )

    def _context(self, unit: str) -> int:
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        if unit == "in":
            metric = self.add(f"(LENGTH_UNIT()NAMED_UNIT(*){_UNITS['mm']})")
            factor = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{metric})")
            sizes = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            length = self.add(
                f"(CONVERSION_BASED_UNIT('INCH',#{factor})LENGTH_UNIT()NAMED_UNIT(#{sizes}))"
            )
        else:
            length = self.add(f"(LENGTH_UNIT()NAMED_UNIT(*){_UNITS[unit]})")
        precision = self.add(
            f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),#{length},'','')"
        )
        return self.add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
            f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{precision}))"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid}))"
            "REPRESENTATION_CONTEXT('',''))"
        )

    def point(self, at: Point) -> int:
        return self.add(f"CARTESIAN_POINT('',({_numbers(at)}))")

    def direction(self, towards: Point) -> int:
        return self.add(f"DIRECTION('',({_numbers(towards)}))")

    def frame(self, at: Point, z: Point = (0, 0, 1), x: Point = (1, 0, 0)) -> int:
        point, up, right = self.point(at), self.direction(z), self.direction(x)
        return self.add(f"AXIS2_PLACEMENT_3D('',#{point},#{up},#{right})")

    def box(self, low: Point, high: Point, *, sides: int = 6) -> int:
        """A solid; with fewer sides a surface model that is open."""
        ends = (low, high)
        corners = [tuple(ends[k >> axis & 1][axis] for axis in range(3)) for k in range(8)]
        vertices = [self.add(f"VERTEX_POINT('',#{self.point(at)})") for at in corners]  # type: ignore[arg-type]
        edges: dict[tuple[int, int], int] = {}
        faces = []
        for side in _SIDES[:sides]:
            loop = []
            for start, end in zip(side, (*side[1:], side[0]), strict=True):
                first, last = min(start, end), max(start, end)
                if (first, last) not in edges:
                    along = [b - a for a, b in zip(corners[first], corners[last], strict=True)]
                    line = self._line(corners[first], along)
                    edges[first, last] = self.add(
                        f"EDGE_CURVE('',#{vertices[first]},#{vertices[last]},#{line},.T.)"
                    )
                forward = "T" if start == first else "F"
                loop.append(self.add(f"ORIENTED_EDGE('',*,*,#{edges[first, last]},.{forward}.)"))
            faces.append(self._plane(loop, [corners[k] for k in side]))
        return self._shell(faces, closed=sides == 6)

    def cylinder(self, radius: float, height: float) -> int:
        """About the z axis, upward from the origin."""
        rims = []
        for z in (0.0, height):
            vertex = self.add(f"VERTEX_POINT('',#{self.point((radius, 0, z))})")
            circle = self.add(f"CIRCLE('',#{self.frame((0, 0, z))},{_numbers((radius,))})")
            rims.append((vertex, self.add(f"EDGE_CURVE('',#{vertex},#{vertex},#{circle},.T.)")))
        (low, lower), (high, upper) = rims
        line = self._line((radius, 0, 0), (0, 0, height))
        seam = self.add(f"EDGE_CURVE('',#{low},#{high},#{line},.T.)")
        around = self._loop([(lower, "T"), (seam, "T"), (upper, "F"), (seam, "F")])
        surface = self.add(f"CYLINDRICAL_SURFACE('',#{self.origin},{_numbers((radius,))})")
        faces = [self.add(f"ADVANCED_FACE('',({around}),#{surface},.T.)")]
        for edge, z, sense in ((lower, 0.0, "F"), (upper, height, "T")):
            plane = self.add(f"PLANE('',#{self.frame((0, 0, z))})")
            bound = self._loop([(edge, sense)])
            faces.append(self.add(f"ADVANCED_FACE('',({bound}),#{plane},.{sense}.)"))
        return self._shell(faces, closed=True)

    def product(self, name: str, items: Sequence[int], kind: str = "ADVANCED_BREP_") -> int:
        """A product whose shape is these items; its shape representation is the record after it."""
        product = self.add(f"PRODUCT('{name}','{name}','',(#{self._product_context}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        definition = self.add(f"PRODUCT_DEFINITION('','',#{formation},#{self._definition_context})")
        listed = ",".join(f"#{item}" for item in (self.origin, *items))
        shape = self.add(f"{kind}SHAPE_REPRESENTATION('',({listed}),#{self.context})")
        owner = self.add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION(#{owner},#{shape})")
        return definition

    def occurrence(self, name: str, whole: int, part: int, at: Point, id_: str = "") -> int:
        """An occurrence of a product in another one, moved by `at`."""
        used = self.add(
            f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{id_ or name}','{name}','',#{whole},#{part},$)"
        )
        owner = self.add(f"PRODUCT_DEFINITION_SHAPE('','',#{used})")
        place = self.frame(at)
        moved = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',#{self.origin},#{place})")
        relation = self.add(
            f"(REPRESENTATION_RELATIONSHIP('','',#{part + 1},#{whole + 1})"
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{moved})"
            "SHAPE_REPRESENTATION_RELATIONSHIP())"
        )
        self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{owner})")
        return used

    def _line(self, at: Sequence[float], along: Sequence[float]) -> int:
        start, towards = self.point(tuple(at)), self.direction(tuple(along))  # type: ignore[arg-type]
        vector = self.add(f"VECTOR('',#{towards},1.)")
        return self.add(f"LINE('',#{start},#{vector})")

    def _loop(self, edges: Sequence[tuple[int, str]]) -> str:
        oriented = [self.add(f"ORIENTED_EDGE('',*,*,#{edge},.{sense}.)") for edge, sense in edges]
        return self._bound(oriented)

    def _bound(self, oriented: Sequence[int]) -> str:
        listed = ",".join(f"#{edge}" for edge in oriented)
        loop = self.add(f"EDGE_LOOP('',({listed}))")
        bound = self.add(f"FACE_OUTER_BOUND('',#{loop},.T.)")
        return f"#{bound}"

    def _plane(self, oriented: Sequence[int], corners: Sequence[tuple[float, ...]]) -> int:
        a, b, d = corners[0], corners[1], corners[3]
        u = [q - p for p, q in zip(a, b, strict=True)]
        v = [q - p for p, q in zip(a, d, strict=True)]
        normal = tuple(u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3))
        frame = self.frame(tuple(a), normal, tuple(u))  # type: ignore[arg-type]
        plane = self.add(f"PLANE('',#{frame})")
        return self.add(f"ADVANCED_FACE('',({self._bound(oriented)}),#{plane},.T.)")

    def _shell(self, faces: Sequence[int], *, closed: bool) -> int:
        listed = ",".join(f"#{face}" for face in faces)
        if closed:
            shell = self.add(f"CLOSED_SHELL('',({listed}))")
            return self.add(f"MANIFOLD_SOLID_BREP('',#{shell})")
        shell = self.add(f"OPEN_SHELL('',({listed}))")
        return self.add(f"SHELL_BASED_SURFACE_MODEL('',(#{shell}))")


def _numbers(values: Sequence[float]) -> str:
    return ",".join(repr(float(value)) for value in values)


def rig(unit: str = "mm", size: float = 1.0) -> str:
    """A pin that enters a plate by 2 mm, and a second plate without a name, 7 mm above the pin.

    size: of a millimetre in the unit.
    """
    file = StepFile(unit)
    whole = file.product("rig", [], kind="")
    high = (20 * size, 20 * size, 5 * size)
    plate = file.product("plate", [file.box((-20 * size, -20 * size, 0), high)])
    pin = file.product("pin", [file.cylinder(4 * size, 30 * size)])
    file.occurrence("base", whole, plate, (0, 0, 0))
    file.occurrence("", whole, plate, (0, 0, 40 * size), id_="NAUO7")
    file.occurrence("pin 1", whole, pin, (0, 0, 3 * size))
    return file.text()
