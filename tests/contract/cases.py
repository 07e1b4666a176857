"""The calls of the contract: all arguments of the command are in this file.

A call is here only if its answer is known to be right, or harmless. Meshes are preferred to curved
shapes, because these use functions of the C library that differ between systems.
"""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
DATA = HERE / "data"
SAMPLES = HERE.parent.parent / "sample_meshes"
DOCS = HERE.parent.parent / "docs"
# Stands for a folder of the call that is empty at first.
OUT = "{out}"
# For every call: no option comes from a file, no reader is stopped because a machine is busy, and
# the answer is JSON on standard output.
PLAIN = ("--no-config", "-j", "1", "--limit", "seconds=600")
JSON = ("--format", "json")

Arguments = tuple[str, ...]


class Call(NamedTuple):
    """arguments: of the command. folder: where it runs. before: calls whose results it needs.
    document: the file with its answer; empty: standard output."""

    name: str
    arguments: Arguments
    folder: Path = SAMPLES
    before: tuple[Arguments, ...] = ()
    document: str = ""


def check(*arguments: str) -> Arguments:
    return (*PLAIN, *JSON, *arguments)


def on_data(*arguments: str, folder: str) -> Call:
    """The files and their folder name the call, with the options."""
    return Call(f"{folder}: {' '.join(arguments)}", check(*arguments), DATA / folder)


def on_samples(*arguments: str) -> Call:
    return Call(" ".join(arguments), check(*arguments))


def in_metres(*meshes: str) -> Call:
    """GLB files are in metres; the others say nothing, and units must not be guessed."""
    has_unit = any(mesh.endswith(".glb") for mesh in meshes)
    return on_samples(*(("--units", "m") if has_unit else ()), *meshes)


# Convex, concave, hollow, open and inside-out meshes, and all formats of the samples.
MESHES = (
    "box.obj",
    "box_flush.stl",
    "box_pushed.stl",
    "cube.off",
    "fin_box.obj",
    "inside_out.stl",
    "kettle.obj",
    "l_bracket.obj",
    "link_a.ply",
    "link_b.glb",
    "needle.stl",
    "open_box.off",
    "peg_in_arm.ply",
    "ring.glb",
    "rod.stl",
    "snowflake.obj",
)
MORE_MESHES = ("far_a.obj", "far_b.obj", "peg_in_notch.ply", "seed_in_arm.stl")


def sample_pairs() -> list[Call]:
    pairs = [in_metres(*pair) for pair in combinations(MESHES, 2)]
    pairs += [
        on_samples("far_a.obj", "far_b.obj"),
        on_samples("box.obj", "box.obj"),
        on_samples("l_bracket.obj", "peg_in_notch.ply"),
        on_samples("l_bracket.obj", "seed_in_arm.stl"),
        # The other way round.
        on_samples("box_pushed.stl", "box.obj"),
        on_samples("snowflake.obj", "kettle.obj"),
        on_samples("peg_in_arm.ply", "l_bracket.obj"),
    ]
    with_options = [
        ("--clearance", "0.75", "box.obj", "cube.off"),
        ("--clearance", "0.5", "box.obj", "cube.off"),
        ("--clearance", "0.25", "box.obj", "cube.off"),
        ("--clearance", "1.5", "l_bracket.obj", "peg_in_notch.ply"),
        ("--clearance", "2", "--units", "m", "ring.glb", "rod.stl"),
        ("--clearance", "0.1", "--units", "m", "link_a.ply", "link_b.glb"),
        ("--tolerance", "0", "box.obj", "box_flush.stl"),
        ("--tolerance", "0.6", "l_bracket.obj", "peg_in_arm.ply"),
        ("--surface-tolerance", "0.3", "l_bracket.obj", "peg_in_arm.ply"),
        ("--allow-open", "open_box.off", "cube.off"),
        ("--allow-open", "open_box.off", "box_pushed.stl"),
        ("--no-depth", "kettle.obj", "snowflake.obj"),
        ("--contacts", "box.obj", "box_pushed.stl"),
        ("--contacts", "box.obj", "box_flush.stl"),
        ("--components", "kettle.obj", "snowflake.obj"),
        ("--components", "--volume", "box.obj", "box_pushed.stl"),
        ("--volume", "kettle.obj", "snowflake.obj"),
        ("--cross-check", "l_bracket.obj", "peg_in_arm.ply"),
        ("--accuracy", "aabb", "l_bracket.obj", "peg_in_notch.ply"),
        ("--accuracy", "hull", "l_bracket.obj", "peg_in_notch.ply"),
        ("--accuracy", "hull", "box.obj", "box_pushed.stl"),
        ("--method", "sat", "box.obj", "box_pushed.stl"),
        ("--method", "gjk", "box.obj", "box_pushed.stl"),
        ("--planar", "xy", "box.obj", "box_pushed.stl"),
        ("--planar", "xy", "l_bracket.obj", "peg_in_notch.ply"),
        ("--fail-on", "note", "box.obj", "box_flush.stl"),
        ("--exit-zero", "box.obj", "box_pushed.stl"),
        ("box.obj", "missing.obj"),
        ("box.obj", "ring.glb"),
    ]
    return [*pairs, *(on_samples(*arguments) for arguments in with_options)]


