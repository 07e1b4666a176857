"""`check_meshes`: the check of two meshes in memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.audit.check import DEFAULT_SETTINGS, check_meshes_of
from satcheck.audit.settings import Settings, require_settings
from satcheck.core.errors import SatcheckError
from satcheck.core.mesh_arrays import MeshLike
from satcheck.report.report import Finding
from satcheck.scene.meshes import scene_of_meshes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def check_meshes(
    a: MeshLike,
    b: MeshLike,
    *,
    pose_a: ArrayLike | None = None,
    pose_b: ArrayLike | None = None,
    settings: Settings | None = None,
) -> Finding:
    """How two meshes in memory relate, how deep they overlap, and the shortest way out.

    a, b: an object with `vertices` and `faces` (or `triangles`), such as a trimesh.Trimesh, or a
    pair (vertices, faces). A mesh that is checked often is prepared once as a `satcheck.Mesh`.
    vertices: (n, 3), any integer or float type, one unit of length for both meshes. faces: (m, 3),
    any integer type, counter-clockwise seen from outside.
    pose_a, pose_b: rigid 4x4 matrices for column vectors, world = pose * (x, y, z, 1); None: the
    vertices are world coordinates.
    settings: what to compute, as `satcheck.Settings` describes; None: the defaults of the command.

    This is `check` of two files that hold these meshes: the same steps and the same verdicts, to
    the precision of the array types. Useful fields of the finding, world frame:

    - relation: "separated", "near", "touching", "penetrating", "contains" (b in a), "inside" (a in
      b), "coincident", or "indeterminate" with a `reason`.
    - distance: the gap, >= 0, of bodies that do not overlap, with Settings(distance=True), or up to
      settings.clearance; else None.
    - depth and depth_bounds of bodies that overlap; mtv: the translation that frees a, verified.
    - quality: "exact", "bounded" (depth lies within depth_bounds) or "estimate" (not proven).

    The bodies of every finding are called a and b, so all findings have one id. With names, also
    for two meshes: `check(scene_of_meshes({"box": a, "lid": b}))`.

    Raises SatcheckError: `bad-argument` for arrays and poses of another form, for indices out of
    range, for coordinates that are not finite and for poses that are not rigid; the code of a mesh
    file for a mesh that cannot be used, such as `only-degenerate`; `bad-setting` for certificates,
    which name files.
    """
    settings = DEFAULT_SETTINGS if settings is None else settings
    require_settings(settings)
    if settings.certificate:
        raise SatcheckError("bad-setting", "certificate: certificates name files; write the meshes")
    scene = scene_of_meshes({"a": a, "b": b}, {"a": pose_a, "b": pose_b})
    if settings.list_pruned is False:
        settings = replace(settings, list_pruned=True)
    return check_meshes_of(scene, settings)
