"""The names of USD at each place: those that are read, and those that are known to be harmless.

The schemas of USD itself are known to the library: a property of a schema is read, or of no concern
for bodies. These tables are about what stands beside the schemas, and about names that are
misspelt. Source: the schemas of UsdGeom, UsdPhysics and UsdSkel.
"""

from __future__ import annotations

from collections.abc import Iterable

from pxr import Usd

from satcheck.scene.vocabulary import Names


def named(text: str) -> frozenset[str]:
    """The words of a text."""
    return frozenset(text.split())


# Properties of schemas that make, move, hide or shape a body.
_SHAPING = named(
    """xformOpOrder visibility purpose points faceVertexCounts faceVertexIndices holeIndices
    orientation subdivisionScheme tetVertexIndices surfaceFaceVertexIndices size radius height axis
    width length radiusTop radiusBottom protoIndices prototypes positions orientations orientationsf
    scales ids invisibleIds inactiveIds velocities angularVelocities accelerations widths
    curveVertexCounts"""
)
OF_ALL_PRIMS = frozenset(("xformOpOrder", "visibility", "purpose"))

LAYER = Names(
    named(
        """metersPerUnit upAxis defaultPrim subLayers subLayerOffsets timeCodesPerSecond relocates
    fallbackPrimTypes expressionVariables startTimeCode endTimeCode"""
    )
)
PRIM = Names(
    named(
        """active instanceable references payload inherits specializes variants variantSets
    apiSchemas clips clipSets relocates specifier typeName kind hidden"""
    )
)
# Kinds of ops, of UsdGeomXformOp.
OPS = Names(
    named(
        """translate translateX translateY translateZ scale scaleX scaleY scaleZ orient transform
        rotateX rotateY rotateZ rotateXYZ rotateXZY rotateYXZ rotateYZX rotateZXY rotateZYX"""
    )
)
# Without a name space.
PROPERTIES = {
    "boundaryInterpolation": "an old name about subdivision; the control cage is checked",
    "proxyPrim": "a prim that is drawn instead, and is a prim of its own",
    "extent": "bounds of what is below",
    "extentsHint": "bounds of what is below",
}
PRIMVARS = Names(
    named(
        """widths skel:jointIndices skel:jointWeights skel:geomBindTransform skel:joints
    skel:skinningMethod"""
    )
)
APIS = Names(
    named(
        """PhysicsCollisionAPI PhysicsMeshCollisionAPI PhysicsRigidBodyAPI PhysicsFilteredPairsAPI
        SkelBindingAPI GeomModelAPI CollectionAPI"""
    ),
    {
        **dict.fromkeys(
            ("Physx*", "Newton*", "Mjc*", "Isaac*", "Robot*", "Preliminary_Physics*"),
            "of a simulator: materials, solvers, sensors, joints",
        ),
        **dict.fromkeys(
            (
                "Pxr*",
                "RiMaterial*",
                "RiSpline*",
                "RiLight*",
                "RiTexture*",
                "RiRenderPass*",
                "Karma*",
                "HoudiniEditable*",
                "HoudiniCamera*",
                "HoudiniViewport*",
                "HoudiniSelectable*",
                "Arnold*",
                "Redshift*",
                "Light*",
                "*LightAPI",
                "*LightFilterAPI",
            ),
            "of a renderer",
        ),
        **dict.fromkeys(("Omni*", "Semantic*", "SceneGraph*", "Nv*"), "of a program: metadata"),
    },
)
TYPES = Names(
    named(
    """Mesh TetMesh Sphere Cube Cylinder Cylinder_1 Cone Capsule Capsule_1 Plane Xform Scope
    PointInstancer SkelRoot"""
),
    {
        **dict.fromkeys(("Omni*", "ComputeGraph*", "Backdrop"), "graphs and settings of a program"),
        **dict.fromkeys(("Isaac*", "Physx*", "Newton*", "Mjc*"), "settings of a simulator"),
        **dict.fromkeys(("Pxr*Filter", "Pxr*Light", "Pxr*Camera"), "of a renderer"),
        **dict.fromkeys(
            ("Preliminary_Action", "Preliminary_Behavior", "Preliminary_Trigger",
             "Preliminary_ReferenceImage", "Preliminary_AnchoringAPI", "RealityKit*"),
            "behaviour in augmented reality",
        ),
    },
)  # fmt: skip
# APIs of colliders that shape them otherwise than `physics:approximation` says.
SHAPES_OF_COLLIDERS = named(
    """PhysxConvexDecompositionCollisionAPI PhysxConvexHullCollisionAPI PhysxSDFMeshCollisionAPI
    PhysxSphereFillCollisionAPI PhysxTriangleMeshSimplificationCollisionAPI"""
)


def of_type(names: Iterable[str]) -> Names:
    """The names of a prim without a name space. names: those of its schemas."""
    own = frozenset(names)
    harmless = {**PROPERTIES, **dict.fromkeys(own - _SHAPING, "of its schema")}
    return Names((own & _SHAPING) | OF_ALL_PRIMS, harmless)


def of_physics() -> Names:
    """The names in the name space `physics:`, without it."""
    registry = Usd.SchemaRegistry()
    schemas = ("CollisionAPI", "MeshCollisionAPI", "RigidBodyAPI", "FilteredPairsAPI")
    known = {
        name.partition(":")[2]
        for schema in schemas
        for name in registry.FindAppliedAPIPrimDefinition(f"Physics{schema}").GetPropertyNames()
    }
    for kind in ("RevoluteJoint", "PrismaticJoint", "CollisionGroup"):
        names = registry.FindConcretePrimDefinition(f"Physics{kind}").GetPropertyNames()
        known |= {name.partition(":")[2] for name in names if name.startswith("physics:")}
    return Names(frozenset(known))
