from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.io.capture_file import CaptureFile, is_text
from eigenwalker.io.errors import UnreadableFile, printable
from eigenwalker.io.file_types import file_type_of, with_article
from eigenwalker.io.text_cells import cells, number, points_of, separator_of
from eigenwalker.io.timestamps import on_even_clock, parse_rate
from eigenwalker.io.to_trajectories import unit_named, without_subject

FILE = CaptureFile(Path("a.csv"), b"")


def test_cells_are_what_separators_and_quotation_marks_enclose():
    assert separator_of("Frame;X 1;Y 1") == ";"
    assert separator_of("1.0  2.0") is None
    assert cells('1, "Hip, left" ,2', ",") == ["1", "Hip, left", "2"]


def test_words_are_finite_numbers_or_refused():
    assert number("-1.5e2", "frame 3", FILE) == -150
    assert parse_rate("100,00", "DataRate", FILE) == 100
    with pytest.raises(UnreadableFile, match=r"'1,5'; write numbers with a decimal point"):
        number("1,5", "frame 3", FILE)
    with pytest.raises(UnreadableFile, match=r"as DataRate, but got '0'; .*rate_hz="):
        parse_rate("0", "DataRate", FILE)


def test_points_have_three_columns_each():
    points = points_of(["time", "Foot Left X", "Y", "Z", "nose_x", "nose_y", "nose_z", "max"])
    assert points == (["Foot Left", "nose"], [(1, 2, 3), (4, 5, 6)], [0, 7])


def test_a_frame_that_was_left_out_is_missing():
    walk = np.arange(4.0)[:, None, None] * np.ones(3)
    even = on_even_clock(FILE, walk, np.array([0, 0.1, 0.2, 0.4]))
    assert even.rate_hz == pytest.approx(10)
    np.testing.assert_array_equal(even.positions[:, 0, 0], [0, 1, 2, np.nan, 3])


def test_units_go_by_many_names():
    unit = unit_named("Millimeters")
    assert unit is not None
    assert (unit.name, unit_named("deg")) == ("mm", None)


def test_the_one_subject_before_all_names_is_taken_off():
    assert without_subject(["Anna:LKNE", "Anna:RKNE"]) == (["LKNE", "RKNE"], "Anna")
    assert without_subject(["Anna:LKNE", "Ben:LKNE"]) == (["Anna:LKNE", "Ben:LKNE"], "")


def test_types_of_files_are_known_by_their_first_bytes():
    assert is_text(b"time,nose_x")
    assert not is_text(bytes(16))
    assert file_type_of(b"%PDF-1.7") == "a PDF document"
    assert file_type_of(b"Dear colleague") == 'a text that begins with "Dear colleague"'
    assert file_type_of(bytes(range(256))) == "a file of no kind that is known here"
    assert (with_article("ASF/AMC"), with_article("BVH")) == ("an ASF/AMC", "a BVH")


def test_messages_do_not_control_a_terminal():
    assert printable("left\x1b[2Jknee\n") == "left\N{REPLACEMENT CHARACTER}[2Jknee "
