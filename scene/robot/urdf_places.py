"""The names that stand in a URDF: those that are read, and those that are harmless.

The format has no list of its own that ends: simulators and planners add elements to each place.
"""

from __future__ import annotations

from satcheck.scene.robot.elements import SHAPES
from satcheck.scene.robot.slips import Place, attributes, elements
from satcheck.scene.vocabulary import reasons

_SIMULATION = reasons(
    masses_forces_and_contacts="""gravity turnGravityOff enable_wind kinematic dampingFactor
        velocity_decay maxVel minDepth mu mu1 mu2 fdir1 kp kd maxContacts max_contacts
        springReference springStiffness stopKp stopKd stopCfm stopErp cfmDamping fudgeFactor
        implicitSpringDamper provideFeedback genericDamping must_be_base_link allow_auto_disable
        damping friction dynamics physics surface""",
    it_only_exempts_pairs_and_all_are_checked="""selfCollide self_collide static
        disableFixedJointLumping preserveFixedJoint canonicalBody""",
)
_DEVICE = reasons(
    sensors_motors_and_programs="""sensor camera light projector battery audio_source audio_sink
        particle_emitter plugin transmission actuator hardwareInterface hardware_interface
        ros2_control controller controller:* interface:* sensor:*"""
)
_WORDS = reasons(words_about_the_file="verbose bullet description author license meta comment")
_LOOK = reasons(
    colours_and_textures="material texture laserRetro laser_retro cast_shadows transparency"
)
_COMMON = _SIMULATION | _DEVICE | _WORDS | _LOOK

_VECTOR = Place(attributes=attributes("xyz rpy quat_xyzw"))
_GEOMETRY = Place(
    None,
    attributes("", words_about_the_file="name"),
    inside={
        **{
            tag: Place(attributes=attributes(" ".join(sizes))) for tag, (_, sizes) in SHAPES.items()
        },
        "plane": Place(attributes=attributes("normal")),
        "mesh": Place(
            elements("", _LOOK), attributes("filename scale", words_about_the_file="name")
        ),
    },
)
# A <collision>, or a <visual>.
SHAPE = Place(
    elements(
        "origin geometry",
        _COMMON,
        masses_forces_and_contacts="""contact contact_coefficients limits
            drake:proximity_properties""",
        colours_and_textures="drake:accepting_renderer drake:perception_properties",
    ),
    attributes(
        "name",
        it_only_exempts_pairs_and_all_are_checked="group mask",
        the_mesh_itself_is_checked="concave",
        words_about_the_file="id class",
    ),
    inside={"origin": _VECTOR, "geometry": _GEOMETRY},
)
LINK = Place(
    elements("collision visual", _COMMON, masses_forces_and_contacts="inertial contact limits"),
    attributes(
        "name",
        the_mesh_itself_is_checked="concave",
        a_kind_of_link_for_programs="type",
        it_only_exempts_pairs_and_all_are_checked="drake_ignore",
    ),
    idle={"origin": 0.0},
)
_LIMIT = Place(
    attributes=attributes(
        "lower upper",
        how_fast_or_strong_a_joint_is_moved="""effort velocity acceleration deceleration jerk
            command_effort friction damping stiffness twist drake:acceleration drake:jerk
            drake:effort""",
    )
)
JOINT = Place(
    elements(
        "origin parent child axis limit mimic",
        _SIMULATION,
        _DEVICE,
        _WORDS,
        masses_forces_and_contacts="""calibration safety_controller joint_properties
            drake:rotor_inertia drake:gear_ratio drake:controller_gains drake:damping""",
    ),
    attributes("name type", words_about_the_file="id"),
    inside={
        "origin": _VECTOR,
        "parent": Place(attributes=attributes("link")),
        "child": Place(attributes=attributes("link")),
        "axis": Place(attributes=attributes("xyz"), idle={"rpy": 0.0}),
        "limit": _LIMIT,
        "mimic": Place(attributes=attributes("joint multiplier offset")),
    },
    moves=True,
)
# What Gazebo adds to a link or a joint, or to the robot.
_GAZEBO = Place(
    elements(
        "collision",
        _COMMON,
        masses_forces_and_contacts="inertial contact",
        what_is_drawn_for_a_reference="visual",
    ),
    attributes("", the_link_or_the_joint_that_is_meant="reference"),
    idle={"pose": 0.0, "initialJointPosition": 0.0, "initial_joint_position": 0.0},
    inside={
        "collision": Place(
            elements("", _SIMULATION, _LOOK), attributes("", words_about_the_file="name")
        ),
    },
)
_MUJOCO = Place(
    elements(
        "compiler",
        masses_forces_and_contacts="option size statistic",
        colours_and_textures="visual",
    ),
    inside={
        "compiler": Place(
            attributes=attributes(
                "meshdir strippath",
                it_changes_masses_drawings_or_files_of_MuJoCo="""balanceinertia boundmass
                    boundinertia discardvisual fusestatic autolimits inertiafromgeom settotalmass
                    usethread convexhull exactmeshinertia inertiagrouprange alignfree saveinertial
                    texturedir eulerseq fitaabb""",
            )
        )
    },
)
ROBOT = Place(
    elements(
        "link joint gazebo mujoco",
        _DEVICE,
        _WORDS,
        colours_and_textures="material",
        masses_forces_and_contacts="force_element velocity drake:linear_bushing_rpy",
        it_only_exempts_pairs_and_all_are_checked="""drake:collision_filter_group disable_collision
            disable_collisions""",
        a_name_for_a_place="frame",
        joints_stand_where_the_pose_says="loop_joint drake:ball_constraint",
    ),
    attributes("name", words_about_the_file="version author"),
    inside={"gazebo": _GAZEBO, "mujoco": _MUJOCO},
)
