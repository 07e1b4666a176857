"""A glTF document: the types of its objects, and the names that may stand in them.

glTF 2.0 specification, chapter 5 (properties); the registries of extensions of Khronos and of
vendors. An object is checked against its type when it is used, so that an error in one mesh leaves
the others. Objects of materials, textures, images, samplers, cameras and animations are no bodies:
of these only the extensions of materials are looked at, because some displace surfaces.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Annotated, Any, ClassVar, Generic, Literal, NoReturn, TypeVar

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from satcheck.scene.errors import Refused
from satcheck.scene.vocabulary import Names, UnknownNames, reasons
from satcheck.scene.words import why_unreadable

DRACO = "KHR_draco_mesh_compression"
INSTANCING = "EXT_mesh_gpu_instancing"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")  # both pack in the same way
QUANTIZATION = "KHR_mesh_quantization"
KHR_SHAPES, KHR_BODIES = "KHR_implicit_shapes", "KHR_physics_rigid_bodies"
OMI_SHAPES, OMI_BODIES = "OMI_physics_shape", "OMI_physics_body"
_VERSION = "2.0"
_LARGEST = sys.float_info.max

Count = Annotated[int, Meta(ge=0)]  # of things, or the number of one
NONE = -1  # the number of an object that is not named
Number = Annotated[float, Meta(ge=-_LARGEST, le=_LARGEST)]
Vector = Annotated[tuple[Number, ...], Meta(min_length=3, max_length=3)]
Quaternion = Annotated[tuple[Number, ...], Meta(min_length=4, max_length=4)]
Matrix = Annotated[tuple[Number, ...], Meta(min_length=16, max_length=16)]  # column by column
Attributes = dict[str, Any]  # the number of an accessor by name, which is checked there


T = TypeVar("T")


class _Object(Struct, frozen=True, kw_only=True, rename="camel"):
    """What is not stated has the default of the specification; a number that is not there is
    `NONE`, and a list is empty. what: how messages name it."""

    what: ClassVar[str]
    extensions: dict[str, dict[str, Any]] = {}

    def extension(self, name: str, kind: type[T], where: str) -> T | None:
        """Return the data of an extension; None: the object has none. where: the object."""
        given = self.extensions.get(name)
        return None if given is None else checked(given, kind, f"{where}: {name}")


Object = TypeVar("Object", bound=_Object)


class Table(Generic[Object]):
    """The objects of a list of the document, by their numbers. Raises Refused for one that is not
    there, or not of its type.

    given: as the file has them. made: the same as their type; None: it is made where it is used.
    """

    def __init__(self, given: list[Any], kind: type[Object], made: list[Object | None]) -> None:
        self._given = given
        self._kind = kind
        self._made = made

    def __len__(self) -> int:
        return len(self._made)

    def __iter__(self) -> Iterator[Object]:
        for number, made in enumerate(self._made):
            yield made or self[number]

    def __getitem__(self, number: int) -> Object:
        if type(number) is int and 0 <= number < len(self._made):
            made = self._made[number]
            if made is not None:
                return made
        return checked(self._object(number), self._kind, f"{self._kind.what} {number}")

    def name(self, number: int) -> object:
        """Return the name of an object, even if the rest of it is not of its type."""
        given = self._object(number)
        return given.get("name") if isinstance(given, dict) else None

    def _object(self, number: int) -> Any:
        if type(number) is not int:
            raise Refused("bad-record", f"{self._kind.what} {number!r} is not a number")
        if not 0 <= number < len(self._given):
            message = f"{self._kind.what} {number} does not exist, there are {len(self._given)}"
            raise Refused("index-out-of-range", f"glTF: {message}")
        return self._given[number]


def checked(given: Any, kind: type[T], where: str) -> T:
    """Return an object as its type. Raises Refused with the place in the object."""
    try:
        return msgspec.convert(given, kind)
    except msgspec.ValidationError as error:
        raise Refused("bad-record", f"{where}: {str(error).replace('`$.', '`')}") from None


class Asset(_Object, frozen=True, kw_only=True):
    version: Any = None
    min_version: Any = _VERSION


class Scene(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "scene"
    nodes: tuple[Count, ...] = ()


class Instancing(_Object, frozen=True, kw_only=True):
    attributes: Attributes


class Node(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "node"
    name: Any = None
    children: tuple[Count, ...] = ()
    mesh: Count = NONE
    skin: Count = NONE
    matrix: Matrix = ()
    translation: Vector = ()
    rotation: Quaternion = ()
    scale: Vector = ()
    weights: tuple[Number, ...] = ()


class Draco(_Object, frozen=True, kw_only=True):
    buffer_view: Count
    attributes: Attributes


class Primitive(_Object, frozen=True, kw_only=True):
    attributes: Attributes = {}
    indices: Count = NONE
    mode: Annotated[int, Meta(ge=0, le=6)] = 4
    targets: tuple[Attributes, ...] = ()


class GltfMesh(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "mesh"
    primitives: tuple[Primitive, ...]
    weights: tuple[Number, ...] = ()


class GltfSkin(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "skin"
    joints: tuple[Count, ...]
    inverse_bind_matrices: Count = NONE


ComponentType = Literal[5120, 5121, 5122, 5123, 5125, 5126]


class SparseValues(_Object, frozen=True, kw_only=True):
    buffer_view: Count
    byte_offset: Count = 0


class SparseIndices(SparseValues, frozen=True, kw_only=True):
    component_type: Literal[5121, 5123, 5125]


class Sparse(_Object, frozen=True, kw_only=True):
    count: Count
    indices: SparseIndices
    values: SparseValues


class Accessor(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "accessor"
    component_type: ComponentType
    count: Count
    type: Literal["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]
    buffer_view: Count = NONE
    byte_offset: Count = 0
    normalized: bool = False
    sparse: Sparse | UnsetType = UNSET


class Meshopt(_Object, frozen=True, kw_only=True):
    """Packed data. Further filters are for normals and colours."""

    buffer: Count
    byte_length: Count
    byte_stride: Count
    count: Annotated[int, Meta(ge=1)]
    mode: Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
    byte_offset: Count = 0
    filter: Literal["NONE", "EXPONENTIAL", "QUATERNION"] = "NONE"


class BufferView(_Object, frozen=True, kw_only=True):
    """byte_stride: 0: the elements follow one another."""

    what: ClassVar[str] = "buffer view"
    buffer: Count
    byte_length: Count
    byte_offset: Count = 0
    byte_stride: Annotated[int, Meta(ge=1)] = 0


class Buffer(_Object, frozen=True, kw_only=True):
    what: ClassVar[str] = "buffer"
    byte_length: Count
    uri: str | None = None


class _Lists(_Object, frozen=True, kw_only=True):
    """All of a document; None: as of `Table`."""

    asset: Asset
    scene: Count = NONE
    scenes: list[Scene | None] = []
    nodes: list[Node | None] = []
    meshes: list[GltfMesh | None] = []
    accessors: list[Accessor | None] = []
    buffer_views: list[BufferView | None] = []
    buffers: list[Buffer | None] = []
    skins: list[GltfSkin | None] = []
    materials: list[Any] = []
    animations: list[Any] = []
    extensions_used: tuple[str, ...] = ()
    extensions_required: tuple[str, ...] = ()


class GltfDocument:
    """tree: of the JSON. stated: all of it. Raises Refused if the objects are not in lists."""

    def __init__(self, tree: dict[str, Any]) -> None:
        self.stated = lists = _typed(tree)
        self.scenes = Table(tree.get("scenes", []), Scene, lists.scenes)
        self.nodes = Table(tree.get("nodes", []), Node, lists.nodes)
        self.meshes = Table(tree.get("meshes", []), GltfMesh, lists.meshes)
        self.accessors = Table(tree.get("accessors", []), Accessor, lists.accessors)
        self.buffer_views = Table(tree.get("bufferViews", []), BufferView, lists.buffer_views)
        self.buffers = Table(tree.get("buffers", []), Buffer, lists.buffers)
        self.skins = Table(tree.get("skins", []), GltfSkin, lists.skins)


def _typed(tree: dict[str, Any]) -> _Lists:
    """If one object is not of its type, all are made where they are used."""
    try:
        return msgspec.convert(tree, _Lists)
    except msgspec.ValidationError:
        lists = {key: tree[key] for key in _LISTS if isinstance(tree.get(key), list)}
        later = {key: [None] * len(objects) for key, objects in lists.items()}
        return checked(tree | later, _Lists, "glTF")


# Extensions that place no geometry and change none.
HARMLESS_EXTENSIONS = reasons(
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
EXTENSIONS = Names(
    frozenset(
        (DRACO, INSTANCING, *MESHOPT, QUANTIZATION, KHR_SHAPES, KHR_BODIES, OMI_SHAPES, OMI_BODIES)
    ),
    HARMLESS_EXTENSIONS,
)

# Extensions that move all of the geometry even where they are optional.
_MOVING = frozenset({"CESIUM_RTC"})
_FREE = reasons(a_name="name", data_of_an_application="extras")
_APPEARANCE = reasons(
    appearance="NORMAL* TANGENT* TEXCOORD* COLOR* BINORMAL* BITANGENT* BATCHID",
    data_of_an_application="_*",
)


def names_of(kind: type[Struct], **harmless: str) -> Names:
    """Return the names of an object: its fields are read."""
    harmless = _FREE | harmless
    return Names(frozenset(kind.__struct_encode_fields__).difference(harmless), harmless)


def _extensions(*read: str) -> Names:
    return Names(frozenset(read), HARMLESS_EXTENSIONS)


_JOINTS = frozenset(f"{what}_{number}" for what in ("JOINTS", "WEIGHTS") for number in range(16))
# Where an extension is read: elsewhere it would be lost.
EXTENSIONS_OF = {
    "file": _extensions(KHR_SHAPES, KHR_BODIES, OMI_SHAPES, OMI_BODIES),
    "node": _extensions(INSTANCING, KHR_BODIES, OMI_BODIES),
    "primitive": _extensions(DRACO),
    "buffer view": _extensions(*MESHOPT),
    "buffer": _extensions(*MESHOPT),
}

# What each object is called, and its names.
PLACES = {
    "file": names_of(
        _Lists,
        **reasons(appearance="materials textures images samplers", no_extent="cameras"),
    ),
    "asset": names_of(
        Asset,
        **reasons(
            about_the_file="""generator copyright author description license profile source title
                premultipliedAlpha"""
        ),
    ),
    "scene": names_of(Scene),
    "node": names_of(Node, camera="no extent"),
    "mesh": names_of(GltfMesh),
    "primitive": names_of(Primitive, material="appearance"),
    "attribute": Names(frozenset({"POSITION"}) | _JOINTS, _FREE | _APPEARANCE),
    "target": Names(frozenset({"POSITION"}), _FREE | _APPEARANCE),
    "accessor": names_of(Accessor, min="a bound, not data", max="a bound, not data"),
    "sparse": names_of(Sparse),
    "sparse indices": names_of(SparseIndices),
    "sparse values": names_of(SparseValues),
    "buffer view": names_of(BufferView, target="a hint for graphics"),
    "buffer": names_of(Buffer, type="of an older version"),
    "skin": names_of(GltfSkin, skeleton="places nothing"),
    INSTANCING: names_of(Instancing),
    "instance": Names(frozenset({"TRANSLATION", "ROTATION", "SCALE"}), _FREE | _APPEARANCE),
    DRACO: names_of(Draco),
    **dict.fromkeys(MESHOPT, Names(names_of(Meshopt).read | {"fallback"}, _FREE)),
}
# The objects in each: their key, what they are called, and how messages name their place.
_INSIDE = {
    "mesh": (("primitives", "primitive", ": a primitive"),),
    "primitive": (("attributes", "attribute", ""), ("targets", "target", ": a morph target")),
    "accessor": (("sparse", "sparse", ": sparse"),),
    "sparse": (("indices", "sparse indices", " indices"), ("values", "sparse values", " values")),
    INSTANCING: (("attributes", "instance", ""),),
    DRACO: (("attributes", "attribute", ""),),
}
# Of each object, the known names in which there is nothing to look at.
_PLAIN = {
    kind: names.known.difference(("extensions", *(key for key, *_ in _INSIDE.get(kind, ()))))
    for kind, names in PLACES.items()
}
_NOTHING: frozenset[str] = frozenset()
_LISTS = {
    "scenes": "scene",
    "nodes": "node",
    "meshes": "mesh",
    "accessors": "accessor",
    "bufferViews": "buffer view",
    "buffers": "buffer",
    "skins": "skin",
    "materials": "material",
}


def _look(objects: Iterable[Any], kind: str, place: str, unknown: UnknownNames) -> None:
    """Gather the names that nobody knows of these objects and of the objects in them. place: where
    they stand; "": in a list of the document, of which each is named by its kind and number."""
    plain = _PLAIN.get(kind, _NOTHING)
    for number, given in enumerate(objects):
        if isinstance(given, dict) and not plain.issuperset(given):
            _look_into(given, kind, place or f"{kind} {number}", unknown)


def _look_into(given: dict[str, Any], kind: str, place: str, unknown: UnknownNames) -> None:
    """As `_look` does, for one object."""
    if kind in PLACES:
        unknown.look(PLACES[kind], given, kind, place)
    if "extensions" in given:
        extensions = given["extensions"]
        checked(given, _Object, place)
        names = EXTENSIONS_OF.get(kind, _extensions())
        unknown.look(names, extensions.keys(), f"extension of {kind}", place)
        for name in PLACES.keys() & extensions.keys():
            _look([extensions[name]], name, f"{place}: {name}", unknown)
    for key, inner, said in _INSIDE.get(kind, ()):
        if key in given:
            value = given[key]
            _look(value if isinstance(value, list) else [value], inner, place + said, unknown)


def read_document(data: memoryview, unknown: UnknownNames) -> GltfDocument:
    """Return the document of the JSON of a glTF file, and gather the names that nobody knows.
    Raises Refused, also for a misspelt name."""
    tree = _tree(data)
    if not isinstance(tree, dict) or not isinstance(tree.get("asset"), dict):
        raise Refused("not-this-format", "not a glTF file: no asset object")
    asset = checked(tree["asset"], Asset, "the asset")
    if not isinstance(asset.version, str) or not asset.version.startswith("2."):
        raise Refused("unsupported-feature", f"glTF version {asset.version!r}: 2.x is read")
    if asset.min_version != _VERSION:
        message = f"the file needs glTF version {asset.min_version!r}: {_VERSION} is read"
        raise Refused("unsupported-feature", message)
    document = GltfDocument(tree)
    stated = document.stated
    for name in stated.extensions_required:
        if not EXTENSIONS.knows(name):
            raise Refused("unsupported-feature", f"the file requires extension {name!r}")
    for name in stated.extensions_used:
        if name in _MOVING:
            raise Refused("unsupported-feature", f"extension {name!r} is not read")
    declared = list(dict.fromkeys((*stated.extensions_used, *stated.extensions_required)))
    unknown.look(EXTENSIONS, declared, "extension", "the file uses an extension")
    _look([tree], "file", "the file", unknown)
    _look([tree["asset"]], "asset", "the asset", unknown)
    for key, kind in _LISTS.items():
        if key in tree:
            _look(tree[key], kind, "", unknown)
    return document


def _refuse(token: str) -> NoReturn:
    raise Refused("bad-record", f"JSON: {token} is not a number of glTF")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        twice = next(key for key, count in Counter(k for k, _ in pairs).items() if count > 1)
        raise Refused("bad-record", f"JSON: the key {twice!r} occurs twice in one object")
    return values


_JSON = json.JSONDecoder(parse_constant=_refuse, object_pairs_hook=_once)


def _tree(data: memoryview) -> Any:
    """The JSON, in which no key of an object occurs twice. msgspec reads it in a fifth of the time
    of `json`, but says nothing of such a key: the tree then holds fewer colons than the text."""
    text = bytes(data)
    try:
        tree = msgspec.json.decode(text)
        if b"\\u" not in text and text.count(b":") == msgspec.json.encode(tree).count(b":"):
            return tree
    except (ValueError, RecursionError):  # which `json` says in more words
        pass
    try:
        return _JSON.decode(str(data, "utf-8").removeprefix("\ufeff"))
    except UnicodeDecodeError:
        raise Refused("bad-encoding", "the JSON is not UTF-8") from None
    except json.JSONDecodeError as error:
        message = f"line {error.lineno}: not well-formed JSON: {error.msg}"
        raise Refused("bad-record", message) from None
    except RecursionError:
        raise Refused("bad-record", "the JSON is nested too deeply") from None
    except ValueError as error:
        raise Refused("bad-record", f"JSON: {why_unreadable(error)}") from None