def sample_scenes() -> list[Call]:
    scenes = [
        on_samples("--units", "m", "--no-depth", *MESHES, *MORE_MESHES),
        on_samples("--units", "m", "--clearance", "0.5", "--no-depth", *MESHES, *MORE_MESHES),
        on_samples("--units", "m", "--between", "box", "*", *MESHES),
        on_samples("cell.toml"),
        on_samples("--depth", "cell.toml"),
        on_samples("--clearance", "50mm", "cell.toml"),
        on_samples("--clearance", "0.25", "crossed_edges.toml"),
        on_samples("workcell.json"),
        on_samples("--depth", "workcell.json"),
        on_samples("arm.urdf"),
        on_samples("--depth", "arm.urdf", "arm.srdf"),
        on_samples("arm.urdf", "--pose", '{"grip": 0.125}'),
        on_samples("arm.urdf", "arm.srdf", "--state", "bowed"),
        on_samples("arm.urdf", "arm.srdf", "--state", "folded", "--depth"),
        on_samples("arm.urdf", "arm.srdf", "--pose", "arm_poses.json"),
        on_samples("arm.urdf", "arm.srdf", "--sample", "60", "--seed", "7"),
        on_samples("arm.urdf", "arm.srdf", "--path", "arm_poses.json"),
        on_samples("yard.sdf"),
        on_samples("--depth", "yard.sdf"),
        on_samples("lift.xml"),
        on_samples("--state", "up", "--depth", "lift.xml"),
        on_samples("gripper.glb"),
        on_samples("--depth", "gripper.glb"),
        on_samples("--split", "components", "--units", "m", "kettle.obj"),
        on_samples("--split", "none", "--units", "m", "gripper.glb", "box.obj"),
        on_samples("--depth", "rack.3mf"),
        on_samples("--split", "nodes", "--units", "mm", "--no-depth", "link_a.ply", "rack.3mf"),
        Call("docs/bench.usda", check("--depth", "bench.usda"), DOCS),
        Call("docs/room.toml", check("room.toml"), DOCS),
    ]
    return [*scenes, *other_commands()]


def other_commands() -> list[Call]:
    baseline = f"{OUT}/baseline.json"
    report = f"{OUT}/report.json"
    results = f"{OUT}/results.jsonl"
    certified = [
        ("box.obj", "box_pushed.stl"),
        ("box.obj", "box_flush.stl"),
        ("box.obj", "cube.off", "--clearance", "0.75"),
        ("l_bracket.obj", "peg_in_arm.ply"),
        ("l_bracket.obj", "seed_in_arm.stl"),
        ("link_a.ply", "link_b.glb", "--units", "m"),
        ("workcell.json", "--depth"),
    ]
    return [
        Call("each", ("batch", *check("."))),
        Call(
            "batch",
            ("batch", *PLAIN, "cell.toml", "workcell.json", "crossed_edges.toml", "-o", results),
            document=results,
        ),
        Call("resolve meshes", ("resolve", *JSON, "box.obj", "box_pushed.stl", "l_bracket.obj")),
        Call(
            "resolve with a pinned body",
            ("resolve", *JSON, "--pin", "box", "box.obj", "box_pushed.stl", "peg_in_arm.ply"),
        ),
        Call(
            "resolve crossed_edges.toml",
            ("resolve", *JSON, "--clearance", "0.5", "crossed_edges.toml"),
        ),
        Call(
            "baseline, the same scene",
            check("--baseline", baseline, "box.obj", "box_pushed.stl", "l_bracket.obj"),
            before=(
                check("box.obj", "box_pushed.stl", "l_bracket.obj", "-o", report),
                ("baseline", "write", baseline, report),
            ),
        ),
        Call(
            "baseline, one body more",
            check("--baseline", baseline, "box.obj", "box_pushed.stl", "l_bracket.obj"),
            before=(
                check("box.obj", "box_pushed.stl", "-o", report),
                ("baseline", "write", baseline, report),
            ),
        ),
        *(
            Call(
                f"verify {' '.join(arguments)}",
                ("verify", *JSON, report),
                before=(check("--certificate", "-o", report, *arguments),),
            )
            for arguments in certified
        ),
    ]


