"""Trajectories as people have them: other kinds of numbers, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eigenwalker.core.trajectories import check_trajectories, label_trajectories

WALK = label_trajectories(np.arange(24.0).reshape(4, 2, 3), markers=["head", "foot"], rate_hz=10)


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.longdouble, int, object])
def test_numbers_of_any_kind_become_float64(kind):
    found = check_trajectories(WALK.astype(kind))
    assert found.dtype == np.float64
    np.testing.assert_array_equal(found, WALK)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ("walk.c3d", "got the text 'walk.c3d'; make them with read_mocap"),
        (Path("walk.c3d"), "read_mocap"),
        ([1, 2], "got a list of 2; make them with label_trajectories"),
        (WALK + 1j, "real numbers; got an array of complex128"),
        (WALK * np.inf, "infinite"),
        (WALK * 1e150, "A position of 2.3e\\+151 mm"),
        (WALK.assign_coords(marker=["foot", "foot"]), "more than once: \\['foot'\\]"),
        (WALK[:0], "Expected frames and markers"),
    ],
)
def test_what_is_no_trajectories_is_named(wrong, words):
    with pytest.raises((TypeError, ValueError), match=words):
        check_trajectories(wrong)
