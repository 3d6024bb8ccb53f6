"""The page of gait parameters, and its figures."""

from __future__ import annotations

import pandas as pd
import pytest

import eigenwalker as ew
from eigenwalker.report.parameters_report import write_parameters_report
from eigenwalker.study.parameter_table import ParameterTable


@pytest.fixture(scope="module")
def table() -> ParameterTable:
    files = pd.DataFrame(
        {
            "file": ["a.c3d", "b.c3d", "c.c3d", "<d>.c3d"],
            "sex": ["f", "f", "m", "m"],
            "speed_mm_s": [1000.0, 1200.0, 1400.0, None],
            "stance_share_left": [60.0, 62.0, 64.0, None],
            "status": ["used", "used", "used", "refused"],
            "reason": ["", "", "", "no walk"],
        }
    )
    meanings = ["capture", "trait, as it was given", "speed", "stance", "used", "why"]
    book = pd.DataFrame({"column": list(files), "unit": "", "meaning": meanings})
    return ParameterTable(files, pd.DataFrame(), book)


def test_means_are_by_class_in_the_units_of_the_headings(table, tmp_path):
    more = pd.concat([table.files, table.files], ignore_index=True)
    page = write_parameters_report(
        ParameterTable(more, table.persons, table.codebook), tmp_path / "p.html"
    ).read_text(encoding="utf-8")
    for text in ("f (4)", "m (2)", "speed (m/s)", "1.10 (SD 0.12)", "64.0 (SD 0.0)", "no walk"):
        assert text in page
    assert "&lt;d&gt;.c3d" in page
    assert {path.name for path in tmp_path.iterdir()} == {"p.html", "p.svg", "p.pdf"}


def test_a_folder_without_any_walk_has_a_page_too(table, tmp_path):
    none = ParameterTable(table.files[3:], table.persons, table.codebook)
    page = write_parameters_report(none, tmp_path / "p.html").read_text(encoding="utf-8")
    assert "No capture could be measured." in page


def test_results_show_tables_in_notebooks():
    groups = pd.DataFrame({"positions_mm": [12.0]}, index=["forearm"])
    shares = pd.Series({"forearm": 0.5})
    walks = {"a": None, "b": None, "metric": None, "registration": None}
    comparison = ew.metric.Comparison(
        **walks, distance=0.0462, shares=shares, groups=groups, missing_groups=()
    )  # type: ignore[arg-type]
    metrics = pd.DataFrame({"distance": [0.0462]}, index=["positions-sigmoid"])
    result = ew.study.ReferenceComparison(comparison, (0.0, 0.0), metrics, 40)
    shown = result._repr_html_()
    assert shown.startswith(comparison._repr_html_())
    for text in ("Distance 0.0462", "forearm", "share", "positions-sigmoid"):
        assert text in shown
