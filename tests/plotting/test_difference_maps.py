"""Figures of differences: what they show is what they were given."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, strategies as st
from matplotlib.colors import to_rgb

from eigenwalker.metric import loop, motion_map, register_walks
from eigenwalker.plotting.difference_maps import (
    MapPicture,
    figure_maps,
    figure_two_walks,
    picture_of_strides,
)
from eigenwalker.plotting.difference_tables import (
    MAX_CLASSES,
    figure_difference_table,
    figure_map_of_walks,
    short_names,
)
from eigenwalker.plotting.fitted_weights import figure_predictions, figure_shares, figure_weights
from eigenwalker.plotting.style import PURPLE, TEAL
from eigenwalker.simulation.walk import simulate_walk

AWKWARD = "<b>$x_{1$ & \\frac.c3d"


@pytest.fixture(scope="module")
def walk():
    return simulate_walk(seed=1, frequency_hz=1.0, duration_s=4.0, rate_hz=50)


def test_the_map_of_a_walk_is_dark_along_its_period(walk):
    cells, looped = motion_map(walk), loop(walk)
    line = np.array([[0.5, 0.5 + looped.period_s], [1.5, 1.5 + looped.period_s]])
    times = cells.time_a.values
    picture = MapPicture(cells.values, times, times, "itself", "mm", path=line)
    axes = figure_maps([picture]).axes[0]
    shown = np.asarray(axes.images[0].get_array())
    np.testing.assert_array_equal(shown, cells.values)
    rows, columns = np.searchsorted(times, [0.5, 0.5 + looped.period_s])
    assert shown[rows, columns] < 0.1 * shown.mean()
    assert to_rgb(axes.lines[0].get_color()) == to_rgb(PURPLE)
    np.testing.assert_allclose(axes.lines[0].get_xydata(), line[:, ::-1])


def test_the_path_of_two_strides_runs_on_through_the_repeated_map(walk):
    registered = register_walks(walk, simulate_walk(seed=2, duration_s=4.0, rate_hz=50))
    a, b = (registered.map[clock].values for clock in ("time_a", "time_b"))
    picture = picture_of_strides(registered.map.values, a, b, registered.times, "both")
    assert picture.path is not None
    assert (picture.path.min(axis=0) >= 0).all()
    assert (picture.path.max(axis=0) <= [picture.times_a[-1], picture.times_b[-1]]).all()
    assert (np.diff(picture.path, axis=0) >= 0).all()
    rows = np.abs(picture.times_a[:, None] - picture.path[:, 0]).argmin(axis=0)
    columns = np.abs(picture.times_b[:, None] - picture.path[:, 1]).argmin(axis=0)
    along = picture.values[rows, columns]
    assert along.mean() == pytest.approx(registered.cost, rel=0.02)
    axes = figure_maps([picture]).axes[0]
    assert to_rgb(axes.patches[0].get_edgecolor()[:3]) == to_rgb(TEAL)


def test_two_walks_lie_over_each_other_in_their_colours(walk):
    markers = [str(name) for name in walk.marker.values]
    figure = figure_two_walks(walk.values, walk.values + 5, markers, names=("a", AWKWARD))
    inks = {to_rgb(text.get_color()) for text in figure.axes[0].texts if text.get_text() in "a"}
    assert inks == {to_rgb(TEAL)}
    figure.savefig(io.BytesIO(), format="svg")


def test_shares_stand_from_the_largest_to_the_least():
    axes = figure_shares({"calf": 0.1, "forearm": 0.7, "toe": 0.2}).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["forearm", "toe", "calf"]


def test_the_table_is_drawn_in_order_with_a_line_between_clusters():
    table = np.array([[0, 5, 1], [5, 0, 6], [1, 6, 0.0]])
    figure = figure_difference_table(table, ["a", "b", "c"], order=[0, 2, 1], clusters=[0, 1, 0])
    axes = figure.axes[0]
    np.testing.assert_array_equal(axes.images[0].get_array(), table[[0, 2, 1]][:, [0, 2, 1]])
    assert [line.get_ydata()[0] for line in axes.lines[::2]] == [1.5]


def test_names_of_any_letters_are_words():
    names = [AWKWARD, "b" * 200]
    for figure in (
        figure_difference_table([[0, 1], [1, 0]], names, order=[0, 1]),
        figure_map_of_walks([[0, 0], [1, 1]], names, names=names),
        figure_maps([MapPicture(np.eye(3), *[np.arange(3.0)] * 2, AWKWARD, names=(*names,))]),
    ):
        figure.savefig(io.BytesIO(), format="svg")
    assert all(len(name) <= 15 for name in short_names(names))


@given(st.lists(st.text("ab_-. ", min_size=1, max_size=60), min_size=2, max_size=6, unique=True))
def test_short_names_tell_apart_what_names_do(names):
    short = short_names(names)
    assert len(set(short)) == len(names)
    assert all(0 < len(name) <= 30 for name in short)


def test_many_classes_all_look_different():
    classes = [f"class {number:02}" for number in range(MAX_CLASSES)]
    axes = figure_map_of_walks(np.arange(2 * MAX_CLASSES).reshape(-1, 2), classes).axes[0]
    looks = {
        (tuple(drawn.get_facecolor()[0]), drawn.get_paths()[0].vertices.tobytes())
        for drawn in axes.collections
    }
    assert len(looks) == MAX_CLASSES


def test_weights_and_predictions_are_those_given():
    fits = {
        "choices": ([0.7, 0.3], [0.5, 0.0], [0.8, 0.5]),
        "differences": ([0.6, 0.4], [0.4, 0.2], [0.9, 0.6]),
    }
    axes = figure_weights(["a", "b"], fits).axes[0]
    for drawn, (weights, _, _) in zip(axes.lines, fits.values(), strict=False):
        np.testing.assert_allclose(drawn.get_xdata(), weights)
    points = figure_predictions([0.5, 0.9], [0.6, 0.8]).axes[0].lines[1]
    np.testing.assert_allclose(points.get_xydata(), [[0.5, 0.6], [0.9, 0.8]])
