"""Traits tables as people have them: typed on other systems, by several people, in spreadsheets."""

from __future__ import annotations

import subprocess
import sys
import unicodedata
from pathlib import Path

import pandas as pd
import pytest

from eigenwalker.study.capture_table import capture_table


@pytest.fixture
def folder(tmp_path) -> Path:
    """Return a folder of captures by name only: the table looks at no content."""
    for name in (unicodedata.normalize("NFD", "M\u00fcller_1.c3d"), "sub/B.c3d", "c.c3d", "d.c3d"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    return tmp_path


@pytest.mark.parametrize("form", ["NFC", "NFD"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_names_are_found_however_they_are_typed(folder, form, end, encoding) -> None:
    rows = [
        "file;Who;",
        "M\u00fcller_1.c3d;M\u00fcller;",
        ";;",
        " sub\\b.c3d ;x;",
        "./c.c3d;  ;",
        ";;",
    ]
    content = unicodedata.normalize(form, end.join(rows) + end)
    (folder / "people.csv").write_bytes(content.encode(encoding))
    table = capture_table(folder, folder / "people.csv")
    assert list(table) == ["file", "Who"]
    assert [(folder / name).is_file() for name in table["file"]] == [True] * 3
    assert table["Who"].fillna("").tolist() == ["M\u00fcller", "x", ""]


def test_spellings_of_one_class_are_one_class(folder) -> None:
    files = [unicodedata.normalize("NFC", "M\u00fcller_1.c3d"), "sub/B.c3d", "c.c3d", "d.c3d"]
    table = pd.DataFrame(
        {
            "file": files,
            "sex": ["Female", "female ", "MALE", "Male"],
            "person": ["P1", "p1", "p2", ""],
        }
    )
    with pytest.warns(UserWarning, match="taken as one") as warned:
        found = capture_table(folder, table)
    assert found["sex"].tolist() == ["female", "female", "male", "male"]
    assert found["person"].tolist() == ["p1", "p1", "p2", ""]
    assert "sex: 'Female' (1), 'female' (1) are taken as one, 'female'." in [
        str(each.message) for each in warned
    ]


def test_numbers_stay_numbers_beside_blank_cells(folder) -> None:
    (folder / "people.csv").write_text("file,weight_kg\nc.c3d, 80 \n,\nd.c3d,  \n")
    weights = capture_table(folder, folder / "people.csv")["weight_kg"]
    assert weights.iloc[0] == 80
    assert weights.isna().tolist() == [False, True]


def test_names_that_differ_in_case_only_are_not_guessed(folder) -> None:
    (folder / "C.c3d").touch()
    if len(list(folder.glob("*.c3d"))) == 3:
        pytest.skip("this file system has one name for both")
    with pytest.warns(UserWarning, match=r"C.C3D .* is not in the folder; did you mean C.c3d"):
        table = capture_table(folder, pd.DataFrame({"file": ["C.C3D"]}))
    assert table["file"].tolist() == ["C.C3D"]
    with pytest.raises(ValueError, match=r"\['c.c3d'\] more than once"):
        capture_table(folder, pd.DataFrame({"file": ["c.c3d", "./c.c3d"]}))


def test_only_captures_that_no_line_names_are_what_was_meant(folder) -> None:
    for number in (4, 14):
        (folder / f"walk_{number:04d}.c3d").touch()
    table = pd.DataFrame({"file": ["walk_004.c3d", "walk_0014.c3d"]})
    with pytest.warns(UserWarning, match=r"walk_004.c3d .* did you mean walk_0004.c3d"):
        capture_table(folder, table)


@pytest.mark.parametrize("head", ["Datei", "File name", "Trial"])
@pytest.mark.parametrize("name", ["c", "C.C3D", "S:\\\\x\\\\c.c3d", "/data/c.c3d"])
def test_captures_are_found_without_suffix_and_folder(folder, head, name) -> None:
    (folder / "people.csv").write_text(f"{head};sex\n{name};f\n")
    with pytest.warns(UserWarning, match=f"'{head}' is taken to name the files"):
        assert capture_table(folder, folder / "people.csv")["file"].tolist() == ["c.c3d"]


def test_a_table_without_headings_is_refused(folder) -> None:
    (folder / "people.csv").write_text("c.c3d,f\nd.c3d,m\n")
    with pytest.raises(ValueError, match=r"first line .* names a capture; put headings"):
        capture_table(folder, folder / "people.csv")


def test_a_pattern_of_composed_letters_fits_decomposed_names(folder) -> None:
    table = capture_table(folder, trait_from_name="(?P<who>M\u00fcller)_")
    assert table["who"].dropna().tolist() == ["M\u00fcller"]


def test_hidden_files_are_no_captures_of_a_folder(folder) -> None:
    for name in ("._c.c3d", ".part.c3d", ".trash/e.c3d"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).touch()
    names = [unicodedata.normalize("NFC", name) for name in capture_table(folder)["file"]]
    assert names == ["M\u00fcller_1.c3d", "c.c3d", "d.c3d", "sub/B.c3d"]


def test_infinite_traits_are_refused_before_a_capture_is_read(folder) -> None:
    (folder / "people.csv").write_text("file,weight_kg\nc.c3d,80\nd.c3d,inf\n")
    with pytest.raises(ValueError, match="trait 'weight_kg' of row 2 is inf"):
        capture_table(folder, folder / "people.csv")
    (folder / "c.c3d").rename(folder / "c-1e999.c3d")
    with pytest.raises(ValueError, match="is inf"):
        capture_table(folder, trait_from_name="-(?P<weight_kg>.*).c3d")


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are Unicode")
def test_names_are_found_where_the_system_speaks_ascii(tmp_path):
    (tmp_path / "Müller_1.c3d").write_bytes(b"")
    (tmp_path / "t.csv").write_text("file,sex\nMüller_1.c3d,m\n", encoding="utf-8")
    code = (
        "import os; from eigenwalker.study.capture_table import capture_table as table; "
        "print(os.path.exists(table('.', 't.csv', None)['file'][0]))"
    )
    ascii_system = {"PATH": "", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=ascii_system, capture_output=True, text=True
    )
    assert done.stdout == "True\n", done.stderr


def test_units_of_cells_are_kept_for_the_codebook(folder) -> None:
    listed = folder / "people.csv"
    listed.write_text("file,age\nc,42 years\nd,43 years\n")
    with pytest.warns(UserWarning, match="'years', as in cell B2"):
        assert capture_table(folder, listed).attrs["units"] == {"age": "years"}
