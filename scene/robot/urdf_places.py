"""The names that stand in a URDF: those that are read, and those that are harmless.

The format has no list of its own that ends: simulators and planners add elements to each place.
"""

from __future__ import annotations

from satcheck.scene.robot.slips import Place, attributes, because, elements

_FORCES = "masses, forces and contacts have no shape"
_DRAWN = "colours and textures have no shape"
_DEVICES = "sensors, motors and programs are no bodies"
_FEWER = "it can only exempt pairs, and all are checked"
_TEXT = "words about the file"

_SIMULATION = because(
    _FORCES,
    "gravity turnGravityOff enable_wind kinematic dampingFactor velocity_decay maxVel minDepth mu "
    "mu1 mu2 fdir1 kp kd maxContacts max_contacts springReference springStiffness stopKp stopKd "
    "stopCfm stopErp cfmDamping fudgeFactor implicitSpringDamper provideFeedback genericDamping "
    "must_be_base_link allow_auto_disable damping friction dynamics physics surface",
) | because(
    _FEWER,
    "selfCollide self_collide static disableFixedJointLumping preserveFixedJoint canonicalBody",
)
_DEVICE = because(
    _DEVICES,
    "sensor camera light projector battery audio_source audio_sink particle_emitter plugin "
    "transmission actuator hardwareInterface hardware_interface ros2_control controller "
    "controller:* interface:* sensor:*",
)
_WORDS = because(_TEXT, "verbose bullet description author license meta comment")
_LOOK = because(_DRAWN, "material texture laserRetro laser_retro cast_shadows transparency")
_COMMON = _SIMULATION | _DEVICE | _WORDS | _LOOK

_VECTOR = Place(attributes=attributes("xyz rpy quat_xyzw"))
_GEOMETRY = Place(
    None,
    attributes("", because(_TEXT, "name")),
    inside={
        "mesh": Place(elements("", _LOOK), attributes("filename scale", because(_TEXT, "name"))),
        "box": Place(attributes=attributes("size")),
        "sphere": Place(attributes=attributes("radius")),
        "cylinder": Place(attributes=attributes("radius length")),
        "capsule": Place(attributes=attributes("radius length")),
        "plane": Place(attributes=attributes("normal")),
    },
)
# A <collision>, or a <visual>.
SHAPE = Place(
    elements(
        "origin geometry",
        _COMMON,
        because(_FORCES, "contact contact_coefficients limits drake:proximity_properties"),
        because(_DRAWN, "drake:accepting_renderer drake:perception_properties"),
    ),
    attributes(
        "name",
        because(_FEWER, "group mask"),
        because("the mesh itself is checked", "concave"),
        because(_TEXT, "id class"),
    ),
    inside={"origin": _VECTOR, "geometry": _GEOMETRY},
)
LINK = Place(
    elements(
        "collision visual",
        _COMMON,
        because(_FORCES, "inertial contact limits"),
    ),
    attributes(
        "name",
        because("the mesh itself is checked", "concave"),
        because("a kind of link, for programs", "type"),
        because(_FEWER, "drake_ignore"),
    ),
    idle={"origin": 0.0},
)
_AXIS = Place(attributes=attributes("xyz"), idle={"rpy": 0.0})
_LIMIT = Place(
    attributes=attributes(
        "lower upper",
        because(
            "how fast or strong a joint is moves no body",
            "effort velocity acceleration deceleration jerk command_effort friction damping "
            "stiffness twist drake:acceleration drake:jerk drake:effort",
        ),
    )
)
JOINT = Place(
    elements(
        "origin parent child axis limit mimic",
        _SIMULATION,
        _DEVICE,
        _WORDS,
        because(
            _FORCES,
            "calibration safety_controller joint_properties drake:rotor_inertia drake:gear_ratio "
            "drake:controller_gains drake:damping",
        ),
    ),
    attributes("name type", because(_TEXT, "id")),
    inside={
        "origin": _VECTOR,
        "parent": Place(attributes=attributes("link")),
        "child": Place(attributes=attributes("link")),
        "axis": _AXIS,
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
        because(_FORCES, "inertial contact"),
        because("what is drawn for a reference", "visual"),
    ),
    attributes("", because("the link or the joint that is meant", "reference")),
    idle={"pose": 0.0, "initialJointPosition": 0.0, "initial_joint_position": 0.0},
    inside={
        "collision": Place(
            elements("", _SIMULATION, _LOOK), attributes("", because(_TEXT, "name"))
        ),
    },
)
_MUJOCO = Place(
    elements("compiler", because(_FORCES, "option size statistic"), because(_DRAWN, "visual")),
    inside={
        "compiler": Place(
            attributes=attributes(
                "meshdir strippath",
                because(
                    "it changes masses, drawings or the files of MuJoCo",
                    "balanceinertia boundmass boundinertia discardvisual fusestatic autolimits "
                    "inertiafromgeom settotalmass usethread convexhull exactmeshinertia "
                    "inertiagrouprange alignfree saveinertial texturedir eulerseq fitaabb",
                ),
            )
        )
    },
)
ROBOT = Place(
    elements(
        "link joint gazebo mujoco",
        _DEVICE,
        _WORDS,
        because(_DRAWN, "material"),
        because(_FORCES, "force_element velocity drake:linear_bushing_rpy"),
        because(_FEWER, "drake:collision_filter_group disable_collision disable_collisions"),
        because("a name for a place", "frame"),
        because("joints stand where the pose says", "loop_joint drake:ball_constraint"),
    ),
    attributes(
        "name",
        because(_TEXT, "version author"),
    ),
    inside={"gazebo": _GAZEBO, "mujoco": _MUJOCO},
)
