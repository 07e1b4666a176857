"""What the objects of a glTF file may hold: names that are read, and names that are harmless.

glTF 2.0 specification, chapter 5 (properties); the registries of extensions of Khronos and of
vendors. Objects of materials, textures, images, samplers, cameras and animations are no bodies:
of these only the extensions of materials are looked at, because some displace surfaces.
"""

from __future__ import annotations

from typing import Any

from satcheck.scene.errors import Refused
from satcheck.scene.vocabulary import Names, UnknownNames

DRACO = "KHR_draco_mesh_compression"
INSTANCING = "EXT_mesh_gpu_instancing"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
QUANTIZATION = "KHR_mesh_quantization"
KHR_SHAPES, KHR_BODIES = "KHR_implicit_shapes", "KHR_physics_rigid_bodies"
OMI_SHAPES, OMI_BODIES = "OMI_physics_shape", "OMI_physics_body"
_READ = frozenset(
    (DRACO, INSTANCING, *MESHOPT, QUANTIZATION, KHR_SHAPES, KHR_BODIES, OMI_SHAPES, OMI_BODIES)
)


def _reasons(**names: str) -> dict[str, str]:
    """Return the reason by name. names: for each reason, with _ for a space, the names."""
    return {name: why.replace("_", " ") for why, text in names.items() for name in text.split()}


# Extensions that place no geometry and change none.
HARMLESS_EXTENSIONS = _reasons(
    appearance="""
        KHR_materials_anisotropy KHR_materials_bump KHR_materials_clearcoat
        KHR_materials_cmnBlinnPhong KHR_materials_cmnConstant KHR_materials_cmnLambert
        KHR_materials_cmnPhong
        KHR_materials_coat KHR_materials_common KHR_materials_diffuse_roughness
        KHR_materials_diffuse_transmission KHR_materials_dispersion KHR_materials_emissive_strength
        KHR_materials_fuzz KHR_materials_ior KHR_materials_iridescence
        KHR_materials_pbrSpecularGlossiness
        KHR_materials_retroreflection KHR_materials_sheen KHR_materials_specular
        KHR_materials_specular_edge_color KHR_materials_sss KHR_materials_subsurface
        KHR_materials_transmission KHR_materials_unlit KHR_materials_variants KHR_materials_volume
        KHR_materials_volume_scatter KHR_blend KHR_environment_map
        ADOBE_materials_clearcoat_specular ADOBE_materials_clearcoat_tint
        ADOBE_materials_thin_transparency EXT_materials_bump EXT_materials_clear_coat
        EXT_materials_diffuse_roughness EXT_materials_specular_edge_color FB_materials_modmap
        MOZ_lightmap NEEDLE_lightmaps NV_materials_mdl
        MSFT_packing_normalRoughnessMetallic MSFT_packing_occlusionRoughnessMetallic
        ASOBO_material_alphamode_dither ASOBO_material_anisotropic ASOBO_material_anisotropic_v2
        ASOBO_material_blend_gbuffer ASOBO_material_clear_coat ASOBO_material_clear_coat_v2
        ASOBO_material_day_night_switch ASOBO_material_detail_map ASOBO_material_draw_order
        ASOBO_material_environment_occluder ASOBO_material_fake_terrain ASOBO_material_fresnel_fade
        ASOBO_material_geometry_decal ASOBO_material_glass ASOBO_material_invisible
        ASOBO_material_kitty_glass ASOBO_material_parallax_window ASOBO_material_shadow_options
        ASOBO_material_SSS ASOBO_material_UV_options ASOBO_material_windshield
        ASOBO_normal_map_convention ASOBO_extended_uv ASOBO_property_animation""",
    textures="""
        KHR_texture_basisu KHR_texture_procedurals KHR_texture_transform KHR_image_ktx2
        EXT_texture_astc EXT_texture_avif EXT_texture_procedurals_mx_1_39 EXT_texture_video
        EXT_texture_webp MSFT_texture_dds MOZ_texture_rgbe MAXAR_image_ortho MPEG_texture_video""",
    lights="""
        KHR_lights KHR_lights_area KHR_lights_common KHR_lights_environment KHR_lights_image_based
        KHR_lights_punctual EXT_lights_area EXT_lights_ies EXT_lights_image_based
        EXT_lights_environment_map EXT_environment_map ASOBO_macro_light OMI_environment_sky""",
    metadata="""
        KHR_xmp KHR_xmp_json_ld KHR_meta_data EXT_feature_metadata EXT_instance_features
        EXT_mesh_features EXT_property_textures EXT_structural_metadata CESIUM_mesh_vector
        AGI_stk_metadata ASOBO_tags ASOBO_unique_id FB_geometry_metadata GRIFFEL_bim_data
        MX_object_id 3DTILES_metadata 3DTILES_content_gltf 3DTILES_bounding_volume_S2
        3DTILES_batch_table_hierarchy GODOT_single_root OMI_link OMI_personality""",
    lines="""
        CESIUM_primitive_outline CESIUM_primitive_edges CESIUM_tile_edges
        EXT_mesh_primitive_edge_visibility""",
    order_of_triangles="FB_ngon_encoding EXT_mesh_polygon EXT_mesh_manifold",
    an_index_beyond_the_vertices_is_refused="EXT_mesh_primitive_restart KHR_mesh_primitive_restart",
    sound="""
        KHR_audio KHR_audio_emitter KHR_audio_graph OMI_audio_emitter OMI_audio_ogg_vorbis
        OMI_audio_opus MSFT_animation_sound MSFT_audio_emitter MPEG_audio_spatial MPEG_media
        MPEG_viewport_recommended""",
    a_hidden_node_is_a_body="KHR_node_visibility",
    whether_a_user_can_choose_a_node="KHR_node_hoverability KHR_node_selectability",
    the_file_is_checked_as_stored="KHR_animation_pointer MPEG_animation_timing VRMC_vrm_animation",
    forces_and_joints="OMI_physics_gravity OMI_physics_joint OMI_vehicle_body OMI_vehicle_thruster "
    "OMI_vehicle_hover_thruster OMI_seat OMI_spawn_point",
    its_triangles_are_read="ASOBO_collision_object",
)
# Of these, those that move something at another time: a note says that this is not checked.
ANIMATING = frozenset(("KHR_animation_pointer", "MPEG_animation_timing", "VRMC_vrm_animation"))
EXTENSIONS = Names(_READ, HARMLESS_EXTENSIONS)

