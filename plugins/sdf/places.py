"""The names that stand in an SDFormat file, of all its versions: those that are read, and those
that are harmless."""

from __future__ import annotations

from satcheck.scene.robot.slips import Place, attributes, because, elements

_FORCES = "masses, forces and contacts have no shape"
_DRAWN = "what is drawn, lit or heard has no shape"
_DEVICES = "sensors, motors and programs are no bodies"
_FEWER = "it can only exempt pairs, and all are checked"
_TEXT = "words about the file"

_ANYWHERE = because(_DEVICES, "plugin") | because(_TEXT, "meta description author frame")
_VALUE = Place(text=True)
_POSE = Place(attributes=attributes("relative_to frame degrees rotation_format"), text=True)

ROOT = Place(
    elements("world model actor include", _ANYWHERE, because(_DRAWN, "light")),
    attributes("version"),
)
WORLD = Place(
    elements(
        "include model actor population road state frame joint",
        _ANYWHERE,
        because(_DRAWN, "audio gui scene light"),
        because(_FORCES, "wind gravity magnetic_field atmosphere physics gz:policies"),
        because("where on Earth the world lies", "spherical_coordinates"),
    ),
    attributes("name"),
    idle={"pose": 0.0},
)
MODEL = Place(
    elements(
        "static self_collide include model link frame joint pose",
        _ANYWHERE,
        because(_DRAWN, "light"),
        because(_DEVICES, "gripper transmission ros2_control"),
        because(_FORCES, "allow_auto_disable enable_wind inertial gravity"),
        because(_FEWER, "drake:collision_filter_group"),
        because(_TEXT, "gz:semantics"),
    ),
    attributes("name canonical_link placement_frame", because(_TEXT, "namespace")),
    idle={"scale": 1.0, "selfCollide": "false"},
    inside={"pose": _POSE},
)
INCLUDE = Place(
    elements(
        "uri name pose static placement_frame experimental:params",
        _ANYWHERE,
        because(_TEXT, "namespace"),
    ),
    attributes("merge"),
    inside={"pose": _POSE, "uri": _VALUE},
)
LINK = Place(
    elements(
        "pose self_collide collision visual",
        _ANYWHERE,
        because(
            _FORCES,
            "inertial gravity enable_wind kinematic must_be_base_link velocity_decay contact "
            "damping wrench velocity acceleration",
        ),
        because(_DRAWN, "light audio_sink audio_source particle_emitter"),
        because(_DEVICES, "sensor projector battery"),
        because(_FEWER, "static"),
    ),
    attributes("name"),
    inside={"pose": _POSE},
)
_CONTACT = Place(
    elements(
        "collide_bitmask category_bitmask",
        because(_FEWER, "collide_without_contact collide_without_contact_bitmask"),
        because(
            _FORCES,
            "poissons_ratio elastic_modulus ode bullet lateral_friction rolling_friction "
            "spinning_friction stiffness damping",
        ),
    )
)
_MESH = Place(
    elements(
        "uri scale submesh", because("how a simulator splits the mesh", "convex_decomposition")
    ),
    attributes("optimization"),
    inside={"uri": _VALUE, "scale": _VALUE},
)
_ROUND = Place(elements("radius length"), inside={"radius": _VALUE, "length": _VALUE})
_GEOMETRY = Place(
    None,
    inside={
        "box": Place(elements("size"), inside={"size": _VALUE}),
        "sphere": Place(elements("radius"), inside={"radius": _VALUE}),
        "cylinder": _ROUND,
        "capsule": _ROUND,
        "cone": _ROUND,
        "ellipsoid": Place(elements("radii"), inside={"radii": _VALUE}),
        "plane": Place(
            elements("normal", because("a plane that collides has no end", "size")),
            inside={"normal": _VALUE},
        ),
        "mesh": _MESH,
    },
)
# A <collision>, or a <visual>.
SHAPE = Place(
    elements(
        "pose geometry surface",
        _ANYWHERE,
        because(
            _FORCES,
            "max_contacts density auto_inertia_params enhanced_inertia inertial "
            "drake:proximity_properties",
        ),
        because(
            _DRAWN,
            "laser_retro material cast_shadows transparency visibility_flags lidar_reflectivity "
            "drake:accepting_renderer drake:illustration_properties drake:perception_properties",
        ),
    ),
    attributes("name", because("the mesh itself is checked", "concave")),
    inside={
        "pose": _POSE,
        "geometry": _GEOMETRY,
        "surface": Place(
            elements("contact", because(_FORCES, "bounce friction soft_contact")),
            inside={"contact": _CONTACT},
        ),
    },
)
FRAME = Place(elements("pose", _ANYWHERE), attributes("name attached_to"), inside={"pose": _POSE})
_LIMIT = Place(
    elements(
        "lower upper",
        because(
            "how fast or strong a joint is moves no body",
            "effort velocity stiffness dissipation cfm erp drake:acceleration drake:effort",
        ),
    ),
    inside={"lower": _VALUE, "upper": _VALUE},
)
_MIMIC = Place(
    elements("multiplier offset reference"),
    attributes("joint"),
    idle={"axis": "axis"},
)
_AXIS = Place(
    elements("xyz limit mimic use_parent_model_frame", because(_FORCES, "dynamics")),
    idle={"initial_position": 0.0},
    inside={
        "xyz": Place(attributes=attributes("expressed_in"), text=True),
        "limit": _LIMIT,
        "mimic": _MIMIC,
    },
)
JOINT = Place(
    elements(
        "parent child axis axis2 pose",
        _ANYWHERE,
        because(
            _FORCES,
            "physics gearbox_ratio gearbox_reference_body thread_pitch screw_thread_pitch "
            "drake:rotor_inertia drake:gear_ratio drake:controller_gains",
        ),
        because(_DEVICES, "sensor"),
    ),
    attributes("name type"),
    inside={
        "parent": _VALUE,
        "child": _VALUE,
        "pose": _POSE,
        "axis": _AXIS,
        "axis2": _AXIS,  # a joint with two axes is not moved, and named
    },
    moves=True,
)
STATE = Place(
    elements(
        "model",
        because("when the state was stored", "sim_time wall_time real_time iterations"),
        because(_DRAWN, "light"),
        because("named with the models: no state is applied", "joint"),
        because("all models are checked", "deletions"),
    ),
    attributes("world_name"),
    idle={"insertions": ""},
)
