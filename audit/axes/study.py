"""The report about the candidate axes of two bodies of a scene."""

from __future__ import annotations

from satcheck.audit.axes.hulls import studied_hulls
from satcheck.audit.axes.outlines import studied_outlines
from satcheck.audit.request.settings import Settings
from satcheck.audit.studied_pair import pair_of, two_of
from satcheck.audit.summary import tool
from satcheck.core.conventions import Plane
from satcheck.report.axes import AxesReport
from satcheck.scene import Scene


def axes_of(
    scene: Scene,
    bodies: tuple[str, str] | None = None,
    *,
    planar: Plane | None = None,
    allow_open: bool = False,
) -> AxesReport:
    """bodies: the ids of A and B; None: the scene has only two.

    Raises SatcheckError: `not-a-pair`, `no-such-body`, `curved-shape` (it has no faces),
    `flat-bodies` (both are flat and parallel, or one is less than a polygon), `too-many-axes`, and
    the codes of bodies that cannot be used.
    """
    if planar is None:
        scene.require_in_space("add --planar xy")
    else:
        from satcheck.scene.planar.flat_scene import flat_scene

        scene = flat_scene(scene, planar, allow_open=allow_open)
    settings = Settings(planar=planar, allow_open=allow_open)
    pair = pair_of(two_of(scene, bodies), settings)
    studied = studied_hulls(pair) if planar is None else studied_outlines(pair, planar)
    return AxesReport(
        tool=tool(),
        units=pair.a.body.units,
        planar=planar,
        of="bodies" if studied.a.convex and studied.b.convex else "hulls",
        a=studied.a,
        b=studied.b,
        relation=studied.relation,
        distance=studied.distance,
        tolerance=pair.tolerance,
        gjk_steps=studied.gjk_steps,
        counts=studied.counts,
        early_out=studied.axes.early_out(),
        winner=studied.winner(),
        axes=studied.axes.ranked(),
        left_out=0,
    )