_FREE = {"name": "a name", "extras": "data of an application"}
_APPEARANCE = dict.fromkeys(
    ("NORMAL*", "TANGENT*", "TEXCOORD*", "COLOR*", "BINORMAL*", "BITANGENT*", "BATCHID"),
    "appearance",
) | {"_*": "data of an application"}


def _names(read: str, **harmless: str) -> Names:
    return Names(frozenset(read.split()), _FREE | harmless)


_JOINTS = frozenset(f"{what}_{number}" for what in ("JOINTS", "WEIGHTS") for number in range(16))
# Where an extension is read: elsewhere it would be lost.
EXTENSIONS_OF = {
    "file": Names(frozenset((KHR_SHAPES, KHR_BODIES, OMI_SHAPES, OMI_BODIES)), HARMLESS_EXTENSIONS),
    "node": Names(frozenset((INSTANCING, KHR_BODIES, OMI_BODIES)), HARMLESS_EXTENSIONS),
    "primitive": Names(frozenset((DRACO,)), HARMLESS_EXTENSIONS),
    "buffer view": Names(frozenset(MESHOPT), HARMLESS_EXTENSIONS),
    "buffer": Names(frozenset(MESHOPT), HARMLESS_EXTENSIONS),
}
_NO_EXTENSIONS = Names(frozenset(), HARMLESS_EXTENSIONS)

# What each object is called, and its names.
PLACES = {
    "file": _names(
        "asset scene scenes nodes meshes accessors bufferViews buffers skins animations extensions "
        "extensionsUsed extensionsRequired",
        materials="appearance",
        textures="appearance",
        images="appearance",
        samplers="appearance",
        cameras="no extent",
    ),
    "asset": _names(
        "version minVersion extensions",
        **_reasons(
            about_the_file="generator copyright author description license profile source title "
            "premultipliedAlpha"
        ),
    ),
    "scene": _names("nodes extensions"),
    "node": _names(
        "children mesh skin matrix translation rotation scale weights extensions",
        camera="no extent",
    ),
    "mesh": _names("primitives weights extensions"),
    "primitive": _names("attributes indices mode targets extensions", material="appearance"),
    "attribute": Names(frozenset({"POSITION"}) | _JOINTS, _FREE | _APPEARANCE),
    "target": Names(frozenset({"POSITION"}), _FREE | _APPEARANCE),
    "accessor": _names(
        "bufferView byteOffset componentType normalized count type sparse extensions",
        min="a bound, not data",
        max="a bound, not data",
    ),
    "sparse": _names("count indices values extensions"),
    "sparse indices": _names("bufferView byteOffset componentType extensions"),
    "sparse values": _names("bufferView byteOffset extensions"),
    "buffer view": _names(
        "buffer byteOffset byteLength byteStride extensions", target="a hint for graphics"
    ),
    "buffer": _names("uri byteLength extensions", type="of an older version"),
    "skin": _names("inverseBindMatrices joints extensions", skeleton="places nothing"),
    INSTANCING: _names("attributes extensions"),
    "instance": Names(frozenset({"TRANSLATION", "ROTATION", "SCALE"}), _FREE | _APPEARANCE),
    DRACO: _names("bufferView attributes extensions"),
    **dict.fromkeys(
        MESHOPT,
        _names("buffer byteOffset byteLength byteStride count mode filter fallback extensions"),
    ),
}
# The list in the file, and what each object in it is called.
_LISTS = {
    "scenes": "scene",
    "nodes": "node",
    "meshes": "mesh",
    "accessors": "accessor",
    "bufferViews": "buffer view",
    "buffers": "buffer",
    "skins": "skin",
}


