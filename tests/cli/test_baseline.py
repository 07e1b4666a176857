"""A baseline over the life of an asset repository, and what counts as worse."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit.baseline import (
    absent_from,
    asset_key,
    beside_baseline,
    files_of,
    gone_assets,
    known_findings,
    updated,
)
from satcheck.report.baseline import Baseline, KnownFinding
from satcheck.report.report import Finding, Relation, Report, RuleReport
from satcheck.report.sweep import WorstPose
from tests.audit.shapes import open_box, unit_box, write
from tests.cli.process import PUSHED, SAMPLES, Ran, satcheck
from tests.cli.reports import (
    BOUNDED,
    HIT,
    PENETRATING,
    SEPARATED,
    THICK,
    TOUCHING,
    UNDECIDED,
    report,
)

DEEPER = replace(BOUNDED, relation="penetrating")
KNOWN = KnownFinding(
    a=DEEPER.a,
    b=DEEPER.b,
    severity="error",
    relation="penetrating",
    depth=DEEPER.depth,
    reason="a press fit",
)
CLOSE = replace(SEPARATED, severity="error", relation="near", distance=0.5)
TOUCH = replace(CLOSE, severity="error", relation="touching", distance=None)
SHARED = replace(PENETRATING, volume=2.0, volume_error=0.5)
RULE = RuleReport("*", "*", None, None, None, None, None, None, None, "", "a.toml:1")


def state(known: KnownFinding, finding: Finding) -> str | None:
    judged = beside_baseline(report(finding), Baseline(findings=(known,)), "b.json")
    return judged.findings[0].baseline_state


def after(before: Finding, now: Finding) -> str | None:
    return beside(report(before), report(now))


def beside(before: Report, now: Report) -> str | None:
    known = Baseline(findings=tuple(known_findings(before)))
    return beside_baseline(now, known, "b.json").findings[0].baseline_state


def deep(least: float, most: float) -> Finding:
    return replace(DEEPER, depth_bounds=(least, most), depth=most)


def swept(
    depth: tuple[float, float] | None = None, distance: tuple[float, float] | None = None
) -> Finding:
    assert HIT.motion is not None
    worst = WorstPose(0.5, (), depth=depth, distance=distance)
    return replace(HIT, motion=replace(HIT.motion, worst=worst))


def test_no_worse_than_known_is_unchanged() -> None:
    assert DEEPER.depth is not None
    assert DEEPER.tolerance is not None
    assert state(KNOWN, DEEPER) == "unchanged"
    within, beyond = (DEEPER.depth + times * DEEPER.tolerance for times in (1, 2))
    assert state(KNOWN, deep(within, within)) == "unchanged"
    assert state(KNOWN, deep(within, beyond)) == "undecided"
    assert state(KNOWN, deep(beyond, beyond)) == "worse"


def test_a_tolerance_that_a_user_sets_is_no_precision() -> None:
    wide = replace(DEEPER, tolerance=1.0)
    deeper = replace(wide, depth_bounds=(1.5, 1.5), depth=1.5)
    before, now = report(wide), report(deeper)
    assert beside(before, now) == "unchanged"
    set_by_option = replace(now, settings=replace(now.settings, tolerance=1.0))
    assert beside(before, set_by_option) == "worse"
    assert beside(before, replace(now, rules=(replace(RULE, tolerance=1.0),))) == "worse"


@pytest.mark.parametrize(
    ("before", "now", "expected"),
    [
        (THICK, THICK, "unchanged"),
        (THICK, replace(THICK, thickness_bounds=(0.6, 0.6)), "worse"),
        (THICK, PENETRATING, "undecided"),
        (PENETRATING, THICK, "undecided"),
        (SHARED, SHARED, "unchanged"),
        (SHARED, replace(SHARED, volume=2.25), "undecided"),
        (SHARED, replace(SHARED, volume=3.5), "worse"),
        (CLOSE, CLOSE, "unchanged"),
        (CLOSE, replace(CLOSE, distance=0.25), "worse"),
        (CLOSE, replace(CLOSE, distance=None), "undecided"),
        (CLOSE, TOUCH, "worse"),
        (TOUCH, CLOSE, "unchanged"),
    ],
)
def test_each_figure_counts(before: Finding, now: Finding, expected: str) -> None:
    assert after(before, now) == expected


def test_a_motion_counts_as_its_worst_pose() -> None:
    assert after(HIT, HIT) == "undecided"
    known = swept(depth=(0.5, 0.75))
    assert after(known, known) == "unchanged"
    assert after(known, swept(depth=(0.8, 0.9))) == "worse"
    assert after(known, swept(depth=(0.5, 0.9))) == "undecided"
    near = replace(swept(distance=(0.5, 0.75)), relation="near")
    assert after(near, near) == "unchanged"
    assert HIT.motion is not None
    apart = replace(HIT, relation="separated", motion=replace(HIT.motion, relation="separated"))
    assert after(apart, apart) == "unchanged"
    assert after(near, replace(apart, relation="near")) == "undecided"
    assert after(near, replace(swept(distance=(0.1, 0.2)), relation="near")) == "worse"


def test_figures_in_other_units_are_not_compared() -> None:
    in_mm, in_m = report(DEEPER, units="mm"), report(DEEPER, units="m")
    assert beside(in_mm, in_m) == "undecided"
    known = Baseline(findings=tuple(known_findings(in_mm)))
    assert updated(known, known_findings(in_m)).findings[0].units == "m"


@pytest.mark.parametrize(
    ("before", "now", "expected"),
    [
        ("penetrating", "contains", "worse"),
        ("touching", "penetrating", "worse"),
        ("coincident", "penetrating", "unchanged"),
    ],
)
def test_a_graver_relation_is_worse(before: Relation, now: Relation, expected: str) -> None:
    assert state(replace(KNOWN, relation=before), replace(DEEPER, relation=now)) == expected


def test_the_order_of_the_bodies_does_not_matter() -> None:
    assert state(replace(KNOWN, a=KNOWN.b, b=KNOWN.a), DEEPER) == "unchanged"


def test_a_depth_that_is_not_measured_again_is_not_accepted() -> None:
    assert state(KNOWN, replace(DEEPER, depth=None, depth_bounds=None)) == "undecided"


def test_what_passes_or_is_open_has_no_state() -> None:
    known = replace(KNOWN, a="block", b="soup")
    assert state(known, SEPARATED) is None
    judged = beside_baseline(report(UNDECIDED), Baseline(findings=(known,)), "b.json")
    assert judged.findings[0].baseline_state is None
    assert judged.summary.verdict == "incomplete"


def test_only_new_and_worse_findings_fail() -> None:
    checked = report(DEEPER, PENETRATING)
    known = Baseline(findings=tuple(known_findings(checked)))
    accepted = beside_baseline(checked, known, "b.json")
    assert (accepted.summary.verdict, accepted.summary.accepted) == ("pass", 2)
    one = beside_baseline(checked, Baseline(findings=known.findings[:1]), "b.json")
    assert (one.summary.verdict, one.summary.accepted) == ("fail", 1)


def test_a_worse_finding_says_what_was_known() -> None:
    now = beside_baseline(report(deep(2.5, 2.5)), Baseline(findings=(KNOWN,)), "b.json")
    assert KNOWN.depth is not None
    said = f"2.5 to pull apart, the baseline has depth {KNOWN.depth:g})"
    assert said in now.message
    assert said in now.findings[0].message
    graver = replace(DEEPER, relation="contains")
    (finding,) = beside_baseline(report(graver), Baseline(findings=(KNOWN,)), "b.json").findings
    assert finding.reason == f"the baseline has penetrating, depth {KNOWN.depth:g}"


def test_a_baseline_that_is_not_there(tmp_path: Path) -> None:
    ran = satcheck(*PUSHED, "--baseline", str(tmp_path / "none.json"))
    assert "none.json: no such file: `satcheck baseline write` makes one" in ran.err


def test_a_finding_is_absent_only_if_its_pair_was_checked() -> None:
    gone, elsewhere = replace(KNOWN, a="block", b="soup"), replace(KNOWN, a="block", b="moon")
    baseline = Baseline(findings=(gone, elsewhere, replace(gone, asset="other.glb")))
    assert absent_from(report(SEPARATED), baseline) == [gone]
    assert absent_from(report(UNDECIDED), baseline) == []
    for unseen in (replace(gone, motion_depth=1.0), replace(gone, units="mm")):
        assert absent_from(report(SEPARATED), Baseline(findings=(unseen,))) == []
    assert absent_from(report(SEPARATED, units="m"), Baseline(findings=(gone,))) == [gone]


def test_a_gap_is_absent_only_if_the_check_would_show_it() -> None:
    touch, near = (replace(finding, b="soup") for finding in (TOUCHING, CLOSE))
    known = Baseline(
        findings=(
            *known_findings(fails_on_notes(report(replace(touch, severity="note")))),
            *known_findings(report(near)),
        )
    )
    checked = report(replace(SEPARATED, b="soup"))
    assert absent_from(checked, known) == []
    assert absent_from(fails_on_notes(checked), known) == [known.findings[0]]
    small, large = (
        replace(checked, rules=(replace(RULE, clearance=most),)) for most in (0.25, 1.0)
    )
    assert absent_from(small, known) == []
    assert absent_from(large, known) == [known.findings[1]]


def fails_on_notes(checked: Report) -> Report:
    return replace(checked, settings=replace(checked.settings, fail_on="note"))


def test_an_update_keeps_reasons_and_the_worse_figures() -> None:
    known = replace(KNOWN, distance=0.5, volume=1.0)
    new = replace(KNOWN, depth=9.0, distance=0.75, thickness=2.0, reason="")
    expected = replace(known, depth=9.0, thickness=2.0)
    assert updated(Baseline(findings=(known,)), [new]).findings == (expected,)
    better = replace(KNOWN, relation="near", depth=0.5)
    assert updated(Baseline(findings=(known,)), [better]).findings == (known,)


def test_links_to_folders_do_not_change_a_key(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "parts")
    known = tmp_path / "known.json"
    assert asset_key([str(tmp_path / "link" / "a.glb")], known) == "parts/a.glb"
    assert asset_key([str(tmp_path / "parts" / "a.glb")], tmp_path / "link" / "b.json") == "a.glb"


def test_a_comma_may_be_part_of_the_name_of_a_file(tmp_path: Path) -> None:
    for name in ("p, q.obj", "r.obj"):
        (tmp_path / name).write_text("")
    known = tmp_path / "known.json"
    key = asset_key([str(tmp_path / "p, q.obj"), str(tmp_path / "r.obj")], known)
    assert files_of(key, tmp_path) == ["p, q.obj", "r.obj"]
    baseline = Baseline(findings=(replace(KNOWN, asset=key),))
    assert not gone_assets(baseline, known)
    (tmp_path / "r.obj").unlink()
    assert gone_assets(baseline, known) == {key: 1}


class Repository:
    """A folder of assets, and the commands of its CI."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.copy(SAMPLES / "gripper.glb", folder)
        shutil.copy(SAMPLES / "box.obj", folder)

    def run(self, *arguments: str) -> Ran:
        return satcheck(*arguments, cwd=self.folder)

    def report(self) -> None:
        self.run("batch", ".", "--depth", "-o", "report.json")

    def gate(self) -> Ran:
        return self.run("batch", ".", "--depth", "--baseline", "known.json")

    def known(self) -> list[str]:
        document = json.loads((self.folder / "known.json").read_text())
        return [finding["asset"] for finding in document["findings"]]


