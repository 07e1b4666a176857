"""Makes a scene of a stage: a node for each body, with its mesh or exact shape."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pxr import Gf, Tf, UsdGeom, UsdPhysics

from satcheck.core.shapes import HalfSpace, Primitive
from satcheck.core.transform import Transform
from satcheck.plugins.usd.choice import Choice, hidden_geometry, without_extent
from satcheck.plugins.usd.layers import look_at_layers
from satcheck.plugins.usd.mesh import Skinning, read_mesh, read_tetrahedra
from satcheck.plugins.usd.names import TYPES
from satcheck.plugins.usd.physics import with_physics
from satcheck.plugins.usd.shapes import facets_around, placed_shape, shape_of
from satcheck.plugins.usd.stage import Remarks, Stage, lost_by, missing_variants, said
from satcheck.plugins.usd.unknown import look_at_stage
from satcheck.plugins.usd.walk import WORLD, PlacedPrim, Walk, type_of
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Document, Item, RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.nodes import hull_of
from satcheck.scene.files.placing import Parts
from satcheck.scene.issue import CODES

# Approximations that reach out of the mesh.
_LARGER = (UsdPhysics.Tokens.boundingCube, UsdPhysics.Tokens.boundingSphere)
_NOT_TURNED = Gf.Matrix4d(1.0)
Content = RawMesh | Primitive | Refusal


class Reading:
    def __init__(self, stage: Stage, options: Mapping[str, Any]) -> None:
        self._stage = stage
        self._choice = Choice(options)
        self._said = Remarks()
        self._skinning = Skinning(self._choice.time)
        self._lost = dict(stage.lost)
        self._parts = Parts()
        self._nodes: list[Item] = []
        self._placed: list[PlacedPrim] = []
        self._read: dict[Any, tuple[Content, Any]] = {}

    def scene(self) -> Document:
        """Raises Refused if the stage has no body."""
        self._refuse_lost_in_instances()
        look_at_stage(self._stage.stage, self._choice, self._said)
        look_at_layers(self._stage.stage, self._said)
        self._lost |= lost_by(self._stage.stage, missing_variants)
        for placed in Walk(self._stage.stage, self._choice.time).prims():
            self._take(placed)
        for name, reason in self._lost.items():
            self._add(PlacedPrim(name, None, WORLD), reason)
        warnings = (*self._stage.warnings, *self._said.warnings())
        if not self._nodes:
            reasons = "; ".join(message for _, message in warnings)
            is_explained = all(CODES[code].severity == "note" for code, _ in warnings)
            code = "no-body" if is_explained else "empty-mesh"
            raise Refused(code, f"the stage has no body. {reasons}".strip())
        said = Remarks()
        stage, time = self._stage, self._choice.time
        nodes, rules, joints = with_physics(stage, self._nodes, self._placed, time, said)
        said_of = (*warnings, *said.warnings())
        return Document(self._parts.all(), nodes, said_of, stage.unit, rules, joints)

    def _refuse_lost_in_instances(self) -> None:
        """A reference is lost in every instance, and composition names one of them or none."""
        stage = self._stage.stage
        if not self._lost or not (
            stage.GetPrototypes()
            or any(prim.IsA(UsdGeom.PointInstancer) for prim in stage.Traverse())
        ):
            return
        name, reason = next(iter(self._lost.items()))
        message = f"{name}: {reason.message} (the stage has instances, which may lack it, too)"
        raise Refused(reason.code, message)

    def _take(self, placed: PlacedPrim) -> None:
        """Adds the body of a prim, if it is one."""
        prim, name = placed.prim, placed.name
        refusal = placed.refusal or self._lost.pop(name, None)
        if not prim.IsA(UsdGeom.Gprim) and refusal is None:
            self._look_at_other(placed)
        elif (reason := self._choice.why_not(placed, lost=refusal is not None)) is not None:
            self._said.add("not-a-body", reason, name)
        elif refusal is not None:
            self._add(placed, refusal)
        elif (words := without_extent(prim, self._choice)) is not None:
            self._said.add("ignored-geometry", words, name)
        else:
            self._place(placed)

    def _look_at_other(self, placed: PlacedPrim) -> None:
        """At a prim that is no known geometry."""
        prim, name = placed.prim, placed.name
        if (reason := hidden_geometry(prim, self._choice)) is not None:
            if self._choice.why_not(placed, lost=True) is None:
                self._add(placed, reason)
        elif prim.GetTypeName() and not type_of(prim) and not TYPES.knows(prim.GetTypeName()):
            self._said.add("unread", f"prims of the type {prim.GetTypeName()} are not known", name)
        elif self._choice.collides(prim):
            words = f"a collider of type {prim.GetTypeName()}, without geometry"
            self._said.add("ignored-geometry", words, name)

    def _place(self, placed: PlacedPrim) -> None:
        prim = placed.prim
        key = prim.GetPrimInPrototype().GetPath() if prim.IsInstanceProxy() else prim.GetPath()
        if key not in self._read:
            self._read[key] = self._content(prim)
        content, turn = self._read[key]
        if isinstance(content, Refusal):
            self._add(placed, content)
            return
        matrix = self._stage.matrix(turn * placed.matrix)
        if not isinstance(content, RawMesh | HalfSpace):
            try:
                matrix = placed_shape(content, matrix)
            except ValueError as error:
                words = f"{error}, so it is checked as facets around it"
                self._said.add("faceted", words, placed.name)
                content = facets_around(content, self._stage.unit)
        self._add(placed, content, None if matrix == IDENTITY else matrix)

    def _content(self, prim: Any) -> tuple[Content, Any]:
        """(mesh or shape of a prim in its own coordinates, a turn before its placement)."""
        time, unit = self._choice.time, self._stage.unit
        try:
            shape = shape_of(prim, time, unit, endless=self._choice.colliders)
            if shape is not None:
                return shape
            if prim.IsA(UsdGeom.Mesh):
                return self._mesh(prim), _NOT_TURNED
            if prim.IsA(UsdGeom.TetMesh):
                return read_tetrahedra(prim, time, unit), _NOT_TURNED
        except Refused as error:
            return Refusal(error.code, error.message), _NOT_TURNED
        except Tf.ErrorException as error:
            return Refusal("bad-record", said(error)), _NOT_TURNED
        message = f"geometry of the type {type_of(prim)} is not read: convert it to a Mesh"
        return Refusal("unsupported-feature", message), _NOT_TURNED

    def _mesh(self, prim: Any) -> RawMesh:
        mesh = read_mesh(prim, self._choice.time, self._stage.unit)
        scheme = UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr().Get(self._choice.time)
        name = str(prim.GetPath())
        if scheme != UsdGeom.Tokens.none:
            self._said.add(
                "control-cage", f"subdivision surface ({scheme}), checked as its control cage", name
            )
        if (moved := self._skinning.moved(prim, mesh)) is not None:
            self._said.add("rest-shape", "skinned, it stands as its skeleton does", name)
            mesh = moved
        return self._simulated(prim, mesh) if self._choice.colliders else mesh

    def _simulated(self, prim: Any, mesh: RawMesh) -> RawMesh:
        """The convex hull if the simulator takes that. Other approximations are named."""
        api = UsdPhysics.MeshCollisionAPI(prim)
        kind = api.GetApproximationAttr().Get() if api else UsdPhysics.Tokens.none
        if kind in (None, UsdPhysics.Tokens.none):
            return mesh
        if kind == UsdPhysics.Tokens.convexHull:
            return hull_of(mesh)
        words = f"a simulator takes its {kind}, its mesh is checked"
        code = "unread" if kind in _LARGER else "simplified-mesh"
        self._said.add(code, words, str(prim.GetPath()))
        return mesh

    def _add(self, placed: PlacedPrim, content: Content, matrix: Transform | None = None) -> None:
        part = self._parts.number(placed.name, content)
        self._nodes.append(Item(part, placed.name, matrix))
        self._placed.append(placed)
