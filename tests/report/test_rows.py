"""A report as a pandas.DataFrame, and its findings as dictionaries."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.report.report import Finding
from satcheck.report.rows import COLUMNS, row_of
from tests.cli.process import SAMPLES
from tests.cli.reports import PENETRATING, SEPARATED, UNDECIDED, report

MIXED = report(SEPARATED, PENETRATING, UNDECIDED)


def test_a_row_has_all_columns_in_order():
    assert [list(row_of(finding, MIXED)) for finding in MIXED.findings] == [list(COLUMNS)] * 3


def test_a_data_frame_has_numbers_and_no_none():
    pytest.importorskip("pandas")
    frame = MIXED.to_dataframe()
    assert list(frame.columns) == list(COLUMNS)
    assert frame["relation"].tolist() == [finding.relation for finding in MIXED.findings]
    assert frame["depth"].dtype == "float64"
    assert frame["depth"].isna().tolist() == [True, False, True]
    assert frame["depth"].max() == PENETRATING.depth
    assert frame["mtv_x"][1] == PENETRATING.mtv[0]
    assert frame["fails"].tolist() == [False, True, False]
    assert frame["mtv_verified"].sum() == 1


def test_a_table_of_dictionaries_says_the_same_in_other_columns():
    pandas = pytest.importorskip("pandas")
    frame = MIXED.to_dataframe()
    table = pandas.json_normalize([finding.to_dict() for finding in MIXED.findings])
    for name in ("a", "b", "relation", "depth", "id"):
        pandas.testing.assert_series_equal(frame[name], table[name], check_dtype=False)
    assert table["mtv"][1] == frame.loc[1, ["mtv_x", "mtv_y", "mtv_z"]].tolist()


def test_a_column_without_a_value_is_numeric_too():
    pytest.importorskip("pandas")
    for findings in ((), (SEPARATED,)):
        frame = report(*findings).to_dataframe()
        assert (len(frame), frame["depth"].dtype, frame["volume"].dtype) == (
            len(findings), "float64", "float64"
        )  # fmt: skip


def test_without_pandas_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(SatcheckError, match="pip install pandas") as raised:
        MIXED.to_dataframe()
    assert raised.value.code == "missing-extra"


def test_a_finding_is_the_dictionary_of_its_report():
    whole = report(PENETRATING)
    values = whole.findings[0].to_dict()
    assert values == whole.to_dict()["findings"][0]
    assert json.loads(json.dumps(values)) == values
    assert list(values) == list(Finding.__struct_fields__)
    assert "microseconds" not in json.dumps(PENETRATING.to_dict(timings=False))


def test_a_check_does_not_import_pandas():
    code = (
        "import sys, satcheck\n"
        "report = satcheck.check(['box.obj', 'box_pushed.stl'])\n"
        "report.findings[0].to_dict()\n"
        "sys.exit('pandas' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], cwd=SAMPLES, check=False).returncode == 0
