"""`satcheck verify` as a whole process: exit codes, and what it says."""

from __future__ import annotations

import json
from pathlib import Path

from tests.cli.process import PUSHED, SAMPLES, VALIDATOR, private_cache, satcheck


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
    assert ran.out == "1 verdict accepted. Proven besides: 1 depth, 1 way out.\n"


def test_paths_start_at_the_root(tmp_path: Path) -> None:
    path = report(tmp_path, *PUSHED)
    elsewhere = satcheck("verify", str(path), cwd=tmp_path)
    assert elsewhere.code == 1
    assert f"no such file, looked for from {tmp_path} on (--root)" in elsewhere.out
    assert satcheck("verify", "--root", str(SAMPLES), str(path), cwd=tmp_path).code == 0


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
