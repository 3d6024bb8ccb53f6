"""Cells of traits as people write them become numbers, classes and unknowns, and it is said."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from eigenwalker.study.trait_cells import trait_values


def _values(*cells: str, decimal_comma: bool = False) -> tuple[list, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = trait_values(cells, "x", lambda at: f"cell B{at + 2}", decimal_comma=decimal_comma)
    return found.tolist(), [str(each.message) for each in caught]


@pytest.mark.parametrize(
    ("cells", "expected", "said"),
    [
        (("60.5", "61", "1e2"), (60.5, 61, 100), ()),
        (("60,5", "61", "1.062,5"), (60.5, 61, 1062.5), ()),
        (("1,234.5", "61"), (1234.5, 61), ()),
        (("1'234.5", "1\u2019061"), (1234.5, 1061), ()),
        (("42 years", "43 years", "44"), (42, 43, 44), ("'years'", "cell B2 ('42 years')")),
        (("175 cm", "1.80 m", "1700mm"), (175, 180, 170), ("'1.80 m' in cell B3 is taken as 180",)),
        (("60.5", "61,5", "62"), (60.5, 61.5, 62), ("'61,5' in cell B3 is taken as 61.5",)),
        (("23", "-999", "n/a", "-", "", "31"), (23, np.nan, np.nan, np.nan, np.nan, 31),
         ("'n/a' (1), '-' (1)", "'-999' (1)")),
        (("23", "999", "31"), (23, np.nan, 31), ("'999' (1)",)),
        (("61", "about 80", "62", "63"), (61, np.nan, 62, 63), ("'about 80' in cell B3",)),
        (("-3", "-99", "2"), (-3, -99, 2), ()),
    ],
)  # fmt: skip
def test_numbers_are_read_as_people_write_them(cells, expected, said):
    values, warned = _values(*cells)
    np.testing.assert_allclose(values, expected)
    for part in said:
        assert any(part in each for each in warned), warned
    assert bool(said) == bool(warned)


def test_three_digits_behind_a_comma_are_decimals_only_where_it_is_known():
    with pytest.raises(ValueError, match=r"'1,705' in cell B2, which may be 1705 or 1\.705"):
        _values("1,705", "1,715")
    assert _values("1,705", "1,715", decimal_comma=True) == ([1.705, 1.715], [])
    assert _values("1,705", "1,7")[0] == [1.705, 1.7]


def test_numbers_of_two_kinds_of_unit_are_refused():
    with pytest.raises(ValueError, match=r"'kg', but has '150 lbs' in cell B3"):
        _values("60 kg", "150 lbs")


def test_words_for_the_sexes_are_two_classes():
    values, warned = _values("f", "F", "female", "woman", "w", "m", "Man", "unknown")
    assert values == ["female"] * 5 + ["male"] * 2 + [None]
    assert any("'F' (1), 'f' (1), 'female' (1), 'w' (1), 'woman' (1)" in each for each in warned)
    assert _values("f", "m", "f") == (["f", "m", "f"], [])
    assert _values("w", "b", "W")[0] == ["w", "b", "w"]


def test_feet_and_inches_are_centimetres():
    values, warned = _values("175", "5'9\"", "6 ft", "1.7 m", "171 cm", "172 cm", "173")
    np.testing.assert_allclose(values, [175, 175.26, 182.88, 170, 171, 172, 173])
    assert "in cell B3 as 175.26 cm" in warned[0]
    assert "cell B6 ('171 cm')" in warned[1] or "numbers of 'cm'" in warned[1]


@pytest.mark.parametrize("date", ["2024-03-05", "05.03.2024", "3/5/24", "5. Mrz", "Mar-05", "8:30"])
def test_dates_are_no_numbers_and_no_silent_classes(date):
    values, warned = _values(date, "", date)
    assert values == [date, None, date]
    assert f"dates or times, such as {date!r} in cell B2" in warned[0]
    with pytest.raises(ValueError, match=r"has numbers, but 1 dates .* in cell B4"):
        _values("5.2", "5.4", date)
    assert _values("a", "b", date)[0] == ["a", "b", date]


def test_numbers_of_two_sizes_are_two_units():
    for cells in (("1.75", "1750", "1.68"), ("175", "168", "1.8"), ("60.5", "61", "62500")):
        with pytest.raises(ValueError, match=r"numbers of two units, .* in cell B\d and"):
            trait_values(cells, "Height (cm)", lambda at: f"cell B{at + 2}", decimal_comma=False)
    values, warned = _values("1.5", "1.6", "15", "16")  # may be doses
    assert values == [1.5, 1.6, 15, 16]
    assert "about 10 times as large" in warned[0]
    assert _values("1", "10", "100", "1")[1] == _values("150", "210", "165")[1] == []


def test_words_for_yes_and_no_are_two_classes():
    assert _values("yes", "Y", "n", "No")[0] == ["yes", "yes", "no", "no"]
