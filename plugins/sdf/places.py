"""The names that stand in an SDFormat file, of all its versions: those that are read, and those
that are harmless."""

from __future__ import annotations

from satcheck.scene.robot.elements import SHAPES
from satcheck.scene.robot.slips import Place, attributes, elements
from satcheck.scene.vocabulary import reasons

_ANYWHERE = reasons(
    sensors_motors_and_programs="plugin", words_about_the_file="meta description author frame"
)
_VALUE = Place(text=True)
_POSE = Place(attributes=attributes("relative_to frame degrees rotation_format"), text=True)


def _values(names: str) -> Place:
    """An element whose children have values alone."""
    return Place(elements(names), inside=dict.fromkeys(names.split(), _VALUE))


ROOT = Place(
    elements("world model actor include", _ANYWHERE, drawn_lit_or_heard="light"),
    attributes("version"),
)
WORLD = Place(
    elements(
        "include model actor population road state frame joint",
        _ANYWHERE,
        drawn_lit_or_heard="audio gui scene light",
        masses_forces_and_contacts="wind gravity magnetic_field atmosphere physics gz:policies",
        where_on_Earth_the_world_lies="spherical_coordinates",
    ),
    attributes("name"),
    idle={"pose": 0.0},
)
MODEL = Place(
    elements(
        "static self_collide include model link frame joint pose",
        _ANYWHERE,
        drawn_lit_or_heard="light",
        sensors_motors_and_programs="gripper transmission ros2_control",
        masses_forces_and_contacts="allow_auto_disable enable_wind inertial gravity",
        it_only_exempts_pairs_and_all_are_checked="drake:collision_filter_group",
        words_about_the_file="gz:semantics",
    ),
    attributes("name canonical_link placement_frame", words_about_the_file="namespace"),
    idle={"scale": 1.0, "selfCollide": "false"},
    inside={"pose": _POSE},
)
INCLUDE = Place(
    elements(
        "uri name pose static placement_frame experimental:params",
        _ANYWHERE,
        words_about_the_file="namespace",
    ),
    attributes("merge"),
    inside={"pose": _POSE, "uri": _VALUE},
)
LINK = Place(
    elements(
        "pose self_collide collision visual",
        _ANYWHERE,
        masses_forces_and_contacts="""inertial gravity enable_wind kinematic must_be_base_link
            velocity_decay contact damping wrench velocity acceleration""",
        drawn_lit_or_heard="light audio_sink audio_source particle_emitter",
        sensors_motors_and_programs="sensor projector battery",
        it_only_exempts_pairs_and_all_are_checked="static",
    ),
    attributes("name"),
    inside={"pose": _POSE},
)
_CONTACT = Place(
    elements(
        "collide_bitmask category_bitmask",
        it_only_exempts_pairs_and_all_are_checked="""collide_without_contact
            collide_without_contact_bitmask""",
        masses_forces_and_contacts="""poissons_ratio elastic_modulus ode bullet lateral_friction
            rolling_friction spinning_friction stiffness damping""",
    )
)
_GEOMETRY = Place(
    None,
    inside={
        **{tag: _values(" ".join(sizes)) for tag, (_, sizes) in SHAPES.items()},
        "plane": Place(
            elements("normal", a_plane_that_collides_has_no_end="size"), inside={"normal": _VALUE}
        ),
        "mesh": Place(
            elements("uri scale submesh", how_a_simulator_splits_the_mesh="convex_decomposition"),
            attributes("optimization"),
            inside={"uri": _VALUE, "scale": _VALUE},
        ),
    },
)
# A <collision>, or a <visual>.
SHAPE = Place(
    elements(
        "pose geometry surface",
        _ANYWHERE,
        masses_forces_and_contacts="""max_contacts density auto_inertia_params enhanced_inertia
            inertial drake:proximity_properties""",
        drawn_lit_or_heard="""laser_retro material cast_shadows transparency visibility_flags
            lidar_reflectivity drake:accepting_renderer drake:illustration_properties
            drake:perception_properties""",
    ),
    attributes("name", the_mesh_itself_is_checked="concave"),
    inside={
        "pose": _POSE,
        "geometry": _GEOMETRY,
        "surface": Place(
            elements("contact", masses_forces_and_contacts="bounce friction soft_contact"),
            inside={"contact": _CONTACT},
        ),
    },
)
FRAME = Place(elements("pose", _ANYWHERE), attributes("name attached_to"), inside={"pose": _POSE})
_AXIS = Place(
    elements("xyz limit mimic use_parent_model_frame", masses_forces_and_contacts="dynamics"),
    idle={"initial_position": 0.0},
    inside={
        "xyz": Place(attributes=attributes("expressed_in"), text=True),
        "limit": Place(
            elements(
                "lower upper",
                how_fast_or_strong_a_joint_is_moved="""effort velocity stiffness dissipation cfm erp
                    drake:acceleration drake:effort""",
            ),
            inside={"lower": _VALUE, "upper": _VALUE},
        ),
        "mimic": Place(
            elements("multiplier offset reference"), attributes("joint"), idle={"axis": "axis"}
        ),
    },
)
JOINT = Place(
    elements(
        "parent child axis axis2 pose",
        _ANYWHERE,
        masses_forces_and_contacts="""physics gearbox_ratio gearbox_reference_body thread_pitch
            screw_thread_pitch drake:rotor_inertia drake:gear_ratio drake:controller_gains""",
        sensors_motors_and_programs="sensor",
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
        when_the_state_was_stored="sim_time wall_time real_time iterations",
        drawn_lit_or_heard="light",
        no_state_is_applied_and_models_say_so="joint",
        all_models_are_checked="deletions",
    ),
    attributes("world_name"),
    idle={"insertions": ""},
)
