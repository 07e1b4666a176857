"""`satcheck verify` as a whole process: exit codes, and what it says."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from tests.cli.process import PUSHED, SAMPLES, VALIDATOR, private_cache, satcheck

NOT_COVERED = (
    "Taken as stated: settings, the list of bodies.\n"
    "Not covered: the version of satcheck, which flags and rules required an effect, "
    "on how many pairs an effect ran, times, messages, plans.\n"
)


def report(folder: Path, *arguments: str) -> Path:
    path = folder / "report.json"
    ran = satcheck("--certificate", "-o", str(path), *arguments, env=private_cache(folder))
    assert ran.code in (0, 1), ran.err
    return path


def test_an_honest_report_is_accepted(tmp_path: Path) -> None:
    path = report(tmp_path, *PUSHED)
    VALIDATOR.validate(json.loads(path.read_text("utf-8")))
    ran = satcheck("verify", str(path))
    assert (ran.code, ran.err) == (0, "")
    assert (
        ran.out
        == f"1 verdict accepted. Also proven: 1 depth, 1 thickness, 1 way out.\n{NOT_COVERED}"
    )


def test_paths_start_at_the_root(tmp_path: Path) -> None:
    path = report(tmp_path, *PUSHED)
    elsewhere = satcheck("verify", str(path), cwd=tmp_path)
    assert elsewhere.code == 2
    assert elsewhere.err == (
        f"satcheck: 2 files are missing below {tmp_path}: box.obj, box_pushed.stl; "
        "--root names the folder where the check ran\n"
    )
    assert (
        elsewhere.out == f"0 verdicts accepted, 1 not checked, as files are missing.\n{NOT_COVERED}"
    )
    assert satcheck("verify", "--root", str(SAMPLES), str(path), cwd=tmp_path).code == 0


def test_what_is_missing_is_never_accepted_and_hides_no_rejection(tmp_path: Path) -> None:
    for name in (*PUSHED, "cube.off"):
        shutil.copy(SAMPLES / name, tmp_path)
    files = [str(tmp_path / name) for name in (*PUSHED, "cube.off")]
    path = report(tmp_path, *files)
    (tmp_path / "cube.off").unlink()
    ran = satcheck("verify", "--format", "json", str(path))
    assert ran.code == 2
    assert ran.document["accepted"] is False
    assert ran.document["missing"] == [files[2]]
    outcomes = [one["outcome"] for one in ran.document["findings"]]
    assert outcomes[0] == "accepted"
    assert set(outcomes[1:]) <= {"no file"}
    honest = path.read_text("utf-8")
    forged = json.loads(honest)
    forged["findings"][0].update(relation="separated", exact_relation="separated")
    path.write_text(json.dumps(forged), "utf-8")
    assert satcheck("verify", str(path)).code == 1
    unlisted = json.loads(honest)  # only the pair with the missing file is gone from the list
    unlisted["findings"] = unlisted["findings"][:1]
    path.write_text(json.dumps(unlisted), "utf-8")
    assert satcheck("verify", str(path)).code == 2
    path.write_text(honest, "utf-8")
    with (tmp_path / "box.obj").open("a") as file:
        file.write("# changed\n")
    ran = satcheck("verify", str(path))
    assert ran.code == 1
    assert "has changed: its SHA-256 is another" in ran.out


def test_a_forged_verdict_is_rejected(tmp_path: Path) -> None:
    path = report(tmp_path, *PUSHED)
    document = json.loads(path.read_text("utf-8"))
    document["findings"][0].update(relation="separated", exact_relation="separated")
    path.write_text(json.dumps(document), "utf-8")
    ran = satcheck("verify", str(path))
    assert ran.code == 1
    assert ran.out.startswith("rejected: box and box_pushed, separated: ")
    found = satcheck("verify", "--format", "json", str(path)).document
    assert found["accepted"] is False
    assert found["findings"][0]["outcome"] == "rejected"


def test_a_report_without_certificates_is_no_pass(tmp_path: Path) -> None:
    path = tmp_path / "plain.json"
    satcheck("-o", str(path), *PUSHED)
    ran = satcheck("verify", str(path))
    assert ran.code == 2
    assert "made with --certificate?" in ran.err


def test_a_key_that_stands_twice_makes_it_no_report(tmp_path: Path) -> None:
    path = report(tmp_path, *PUSHED)
    text = path.read_text("utf-8")
    path.write_text(text.replace('"units": null', '"units": null,"units": null'), "utf-8")
    ran = satcheck("verify", str(path))
    assert (ran.code, ran.out) == (2, "")
    assert "the key 'units' stands twice in one object [bad-report]" in ran.err


def test_what_nobody_checked_is_listed(tmp_path: Path) -> None:
    path = report(tmp_path, "l_bracket.obj", "box.obj")
    found = satcheck("verify", "--format", "json", str(path)).document
    listed = {one["field"]: one for one in found["not_covered"]}
    assert listed["settings"]["kind"] == "stated"
    assert listed["findings[].plan"]["kind"] == "not covered"


def test_certificates_need_a_report_that_holds_them() -> None:
    ran = satcheck("--certificate", *PUSHED)
    assert (ran.code, ran.out) == (2, "")
    assert "--format json" in ran.err


def test_what_is_no_report_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    for text in ("", "{", "[" * 100_000, '{"schema": NaN}', "9" * 10_000, "{}"):
        path.write_text(text, "utf-8")
        ran = satcheck("verify", str(path))
        assert (ran.code, ran.out) == (2, ""), text[:10]
        assert "[bad-report]" in ran.err
    assert satcheck("verify", str(tmp_path / "none.json")).code == 2


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in this file system")
def test_what_has_no_end_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.json")
    ran = satcheck("verify", str(tmp_path / "pipe.json"))
    assert (ran.code, ran.out) == (2, "")
    assert "is a pipe, not a file [not-a-file]" in ran.err


def test_a_report_without_certificates_gets_one_line(tmp_path: Path) -> None:
    path = tmp_path / "report.json"
    satcheck("-o", str(path), *PUSHED, "cube.off")
    ran = satcheck("verify", str(path))
    told = f"satcheck: {path}: no certificates: was it made with --certificate?\n"
    assert (ran.code, ran.out, ran.err) == (2, "", told)


def test_a_report_of_each_is_refused_with_the_command_that_has_certificates(tmp_path: Path) -> None:
    path = tmp_path / "report.json"
    satcheck("batch", "-o", str(path), *PUSHED)
    ran = satcheck("verify", str(path))
    assert (ran.code, ran.out) == (2, "")
    assert "the reports of several assets, and certificates need the check of one" in ran.err
