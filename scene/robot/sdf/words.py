"""The elements that SDFormat knows, of all its versions. Others may be misspelt."""

_COMMON = frozenset(("pose", "plugin", "frame", "meta"))
IN_ROOT = frozenset(("world", "model", "actor", "light", "include", "plugin"))
IN_WORLD = _COMMON | {
    *("audio", "wind", "include", "gravity", "magnetic_field", "atmosphere", "gui", "physics"),
    *("scene", "light", "model", "actor", "road", "spherical_coordinates", "state", "population"),
    *("joint",),
}
IN_MODEL = _COMMON | {
    *("static", "self_collide", "allow_auto_disable", "include", "model", "enable_wind", "link"),
    *("joint", "gripper", "light"),
}
IN_INCLUDE = _COMMON | {"uri", "name", "static", "placement_frame"}
IN_LINK = _COMMON | {
    *("gravity", "enable_wind", "self_collide", "kinematic", "must_be_base_link", "inertial"),
    *("velocity_decay", "collision", "visual", "sensor", "projector", "audio_sink", "light"),
    *("audio_source", "battery", "particle_emitter"),
}
IN_JOINT = _COMMON | {
    *("parent", "child", "axis", "axis2", "physics", "sensor", "gearbox_ratio", "origin"),
    *("gearbox_reference_body", "thread_pitch", "screw_thread_pitch"),
}
IN_COLLISION = _COMMON | {
    *("geometry", "surface", "laser_retro", "max_contacts", "material", "density"),
    *("auto_inertia_params", "enhanced_inertia", "cast_shadows", "transparency"),
    *("visibility_flags", "inertial", "lidar_reflectivity"),
}
