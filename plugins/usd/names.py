"""The names of USD at each place: those that are read, and those that are known to be harmless.

The schemas of USD itself are known to the library: a property of a schema is read, or of no concern
for bodies. These tables are about what stands beside the schemas, and about names that are
misspelt. Source: the schemas of UsdGeom, UsdPhysics and UsdSkel.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

from pxr import Usd, UsdGeom

from satcheck.scene.vocabulary import Names, reasons


def named(text: str) -> frozenset[str]:
    """The words of a text."""
    return frozenset(text.split())


# Properties of schemas that make, move, hide or shape a body.
SHAPING = named(
    """xformOpOrder visibility purpose points faceVertexCounts faceVertexIndices holeIndices
    orientation subdivisionScheme tetVertexIndices surfaceFaceVertexIndices size radius height axis
    width length radiusTop radiusBottom protoIndices prototypes positions orientations orientationsf
    scales ids invisibleIds inactiveIds velocities angularVelocities accelerations widths
    curveVertexCounts translations rotations joints blendShapes blendShapeWeights bindTransforms
    restTransforms offsets pointIndices"""
)
OF_ALL_PRIMS = named("xformOpOrder visibility purpose")
# Their geometry is none of the scene, unless it stands below them.
LOOKS = named("Material Shader NodeGraph Camera")

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
PROPERTY = Names(named("elementSize interpolation"))
CLIPS = Names(
    named(
        """assetPaths manifestAssetPath primPath active times interpolateMissingClipValues
    templateAssetPath templateStride templateStartTime templateEndTime templateActiveOffset"""
    )
)
OP = "xformOp:"
_KINDS = map(UsdGeom.XformOp.GetOpTypeToken, UsdGeom.XformOp.Type.allValues)
OPS = Names(frozenset(filter(None, map(str, _KINDS))))
# Without a name space.
PROPERTIES = {
    "boundaryInterpolation": "an old name about subdivision; the control cage is checked",
    "proxyPrim": "a prim that is drawn instead, and is a prim of its own",
    **reasons(bounds_of_what_is_below="extent extentsHint"),
}
APIS = Names(
    named(
        """PhysicsCollisionAPI PhysicsMeshCollisionAPI PhysicsRigidBodyAPI PhysicsFilteredPairsAPI
        SkelBindingAPI GeomModelAPI CollectionAPI"""
    ),
    reasons(
        materials_solvers_sensors_and_joints_of_a_simulator="""Physx* Newton* Mjc* Isaac* Robot*
        Preliminary_Physics*""",
        of_a_renderer="""Pxr* RiMaterial* RiSpline* RiLight* RiTexture* RiRenderPass* Karma*
        HoudiniEditable* HoudiniCamera* HoudiniViewport* HoudiniSelectable* Arnold* Redshift* Light*
        *LightAPI *LightFilterAPI""",
        metadata_of_a_program="Omni* Semantic* SceneGraph* Nv*",
    ),
)
TYPES = Names(
    named(
        """Mesh TetMesh Sphere Cube Cylinder Cylinder_1 Cone Capsule Capsule_1 Plane Xform Scope
        PointInstancer SkelRoot"""
    ),
    reasons(
        graphs_and_settings_of_a_program="Omni* ComputeGraph* Backdrop",
        settings_of_a_simulator="Isaac* Physx* Newton* Mjc*",
        of_a_renderer="Pxr*Filter Pxr*Light Pxr*Camera",
        behaviour_in_augmented_reality="""Preliminary_Action Preliminary_Behavior
        Preliminary_Trigger Preliminary_ReferenceImage Preliminary_AnchoringAPI RealityKit*""",
    ),
)
GEOMETRY = TYPES.read - named("Xform Scope SkelRoot")
# APIs of colliders that shape them otherwise than `physics:approximation` says.
SHAPES_OF_COLLIDERS = named(
    """PhysxConvexDecompositionCollisionAPI PhysxConvexHullCollisionAPI PhysxSDFMeshCollisionAPI
    PhysxSphereFillCollisionAPI PhysxTriangleMeshSimplificationCollisionAPI"""
)


# APIs of simulators that let a mesh collide without PhysicsCollisionAPI.
COLLIDERS_OF_THEIR_OWN = named(
    """PhysxDeformableBodyAPI PhysxDeformableSurfaceAPI PhysxParticleClothAPI PhysxParticleSetAPI
    OmniPhysicsDeformableBodyAPI"""
)
SWITCHES = named(
    """physics:collisionEnabled physics:rigidBodyEnabled physics:jointEnabled
    physics:invertFilteredGroups"""
)


@cache
def of_type(names: Iterable[str]) -> Names:
    """The names of a prim without a name space. names: those of its schemas."""
    own = frozenset(names)
    harmless = PROPERTIES | dict.fromkeys(own - SHAPING, "of its schema")
    return Names((own & SHAPING) | OF_ALL_PRIMS, harmless)


@cache
def of_spaces() -> Mapping[str, Names]:
    """The names in each name space whose properties move, shape or exempt bodies, without it."""
    registry = Usd.SchemaRegistry()
    apis = ("Collision", "MeshCollision", "RigidBody", "FilteredPairs")
    schemas = [registry.FindAppliedAPIPrimDefinition(f"Physics{api}API") for api in apis]
    schemas.append(registry.FindAppliedAPIPrimDefinition("SkelBindingAPI"))
    for kind in ("RevoluteJoint", "PrismaticJoint", "CollisionGroup"):
        schemas.append(registry.FindConcretePrimDefinition(f"Physics{kind}"))
    found = {"primvars": {"widths"}, "xformOp": set(OPS.read)}
    for name in (name for schema in schemas for name in schema.GetPropertyNames()):
        space, _, rest = name.partition(":")
        if rest:
            found.setdefault(space, set()).add(rest)
    return {space: Names(frozenset(known)) for space, known in found.items()}
