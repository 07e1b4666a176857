"""Reports made by hand, for the renderers."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck.audit import Settings
from satcheck.audit.messages import with_messages
from satcheck.core.mesh_health import MeshHealth
from satcheck.report.contacts import Contacts, ContactTotals, Curve, Patch
from satcheck.report.report import (
    Ball,
    BodyReport,
    Finding,
    Issue,
    PairCounts,
    PartError,
    Report,
    Stage,
    Summary,
    Tool,
    Witness,
)
from satcheck.report.sweep import Sweep

PENETRATING = Finding(
    id="block|block_pushed",
    a="block",
    b="block_pushed",
    rule=None,
    severity="error",
    relation="penetrating",
    exact_relation="penetrating",
    tolerance=2.5e-7,
    distance=None,
    depth=1.0,
    depth_bounds=(1.0, 1.0),
    quality="exact",
    normal=(1.0, 0.0, 0.0),
    mtv=(-1.0, 0.0, 3e-17),
    mtv_moves="a",
    mtv_verified=True,
    witness=Witness((2.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
    volume=None,
    contacts=None,
    certificate=None,
    reason=None,
    plan=(
        Stage("aabb", "overlap", 0.25, "the boxes overlap"),
        Stage("hull", "penetrating", 11.5, "both are convex: nothing finer is needed"),
    ),
    baseline_state=None,
)
THICK = replace(
    PENETRATING,
    thickness=0.5,
    thickness_bounds=(0.5, 0.5),
    ball=Ball((1.5, 1.5, 1.5), 0.25),
)
SEPARATED = replace(
    PENETRATING,
    id="block|far",
    b="far",
    severity="none",
    relation="separated",
    exact_relation="separated",
    distance=None,
    depth=None,
    depth_bounds=None,
    normal=None,
    mtv=None,
    mtv_moves=None,
    mtv_verified=None,
    witness=None,
)
BOUNDED = replace(
    PENETRATING,
    id="a_rather_long_name|another_rather_long_name",
    a="a_rather_long_name",
    b="another_rather_long_name",
    relation="contains",
    exact_relation="contains",
    depth=1.2500004,
    depth_bounds=(1.2412345678, 1.2500004),
    quality="bounded",
    mtv=(0.123456789, -1.23456789, 0.456789123),
)
TOUCHING = replace(
    SEPARATED,
    id="block|flush",
    b="flush",
    severity="note",
    relation="touching",
    exact_relation="penetrating",
)
UNDECIDED = replace(
    SEPARATED,
    id="block|soup",
    b="soup",
    severity="warning",
    undecided="relation",
    relation="indeterminate",
    exact_relation=None,
    quality=None,
    reason="the time limit was reached",
)
ESTIMATE = replace(
    PENETRATING,
    id="block|perhaps",
    b="perhaps",
    exact_relation=None,
    quality="estimate",
    depth=2.0,
    depth_bounds=(0.0, 2.0),
    reason="not proven at --accuracy aabb",
)
SQUARE = ((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0, 1.0))
CONTACTS = Contacts(
    curves=(Curve(SQUARE, True, 4.0),),
    patches=(Patch((SQUARE,), (0.0, 0.0, 1.0), True, 1.0),),
    points=((5.0, 5.0, 5.0),),
    triangle_pairs=((3, 4), (3, 5)),
    totals=ContactTotals(1, 4.0, 1, 1.0, 1, 2),
)
SWEEP = Sweep(relation="separated", tolerance=0.0, reached=1.0)
SWEPT = replace(
    SEPARATED,
    id="block|passer",
    b="passer",
    placed_relation="separated",
    motion=SWEEP,
)
HIT = replace(
    SWEPT,
    severity="error",
    relation="penetrating",
    motion=Sweep(relation="penetrating", tolerance=0.0, reached=0.5, time_of_impact=(0.25, 0.5)),
)
CROSSING = replace(
    PENETRATING,
    id="block|crossing",
    b="crossing",
    volume=0.328125,
    volume_error=1e-12,
    contacts=CONTACTS,
)
HEALTH = MeshHealth(
    vertices=8,
    triangles=12,
    components=1,
    boundary_edges=0,
    nonmanifold_edges=0,
    misoriented_edges=0,
    degenerate_triangles=0,
    duplicate_triangles=0,
    cracks=0,
    holes=0,
    largest_hole=0.0,
    closed=True,
    manifold=True,
    oriented=True,
    volume=1.0,
    inside_out=False,
    double_sided=False,
    flat=False,
    solid=True,
)
BLOCK = BodyReport(
    id="block",
    name="block",
    file="block.obj",
    sha256="0" * 64,
    path=None,
    transform=None,
    groups=(),
    static=False,
    triangles=12,
    health=HEALTH,
    resolution=2.5e-7,
    convex=True,
    parts=None,
    part_error=None,
)
SOUP = replace(
    BLOCK,
    id="soup",
    name="soup",
    file="soup.stl",
    triangles=1234,
    health=replace(HEALTH, closed=False, solid=False, holes=1),
    convex=False,
    parts=3,
    part_error=PartError(0.25, 0.0),
)
OPEN = Issue("not-closed", "warning", "soup", "soup.stl", "open mesh (1 hole, 2 across)")
MISSING = Issue("unreadable", "error", None, "gone.obj", "there is no such file")


def report(
    *findings: Finding,
    bodies: tuple[BodyReport, ...] = (BLOCK, SOUP),
    issues: tuple[Issue, ...] = (),
    units: str | None = None,
) -> Report:
    """A consistent report over these findings."""
    undecided = sum(finding.relation == "indeterminate" for finding in findings)
    warned = any(finding.severity == "warning" for finding in findings)
    found = any(finding.severity == "error" for finding in findings)
    return with_messages(
        Report(
            tool=Tool("satcheck", "0.1.0"),
            units=units,
            settings=Settings().stated(depth=True, thickness=True),
            summary=Summary(
                verdict="fail" if found else "incomplete" if warned else "pass",
                pairs=PairCounts(len(findings), 0, len(findings) - undecided, 0, undecided),
                by_relation={
                    relation: sum(finding.relation == relation for finding in findings)
                    for relation in {finding.relation for finding in findings}
                },
            ),
            bodies=bodies,
            findings=findings,
            issues=issues,
        )
    )