def look_at(document: dict[str, Any], unknown: UnknownNames) -> None:
    """Gather the names of a document that nobody knows. Raises Refused for a misspelt one."""
    _Look(unknown).at_file(document)


class _Look:
    def __init__(self, unknown: UnknownNames) -> None:
        self._unknown = unknown

    def at_file(self, document: dict[str, Any]) -> None:
        self._object(document, "file", "the file")
        self._object(document.get("asset"), "asset", "the asset")
        used = (_texts(document.get(key)) for key in ("extensionsUsed", "extensionsRequired"))
        declared = list(dict.fromkeys(name for names in used for name in names))
        self._unknown.look(EXTENSIONS, declared, "extension", "the file uses an extension")
        for key, kind in _LISTS.items():
            for number, owner in enumerate(_list(document.get(key))):
                self._object(owner, kind, f"{kind} {number}")
        for number, material in enumerate(_list(document.get("materials"))):
            self._extensions(material, "material", f"material {number}")
        for number, mesh in enumerate(_list(document.get("meshes"))):
            self._mesh(mesh, f"mesh {number}")
        for number, node in enumerate(_list(document.get("nodes"))):
            instances = _inside(node, "extensions", INSTANCING)
            self._object(instances, INSTANCING, f"node {number}: {INSTANCING}")
            self._names(instances.get("attributes"), "instance", f"node {number}")
            if instances and "mesh" not in node:
                message = f"node {number}: {INSTANCING} is not read on a node without a mesh"
                self._unknown.note((INSTANCING, "mesh"), message)
        for number, view in enumerate(_list(document.get("bufferViews"))):
            for name in MESHOPT:
                place = f"buffer view {number}: {name}"
                self._object(_inside(view, "extensions", name), name, place)
        for number, accessor in enumerate(_list(document.get("accessors"))):
            self._sparse(_inside(accessor, "sparse"), f"accessor {number}: sparse")

    def _mesh(self, mesh: Any, where: str) -> None:
        for primitive in _list(mesh.get("primitives")) if isinstance(mesh, dict) else ():
            self._object(primitive, "primitive", f"{where}: a primitive")
            if not isinstance(primitive, dict):
                continue
            self._names(primitive.get("attributes"), "attribute", where)
            for target in _list(primitive.get("targets")):
                self._names(target, "target", f"{where}: a morph target")
            packed = _inside(primitive, "extensions", DRACO)
            self._object(packed, DRACO, f"{where}: {DRACO}")
            self._names(packed.get("attributes"), "attribute", f"{where}: {DRACO}")

    def _sparse(self, sparse: dict[str, Any], where: str) -> None:
        self._object(sparse, "sparse", where)
        for key in ("indices", "values"):
            self._object(sparse.get(key), f"sparse {key}", f"{where} {key}")

    def _object(self, owner: Any, kind: str, place: str) -> None:
        self._names(owner, kind, place)
        self._extensions(owner, kind, place)

    def _extensions(self, owner: Any, kind: str, place: str) -> None:
        if isinstance(owner, dict) and "extensions" in owner:
            names, given = EXTENSIONS_OF.get(kind, _NO_EXTENSIONS), owner["extensions"]
            values = [given, *given.values()] if isinstance(given, dict) else [given]
            if not all(isinstance(value, dict) for value in values):
                raise Refused("bad-record", f"{place}: extensions should be objects")
            self._look(given, names, f"extension of {kind}", place)

    def _names(self, owner: Any, kind: str, place: str) -> None:
        self._look(owner, PLACES[kind], kind, place)

    def _look(self, owner: Any, names: Names, kind: str, place: str) -> None:
        if isinstance(owner, dict):
            self._unknown.look(names, owner.keys(), kind, place)


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []


def _texts(value: Any) -> list[str]:
    return [text for text in _list(value) if isinstance(text, str)]


def _inside(owner: Any, *keys: str) -> dict[str, Any]:
    """Return the object that the keys lead to; empty without one."""
    for key in keys:
        owner = owner.get(key) if isinstance(owner, dict) else None
    return owner if isinstance(owner, dict) else {}