def data_pairs() -> list[Call]:
    """In the order of kinds: convex, concave, touching, contained, linked, nested, open, far off.
    A scene states how its pair relates: gap, pen(etrating), deep, in, rings, nest, touch."""
    pairs = [
        ("manifold/Generic_Twin_7863.1.t0_left.obj", "manifold/Generic_Twin_7863.1.t0_right.obj"),
        ("manifold/Havocglass8_left.obj", "manifold/Havocglass8_right.obj"),
        ("manifold/Offset3.obj", "manifold/Offset4.obj"),
        ("parry/bar.obj", "parry/center_cylinder.obj"),
        ("parry/bar.obj", "parry/offset_cylinder.obj"),
        ("parry/stairs.obj", "parry/low_poly_bunny.obj"),
        ("vhacd/torus1.obj", "vhacd/torus2.obj"),
        ("vhacd/box-thick.obj", "vhacd/cube-notch.obj"),
        ("moveit/link5.stl", "moveit/link5.stl"),
    ]
    scenes = sorted(file.name for file in (DATA / "pairs").glob("*.json"))
    fits = sorted(file.name.removesuffix("_a.obj") for file in (DATA / "fits").glob("*_a.obj"))
    return [
        *(on_data(*pair, folder="pairs") for pair in pairs),
        *(on_data("--depth", scene, folder="pairs") for scene in scenes),
        on_data("--clearance", "0.1", "parry/bar.obj", "parry/center_cylinder.obj", folder="pairs"),
        *(on_data(f"{fit}_a.obj", f"{fit}_b.obj", folder="fits") for fit in fits),
        *found(),
    ]


def found() -> list[Call]:
    return [
        on_data("a.obj", "b.obj", folder="found/01-edge-touch"),
        on_data("spiral.obj", "probe_double.obj", folder="found/02-selfoverlap-extrude"),
        on_data("spiral.obj", "probe_outside.obj", folder="found/02-selfoverlap-extrude"),
        on_data("open.stl", "in.stl", folder="found/05-cube-one-triangle-missing"),
        on_data("open.stl", "out.stl", folder="found/05-cube-one-triangle-missing"),
        on_data("two.obj", "p1.obj", folder="found/06-two-cubes-shared-edge-opposite-winding"),
        on_data("c.obj", "bar.obj", folder="found/10-c-profile"),
        on_data("a.obj", "b.obj", folder="found/13-degenerate-triangle"),
        on_data("hit.sdf", folder="found/15-sdf-mirrored-mesh"),
        on_data("miss.sdf", folder="found/15-sdf-mirrored-mesh"),
        on_data("r.urdf", folder="found/16-urdf-negative-scale"),
        on_data("r2.urdf", folder="found/16-urdf-negative-scale"),
        on_data(
            "--surface-tolerance",
            "0.02",
            "plate.stl",
            "peg_big.stl",
            folder="found/22-round-peg-hole",
        ),
        on_data("t.stl", "in.stl", folder="found/30-t-junctions"),
        on_data("t.stl", "notch.stl", folder="found/30-t-junctions"),
        on_data("dup.obj", "flush.obj", folder="found/31-duplicate-triangles"),
        on_data("a.obj", "c.obj", folder="found/33-long-thin"),
        on_data("--planar", "xy", "l1.obj", "l2.obj", folder="found/36-planar-interlock"),
        on_data("i.usda", folder="found/50-usd-point-instancer"),
        on_data("--geometry", "collision", "c.usda", folder="found/51-usd-disabled-collider"),
        on_data("inst.glb", folder="found/53-scaled-instances"),
        on_data("wagon.glb", folder="found/wagon"),
    ]


def data_scenes() -> list[Call]:
    panda = ("--package", "moveit_resources_panda_description=.", "panda.urdf", "panda.srdf")
    kitchen = ("--package", "motion_bench_maker/configs/scenes/kitchen=.", "kitchen.urdf")
    return [
        on_data("scene.json", folder="scenes/dodeca_chain"),
        on_data("--clearance", "0.5", "scene.json", folder="scenes/dodeca_chain"),
        on_data("--split", "components", "dodeca_chain_loop.3mf", folder="scenes/dodeca_chain"),
        on_data("--depth", "dodeca_chain_slack/scene.json", folder="scenes"),
        on_data("platformer.gltf", folder="scenes/platformer"),
        on_data(*kitchen, folder="scenes/kitchen"),
        on_data(*panda, folder="scenes/panda"),
        on_data(*panda, "--sample", "40", folder="scenes/panda"),
        Call(
            "each support", ("batch", *check("--rules", "stands.toml", "*.json")), DATA / "support"
        ),
        # One call a format, since one process then reads all its files.
        *(each(f"formats/{name}", f"features/{name}") for name in FORMATS),
        each("features/3mf"),
        each("features/urdf"),
        on_data("--geometry", "collision", "physics.usda", folder="formats/usd"),
        on_data("--clearance", "5mm", "bricks_instanced.glb", folder="formats/gltf"),
        on_data("--volume", "meshes.usdc", folder="formats/usd"),
        Call(
            "features of two files",
            ("batch", *PLAIN, "--units", "m", "--manifest", "two_files.jsonl", "-o", RESULTS),
            DATA / "features",
            document=RESULTS,
        ),
        on_data("r.urdf", "r.srdf", "--state", "s", folder="features/srdf/011_group_state_used"),
    ]


RESULTS = f"{OUT}/results.jsonl"
FORMATS = ("gltf", "ifc", "mjcf", "sdf", "step", "usd")


def each(*folders: str) -> Call:
    """Each file of the folders as a scene of its own."""
    return Call(f"each {' '.join(folders)}", ("batch", *check("--depth", *folders)), DATA)


GROUPS = {
    "sample_pairs": sample_pairs,
    "sample_scenes": sample_scenes,
    "data_pairs": data_pairs,
    "data_scenes": data_scenes,
}
