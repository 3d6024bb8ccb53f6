"""Traits tables are read as spreadsheets save them."""

from __future__ import annotations

import warnings
import zipfile
from pathlib import Path

import openpyxl
import pytest

from eigenwalker.study.traits_file import read_traits_file

ROWS = [["file", "sex", "gewicht"], ["Mü_1.c3d", "f", "60,5"], ["b.c3d", "m", "71"]]


def _text(separator: str, *, quote: str = "", end: str = "\r\n") -> str:
    return end.join(separator.join(f"{quote}{cell}{quote}" for cell in row) for row in ROWS) + end


@pytest.mark.parametrize(
    "content",
    [
        _text(";").encode("cp1252"),
        _text("\t").encode("utf-16"),
        _text(";").encode("utf-8-sig"),
        ("sep=;\r\n" + _text(";")).encode(),
        _text(",", quote='"').encode(),
        _text(";").replace("\r\n", "\r\n;;\r\n").encode(),
        b'"","file","sex","gewicht"\n"1","M\xc3\xbc_1.c3d","f","60,5"\n"2","b.c3d","m",71\n',
        b'"file" "sex" "gewicht"\n"1" "M\xc3\xbc_1.c3d" "f" "60,5"\n"2" "b.c3d" "m" 71\n',
    ],
)
def test_text_tables_of_many_programs_hold_the_same(tmp_path, content):
    (tmp_path / "t.csv").write_bytes(content)
    table = read_traits_file(tmp_path / "t.csv")
    assert [list(table), *table.to_numpy().tolist()] == ROWS


def _workbook(path: Path, rows) -> Path:
    book = openpyxl.Workbook()
    sheet = book.create_sheet("people")
    for row in rows:
        sheet.append(row)
    book.save(path)
    return path


def test_a_workbook_is_read_from_its_first_sheet_that_has_cells(tmp_path):
    rows = [["file", "age", None], ["a.c3d", 23, None], [None], ["b.c3d", 24.5, None]]
    table = read_traits_file(_workbook(tmp_path / "t.xlsx", rows))
    assert table.to_numpy().tolist() == [["a.c3d", "23"], ["b.c3d", "24.5"]]
    assert table.attrs["line"] == [2, 4]


def test_what_is_no_table_is_refused_with_the_way_out(tmp_path):
    bomb = tmp_path / "bomb.xlsx"
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/workbook.xml", "")
        archive.writestr("xl/a.xml", bytes(60_000_000))
    (tmp_path / "a.ods").write_bytes(b"PK\3\4")
    (tmp_path / "b.xlsx").write_bytes(b"PK\3\4 junk")
    for name, why in (("bomb.xlsx", "unpacks"), ("a.ods", "LibreOffice"), ("b.xlsx", "zip")):
        with pytest.raises(ValueError, match=f"{why}.*Save it as CSV in UTF-8 or as XLSX"):
            read_traits_file(tmp_path / name)


def test_headings_that_repeat_or_lack_are_refused(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("file,sex,sex\na,f,m\n")
    with pytest.raises(ValueError, match=r"\['sex'\] more than once \(columns B, C\)"):
        read_traits_file(path)
    path.write_text("file,sex,\na,f,m\n")
    with pytest.raises(ValueError, match=r"Column C .* no heading"):
        read_traits_file(path)


def test_the_sheet_of_files_is_read_below_a_title_and_formulas_without_values_are_said(tmp_path):
    book = openpyxl.Workbook()
    book.active.append(["A study"])
    sheet = book.create_sheet("people")
    for row in (["Study 12"], [], ["File name", "sex", "bmi"], ["a", "f", "=20+1"], ["b", "m", 3]):
        sheet.append(row)
    book.save(tmp_path / "t.xlsx")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        table = read_traits_file(tmp_path / "t.xlsx")
    assert table.to_numpy().tolist() == [["a", "f", ""], ["b", "m", "3"]]
    assert table.attrs["line"] == [4, 5]
    words = " ".join(str(each.message) for each in said)
    assert "sheet 'people'" in words
    assert "stand in line 3" in words
    assert "1 cells of the traits table, first C4, hold formulas" in words


def test_a_workbook_is_read_as_it_is_seen(tmp_path):
    book = openpyxl.Workbook()
    book.active.title, book.active.sheet_state = "old", "hidden"
    for row in (["file", "sex"], ["x", "f"]):
        book.active.append(row)
    sheet = book.create_sheet("now")
    rows = [["file", "group", "Score\n(right)"], [None, None, "percent"], ["a", "ill", 0.25]]
    for row in [*rows, ["b", None, 0.5]]:
        sheet.append(row)
    sheet.merge_cells("B3:B4")
    sheet.column_dimensions["C"].hidden = True
    for row in (3, 4):
        sheet.cell(row, 3).number_format = "0%"
    book.active = 1
    book.save(tmp_path / "t.xlsx")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        table = read_traits_file(tmp_path / "t.xlsx")
    assert list(table) == ["file", "group", "Score (right)"]
    assert table.to_numpy().tolist() == [["a", "ill", "25%"], ["b", "ill", "50%"]]
    words = " ".join(str(each.message) for each in said)
    for part in ("sheet 'now'", "column C", "B3:B4 ('ill')", "units: {'Score (right)': 'percent'}"):
        assert part in words


def test_of_headings_in_two_lines_the_lower_one_counts(tmp_path):
    book = openpyxl.Workbook()
    for row in (["file", "body", None], [None, "height", "weight"], ["a", 175, 70]):
        book.active.append(row)
    book.active.merge_cells("A1:A2")
    book.save(tmp_path / "t.xlsx")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        table = read_traits_file(tmp_path / "t.xlsx")
    assert table.to_dict("records") == [{"file": "a", "height": "175", "weight": "70"}]
