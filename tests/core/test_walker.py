"""What no walker can be made of is refused."""

from __future__ import annotations

import pytest

from eigenwalker.core.walker import Walker


@pytest.mark.parametrize(
    ("harmonic", "said"),
    [
        (1.7, "whole numbers; got 1.7"),
        (1e40, "whole numbers"),
        (0, "1 or more"),
        (float("nan"), "NaN"),
    ],
)
def test_harmonics_are_whole_numbers_from_1(harmonic, said):
    with pytest.raises(ValueError, match=said):
        Walker(["foot"], [[0, 0, 50]], [[[200, 0, 0]]], [harmonic], [0], 1.0)


def test_a_walker_keeps_numbers_of_its_own():
    assert Walker(["foot"], [[0, 0, 50]], [[[2.0, 0, 0]]], [1.0], [0], 1).harmonics.dtype == int