def test_the_life_of_a_baseline(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.report()
    write = ("baseline", "write", "known.json", "report.json", "--reason", "a press fit")
    assert [repository.run(*write).code for _ in range(2)] == [0, 2]
    assert repository.known() == ["gripper.glb"]
    assert repository.gate().code == 0

    renamed = tmp_path.parent / "other.glb"
    shutil.copy(SAMPLES / "gripper.glb", renamed)
    elsewhere = repository.run("batch", str(renamed), "--baseline", "known.json")
    said = " ".join(elsewhere.out.split())
    assert "Baseline: 0 known findings, 1 new. It knows none of these: it names assets by" in said

    shutil.copy(SAMPLES / "rack.3mf", tmp_path)
    failed = repository.gate()
    assert failed.code == 1
    assert "1 known finding, 1 new" in failed.out
    unmeasured = repository.run("batch", ".", "--no-depth", "--baseline", "known.json")
    assert unmeasured.code == 1
    assert "1 undecided. An undecided finding has no figure to compare" in unmeasured.out
    repository.report()
    update = ("baseline", "update", "known.json", "report.json", "--reason", "to be mended")
    assert "2 findings, 1 added, 0 changed, 0 removed" in repository.run(*update).out
    known = json.loads((tmp_path / "known.json").read_text())
    known["findings"][0]["depth"] /= 2
    (tmp_path / "known.json").write_text(json.dumps(known))
    assert repository.gate().code == 1
    assert "2 findings, 0 added, 1 changed, 0 removed" in repository.run(*update).out
    assert repository.known() == ["gripper.glb", "rack.3mf"]
    assert repository.gate().code == 0

    apart = json.loads((tmp_path / "report.json").read_text())
    assert {each["verdict"] for each in apart["assets"]} == {"pass", "fail"}
    shutil.copy(SAMPLES / "arm_beam.stl", tmp_path / "gripper.stl")
    (tmp_path / "gripper.glb").unlink()
    gone = "1 known finding of 1 asset that is gone (gripper.glb): satcheck baseline prune"
    assert repository.gate().out.count(gone) == 1
    in_other_folder = tmp_path / "empty"
    in_other_folder.mkdir()
    shutil.copy(tmp_path / "known.json", in_other_folder)
    moved = repository.run("batch", "rack.3mf", "--baseline", "empty/known.json")
    assert "2 assets that are gone" in moved.out
    assert "was it written in another folder?" in " ".join(moved.out.split())
    repository.run("batch", ".", "--depth", "--baseline", "known.json", "-o", "report.json")
    pruned = repository.run("baseline", "prune", "known.json", "report.json")
    assert "1 removed" in pruned.out
    assert "gone" not in pruned.err
    assert repository.known() == ["rack.3mf"]


def test_a_baseline_that_stands_in_another_folder_loses_nothing(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.report()
    repository.run("baseline", "write", "known.json", "report.json")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    shutil.move(tmp_path / "known.json", elsewhere)
    (elsewhere / "report.json").write_text(
        (tmp_path / "report.json").read_text().replace("gripper.glb", "other.glb")
    )
    ran = repository.run("baseline", "prune", "elsewhere/known.json", "elsewhere/report.json")
    assert ran.code == 2
    assert "was it written in another folder?" in " ".join(ran.err.split())


def test_an_asset_of_several_files_is_known_by_all_of_them(tmp_path: Path) -> None:
    """From a folder beside the baseline, also in a plain check of these files."""
    work = tmp_path / "work"
    work.mkdir()
    names = [Path(name).name for name in PUSHED]
    for name in PUSHED:
        shutil.copy(SAMPLES / name, work)
    (work / "list.txt").write_text(json.dumps(names) + "\n")
    batch = ("batch", "--manifest", "list.txt")
    first = satcheck(*batch, "-o", "report.json", cwd=work)
    assert f"Next: satcheck {' '.join(names)} lists its pairs." in first.err
    known = ("--baseline", "../known.json")
    assert satcheck("baseline", "write", known[1], "report.json", cwd=work).code == 0
    for call in (batch, names):
        ran = satcheck(*call, *known, cwd=work)
        assert (ran.code, "Baseline: 1 known finding." in ran.out) == (0, True)
        assert "gone" not in ran.out + ran.err


def test_an_asset_of_a_report_is_not_gone(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.report()
    repository.run("baseline", "write", "known.json", "report.json")
    (tmp_path / "gripper.glb").unlink()
    assert "0 removed" in repository.run("baseline", "prune", "known.json", "report.json").out


def test_a_check_of_one_file_is_known_by_the_name_of_its_asset(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.report()
    repository.run("baseline", "write", "known.json", "report.json")
    gate = ("--depth", "--baseline", "known.json")
    ran = repository.run("gripper.glb", *gate)
    assert (ran.code, "Baseline: 1 known finding." in ran.out) == (0, True)
    repository.run("gripper.glb", "--depth", "-o", "one.json")
    assert (
        "1 finding, 0 added" in repository.run("baseline", "update", "known.json", "one.json").out
    )
    known = json.loads((tmp_path / "known.json").read_text())
    known["findings"][0]["a"] = "renamed"
    (tmp_path / "renamed.json").write_text(json.dumps(known))
    repository.run("baseline", "update", "renamed.json", "one.json")
    both = json.loads((tmp_path / "renamed.json").read_text())["findings"]
    assert [each["asset"] for each in both] == ["gripper.glb"] * 2
    shutil.copy(tmp_path / "gripper.glb", tmp_path / "other.glb")
    assert "0 known findings, 1 new" in repository.run("other.glb", *gate).out
    assert "0 known findings, 1 new" in repository.run("gripper.glb", "other.glb", *gate).out
    repository.run("gripper.glb", "--max-depth", "99", "-o", "passes.json")
    assert "1 removed" in repository.run("baseline", "prune", "known.json", "passes.json").out


INDETERMINATE = {"a": "x", "b": "y", "severity": "error", "relation": "indeterminate"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{}", "`schema`"),
        ("[]", "no baseline"),
        ("{", "no baseline"),
        ('{"schema": "satcheck.baseline/2"}', "another version of satcheck: write it again"),
        ('{"schema": "satcheck.report/1"}', "no baseline"),
        (json.dumps({"schema": "satcheck.baseline/1", "findings": [INDETERMINATE]}), "relation"),
    ],
)
def test_what_is_no_baseline(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    ran = satcheck("box.obj", "cube.off", "--baseline", str(path))
    assert ran.code == 2
    assert "bad-baseline" in ran.err
    assert said in ran.err


@pytest.mark.parametrize("command", [("batch", "."), ("box.obj", "cube.off")])
def test_a_report_does_not_overwrite_its_baseline(command: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    path.write_text('{"schema": "satcheck.baseline/1"}')
    ran = satcheck(*command, "--baseline", str(path), "-o", str(path))
    assert (ran.code, "would overwrite an input" in ran.err) == (2, True)


def test_an_accepted_finding_is_named_and_not_verified(tmp_path: Path) -> None:
    first, second, known = (str(tmp_path / name) for name in ("a.json", "b.json", "known.json"))
    pair = ("box.obj", "box_pushed.stl", "--certificate")
    satcheck(*pair, "-o", first)
    assert satcheck("verify", first).code == 0
    satcheck("baseline", "write", known, first)
    ran = satcheck(*pair, "--baseline", known, "-o", second)
    assert (ran.code, "PASS: no new or worse finding." in ran.err) == (0, True)
    verified = satcheck("verify", second)
    assert (verified.code, "a baseline accepts findings" in verified.out) == (1, True)


def table(folder: Path, sunk: float) -> None:
    """A scene file of a table top of which a leg is sunk by some millimetres."""
    (folder / "table.toml").write_text(
        'schema = "satcheck.scene/1"\nunits = "mm"\n'
        + "".join(
            f'[[bodies]]\nid = "{name}"\nposition = [0, 0, {z}]\n'
            f'shape = {{type = "box", size = {size}}}\n'
            for name, z, size in (("top", 0, [800, 800, 200]), ("leg", sunk - 450, [60, 60, 700]))
        )
    )


REPORTS = {
    "folder": ("batch", "table.toml", "-o", "report.json"),
    "batch": ("batch", "table.toml", "-o", "report.jsonl"),
    "check": ("table.toml", "-o", "report.json"),
}


@pytest.mark.parametrize("command", ["folder", "batch", "check"])
def test_a_leg_that_sinks_deeper_is_caught_without_any_option(command: str, tmp_path: Path) -> None:
    def gate() -> Ran:
        *arguments, report = REPORTS[command]
        return satcheck(*arguments, f"gate_{report}", "--baseline", "known.json", cwd=tmp_path)

    table(tmp_path, 2.0)
    satcheck(*REPORTS[command], cwd=tmp_path)
    written = satcheck("baseline", "write", "known.json", REPORTS[command][-1], cwd=tmp_path)
    assert (written.code, "1 added" in written.out) == (0, True)
    assert gate().code == 0
    for made in tmp_path.glob("gate_*"):
        made.unlink()
    table(tmp_path, 91.0)
    assert gate().code == 1


def test_overlaps_of_unknown_depth_are_accepted_only_if_told(tmp_path: Path) -> None:
    table(tmp_path, 2.0)
    satcheck("table.toml", "--no-depth", "-o", "report.json", cwd=tmp_path)
    write = ("baseline", "write", "known.json", "report.json")
    refused = satcheck(*write, cwd=tmp_path)
    assert (refused.code, "1 overlap of unknown depth" in refused.err) == (2, True)
    assert "--depth" in refused.err
    assert not (tmp_path / "known.json").exists()
    assert satcheck(*write, "--without-figures", cwd=tmp_path).code == 0
    gate = satcheck("table.toml", "--baseline", "known.json", cwd=tmp_path)
    assert gate.code == 0
    assert "PASS: no new or worse finding, 1 accepted without figures." in gate.out
    satcheck("table.toml", "-o", "report.json", cwd=tmp_path)
    satcheck("baseline", "update", "known.json", "report.json", cwd=tmp_path)
    table(tmp_path, 91.0)
    assert satcheck("table.toml", "--baseline", "known.json", cwd=tmp_path).code == 1


def test_a_stored_baseline_without_figures_proves_nothing() -> None:
    bare = replace(KNOWN, depth=None)
    shallow, unmeasured = DEEPER, replace(DEEPER, depth=None, depth_bounds=None)
    assert [state(bare, now) for now in (shallow, unmeasured)] == ["undecided"] * 2
    accepted = replace(bare, unmeasured=True)
    assert [state(accepted, now) for now in (shallow, unmeasured)] == ["accepted"] * 2
    assert state(accepted, replace(DEEPER, relation="contains")) == "worse"
    assert state(accepted, replace(DEEPER, undecided="cross-check")) == "undecided"


def test_a_baseline_of_an_interrupted_batch_says_so(tmp_path: Path) -> None:
    table(tmp_path, 2.0)
    satcheck("batch", "table.toml", "-o", "report.json", cwd=tmp_path)
    path = tmp_path / "report.json"
    told = "interrupted: 1 of 2 assets was not checked"
    issue: dict[str, str | None] = {"code": "interrupted", "severity": "warning", "message": told}
    issue |= {"body": None, "file": None}
    path.write_text(json.dumps(json.loads(path.read_text()) | {"issues": [issue]}))
    for way in ("write", "update", "prune"):
        ran = satcheck("baseline", way, "known.json", "report.json", cwd=tmp_path)
        assert (ran.code, ran.err) == (0, f"satcheck: warning: {told} [interrupted]\n")


def shell(folder: Path, units: str = "mm") -> None:
    """A scene of an open shell with a box in its mouth: the fill of the hole decides."""
    write(folder, shell=open_box(), part=unit_box(1, 1, 3.5))
    (folder / "pot.toml").write_text(
        f'schema = "satcheck.scene/1"\nunits = "{units}"\n'
        '[[bodies]]\nid = "pot"\nmesh = "shell.obj"\n[[bodies]]\nid = "lid"\nmesh = "part.obj"\n'
    )


def test_an_undecided_pair_is_accepted_only_if_told_and_for_the_same_reason(tmp_path: Path) -> None:
    shell(tmp_path)
    for gate in (("batch", "pot.toml"), ("pot.toml",)):
        known = tmp_path / "known.json"
        known.unlink(missing_ok=True)
        satcheck(*gate, "-o", "report.json", cwd=tmp_path)
        write_it = ("baseline", "write", "known.json", "report.json")
        satcheck(*write_it, cwd=tmp_path)
        assert satcheck(*gate, "--baseline", "known.json", cwd=tmp_path).code == 3
        known.unlink()
        satcheck(*write_it, "--undecided", "--reason", "a pot has no lid", cwd=tmp_path)
        accepted = json.loads(known.read_text())["undecided"]
        assert [each["reason_code"] for each in accepted] == ["open-hole"]
        assert satcheck(*gate, "--baseline", "known.json", cwd=tmp_path).code == 0
        known.write_text(known.read_text().replace("open-hole", "units-unknown"))
        assert satcheck(*gate, "--baseline", "known.json", cwd=tmp_path).code == 3


def test_an_accepted_undecided_pair_is_named(tmp_path: Path) -> None:
    shell(tmp_path)
    satcheck("pot.toml", "-o", "report.json", cwd=tmp_path)
    satcheck("baseline", "write", "known.json", "report.json", "--undecided", cwd=tmp_path)
    ran = satcheck("pot.toml", "--baseline", "known.json", "--format", "json", cwd=tmp_path)
    assert "1 accepted undecided (pot and lid)" in ran.document["message"]
    (finding,) = ran.document["findings"]
    assert (finding["relation"], finding["baseline_state"]) == ("indeterminate", "accepted")
    assert "[baseline: accepted undecided]" in finding["message"]
    assert ran.document["summary"]["pairs"]["indeterminate"] == 1


def test_other_units_are_a_reason_too_and_an_unreadable_body_is_none(tmp_path: Path) -> None:
    (tmp_path / "box.obj").write_text((SAMPLES / "box.obj").read_text())
    shutil.copy(SAMPLES / "gripper.glb", tmp_path)
    (tmp_path / "lost.obj").write_text("v 0 0 0\n")
    files = ("box.obj", "gripper.glb", "lost.obj", "-o", "report.json")
    satcheck(*files, cwd=tmp_path)
    findings = json.loads((tmp_path / "report.json").read_text())["findings"]
    codes = {(f["a"], f["b"]): f["reason_code"] for f in findings if f["undecided"]}
    assert set(codes.values()) == {"units-unknown", None}
    assert all((code is None) == ("lost" in pair) for pair, code in codes.items())


def test_results_of_a_batch_make_the_same_baseline_as_its_report(tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "gripper.glb", tmp_path)
    satcheck("batch", ".", "-o", "all.jsonl", "-o", "all.json", cwd=tmp_path)
    for name in ("all.jsonl", "all.json"):
        assert satcheck("baseline", "write", f"{name}.b", name, cwd=tmp_path).code == 0
    written = (tmp_path / "all.jsonl.b").read_text()
    assert json.loads(written)["findings"]
    assert written == (tmp_path / "all.json.b").read_text()
    (tmp_path / "bad.jsonl").write_text("{}\n")
    ran = satcheck("baseline", "write", "bad.b", "bad.jsonl", cwd=tmp_path)
    assert (ran.code, (tmp_path / "bad.b").exists()) == (2, False)
    assert "error: bad.jsonl:1: no result of a batch" in ran.err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("r.json",), "No such command 'r.json'"),
        (("wirte", "b.json", "r.json"), "Did you mean 'write'?"),
        (("write", "r.json", "b.json"), "there is no b.json: the baseline comes before"),
        (("write", "r.json", "-o", "b.json"), "\n  satcheck baseline write b.json r.json\n"),
    ],
)
def test_a_slip_is_told_with_what_to_type(
    tmp_path: Path, words: tuple[str, ...], told: str
) -> None:
    (tmp_path / "r.json").write_text("{}")
    ran = satcheck("baseline", *words, cwd=tmp_path)
    assert (ran.code, told in ran.err) == (2, True)


@pytest.mark.parametrize("also", ["--clearance=1.5", "motion"])
def test_an_accepted_undecided_pair_does_not_hide_another_question(
    also: str, tmp_path: Path
) -> None:
    shell(tmp_path)
    satcheck("pot.toml", "-o", "report.json", cwd=tmp_path)
    satcheck("baseline", "write", "known.json", "report.json", "--undecided", cwd=tmp_path)
    gate = ["pot.toml", "--baseline", "known.json"]
    assert satcheck(*gate, cwd=tmp_path).code == 0
    if also == "motion":  # through the floor of the shell
        with (tmp_path / "pot.toml").open("a") as scene:
            scene.write('[[motion]]\nbodies = ["lid"]\ntranslation = [0, 0, -10]\n')
    else:  # the surfaces are 1 apart
        gate.append(also)
    assert satcheck(*gate, cwd=tmp_path).code == (1 if also == "motion" else 3)
