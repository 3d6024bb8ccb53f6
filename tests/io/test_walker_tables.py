"""Tables of coefficients: what they mean, and that export takes back what import brought (A3)."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.io.walker_tables import (
    COS_FIRST,
    SIN_FIRST,
    on_the_floor,
    walker_from_mm,
    walker_from_table,
    walker_to_mm,
    walker_to_table,
)

TIME = np.linspace(0, 2, 50)


def _table(seed: int, n_markers: int = 15) -> np.ndarray:
    return np.random.default_rng(seed).normal(scale=300, size=(3 * n_markers, 5))


def test_columns_are_played_by_their_names():
    table = _table(0)
    walker = walker_from_table(table, frequency_hz=0.9, markers=JOINTS.markers)
    angle = 2 * np.pi * 0.9 * TIME[:, None]
    by_hand = (
        table[:, 0]
        + np.sin(angle) * table[:, 1]
        + np.cos(angle) * table[:, 2]
        + np.sin(2 * angle) * table[:, 3]
        + np.cos(2 * angle) * table[:, 4]
    )
    walk = walker.trajectories(TIME)
    assert walker.markers == JOINTS.markers
    assert walker.form == "fourier"
    for number, name in enumerate(JOINTS.markers):
        for axis, row in zip("xyz", (number, 15 + number, 30 + number), strict=True):
            np.testing.assert_allclose(walk.sel(marker=name, axis=axis), by_hand[:, row])


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 1000),
    columns=st.permutations(SIN_FIRST),
    layout=st.sampled_from(["planar", "interleaved"]),
    axes=st.sampled_from([*permutations(["forward", "right", "up"])]),
    markers=st.permutations(JOINTS.markers),
)
def test_export_takes_back_what_import_brought(seed, columns, layout, axes, markers):
    options = {"columns": columns, "layout": layout, "axes": axes, "markers": markers}
    table = _table(seed)
    walker = walker_from_table(table, frequency_hz=0.8, **options)
    np.testing.assert_allclose(walker_to_table(walker, **options), table, atol=1e-9)
    other = walker_to_table(walker, markers=markers)
    again = walker_from_table(other, frequency_hz=0.8, markers=markers)
    np.testing.assert_allclose(again.trajectories(TIME), walker.trajectories(TIME), atol=1e-9)


def test_sine_taken_for_cosine_is_no_shift_in_time():
    table = _table(1)
    right = walker_from_table(table, frequency_hz=1).trajectories(TIME[:25]).values
    for delay in np.linspace(0, 1, 41):
        swapped = walker_from_table(table, frequency_hz=1, columns=COS_FIRST)
        wrong = swapped.trajectories(TIME[:25] + delay).values
        assert np.abs(wrong - right).max() > 100


def test_eigenpostures_become_the_same_walk_as_a_table(orthogonal_walker):
    walker = orthogonal_walker(3)
    for columns in (SIN_FIRST, COS_FIRST, (*SIN_FIRST, "sin3", "cos3")):
        table = walker_to_table(walker, columns=columns)
        assert table.shape == (45, len(columns))
        again = walker_from_table(table, frequency_hz=walker.frequency_hz, columns=columns)
        np.testing.assert_allclose(again.trajectories(TIME), walker.trajectories(TIME), atol=1e-9)


def test_mm_matrices_tell_period_and_speed_and_cosines_first(orthogonal_walker):
    mm = np.vstack([_table(4), [120 / 0.95, 1, 11.3, 0, 0]])
    walker = walker_from_mm(mm)
    assert walker.frequency_hz == pytest.approx(0.95)
    assert walker.speed_mm_s == pytest.approx(11.3 * 120)
    left_knee_forward = mm[JOINTS.markers.index("left_knee")]
    found = walker.trajectories([0.0]).sel(marker="left_knee", axis="x").item()
    assert found == pytest.approx(left_knee_forward[0] + left_knee_forward[1] + mm[10, 3])
    np.testing.assert_allclose(walker_to_mm(walker), mm, atol=1e-9)
    np.testing.assert_allclose(walker_to_mm(orthogonal_walker(0))[-1], [150, 1, 0, 0, 0])


def test_mm_matrices_have_any_markers_and_harmonics():
    mm = np.random.default_rng(0).normal(size=(10, 7))
    mm[-1] = [60, 1, 0, 0, 0, 0, 0]
    walker = walker_from_mm(mm, markers=["a", "b", "c"], rate_hz=60)
    assert walker.frequency_hz == 1
    assert walker.harmonics.tolist() == [1, 1, 2, 2, 3, 3]
    np.testing.assert_allclose(walker_to_mm(walker, rate_hz=60), mm, atol=1e-9)


def test_a_walker_on_the_floor_has_its_origin_below_the_pelvis(orthogonal_walker):
    walker = on_the_floor(orthogonal_walker(0))
    np.testing.assert_allclose(walker.mean_posture.sel(marker="pelvis").values[:2], 0, atol=1e-6)
    assert np.isfinite(walker.speed_mm_s)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"markers": ["head"]}, r"3 rows .* got shape \(45, 5\)"),
        ({"columns": ("mean", "sin1", "cos1")}, "3 columns"),
        ({"columns": ("mean", "sin1", "sin1", "sin2", "cos2")}, "no Fourier series"),
        ({"columns": ("mean",)}, "no Fourier series"),
        ({"axes": ("x", "y", "z")}, "no three axes"),
        ({"axes": ("forward", "backward", "up")}, "no three axes"),
        ({"layout": "rows"}, "layout"),
        ({"frequency_hz": 0}, "frequency"),
    ],
)
def test_what_does_not_fit_is_told(options, told):
    with pytest.raises(ValueError, match=told):
        walker_from_table(_table(0), **{"frequency_hz": 1, **options})


def test_a_table_without_a_place_for_a_harmonic_is_refused(orthogonal_walker):
    with pytest.raises(ValueError, match=r"harmonics \[2\]"):
        walker_to_table(orthogonal_walker(0), columns=("mean", "sin1", "cos1"))
    with pytest.raises(ValueError, match=r"lacks the markers \['nose'\]"):
        walker_to_table(orthogonal_walker(0), markers=["nose"])
    for mm in (np.ones(5), np.ones((4, 4)), np.zeros((46, 5)), np.full((46, 5), np.nan)):
        with pytest.raises(ValueError, match=r"Expected|matrix must be"):
            walker_from_mm(mm)
