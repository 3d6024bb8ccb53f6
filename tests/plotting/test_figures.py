"""Figures: what is drawn is what was given."""

from __future__ import annotations

import sys
from dataclasses import replace
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.patches import Circle

from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.decomposition import decompose_pca
from eigenwalker.plotting.components import figure_scores, figure_variance, scores_of
from eigenwalker.plotting.curves import figure_curves, figure_regression_curves
from eigenwalker.plotting.eigenpostures import figure_eigenpostures
from eigenwalker.plotting.style import PURPLE, TEAL
from eigenwalker.plotting.walker_space_figure import figure_space
from eigenwalker.plotting.walkers import figure_joints, figure_walkers, view_name


@pytest.fixture(scope="module")
def walk():
    """Four orthogonal postures on sines, a little noise, eight strides at 120 Hz."""
    rng = np.random.default_rng(4)
    postures = np.linalg.qr(rng.normal(size=(45, 4)))[0].T * [[300.0], [120], [60], [40]]
    time = np.arange(960) / 120
    cycle = 2 * np.pi * time[:, None]
    scores = np.sin(np.array([1, 1, 2, 2]) * cycle + [0.4, 0.4 + np.pi / 2, 1.0, 1.0 + np.pi / 2])
    standing = np.tile([0, 0, 900.0], 15) + rng.normal(0, 300, 45)
    values = standing + scores @ postures + rng.normal(0, 1, (960, 45))
    return label_trajectories(values.reshape(-1, 15, 3), markers=JOINTS.markers, rate_hz=120)


@pytest.fixture(scope="module")
def walker(walk):
    return decompose_pca(walk)


def curves(n: int, seed: int):
    rng = np.random.default_rng(seed)
    falling = np.sort(rng.integers(0, 15, n))[::-1]
    return SimpleNamespace(
        n_components=np.arange(1, n + 1), separation=falling, generalisation=falling + 3
    )


def test_the_curves_of_each_panel_are_those_given():
    given = {title: curves(20, seed) for seed, title in enumerate("abcdefghi")}
    figure = figure_curves(given, n_walkers=40)
    drawn = [axes for axes in figure.axes if axes.get_lines()]
    assert len(drawn) == 9
    for axes, (title, curve) in zip(drawn, given.items(), strict=True):
        separation, generalisation = axes.get_lines()[:2]
        assert axes.get_title(loc="left") == title
        np.testing.assert_array_equal(separation.get_ydata(), curve.separation)
        np.testing.assert_array_equal(generalisation.get_ydata(), curve.generalisation)
        np.testing.assert_array_equal(generalisation.get_xdata(), curve.n_components)


def test_separation_is_dashed_blue_and_generalisation_solid_red():
    separation, generalisation = (
        figure_curves({"sex": curves(9, 1)}, n_walkers=40).axes[0].lines[:2]
    )
    assert (separation.get_color(), generalisation.get_color()) == (TEAL, PURPLE)
    assert separation.is_dashed()
    assert not generalisation.is_dashed()


def test_the_axis_at_the_right_is_the_share_of_walkers():
    figure = figure_curves({"sex": curves(9, 1)}, n_walkers=40)
    figure.canvas.draw()
    left = figure.axes[0]
    right = left.child_axes[0]
    np.testing.assert_allclose(np.array(left.get_ylim()) * 100 / 40, right.get_ylim())


def test_the_ring_is_at_the_fewest_errors():
    curve = curves(30, 5)
    curve.generalisation = np.array([9, 7, 4, 4, 6] * 6)
    figure = figure_curves({"sex": curve}, n_walkers=40)
    ring = figure.axes[0].lines[2]
    assert (ring.get_xdata()[0], ring.get_ydata()[0]) == (3, 4)
    assert "best: 4 at 3" in [text.get_text() for text in figure.axes[0].texts]


def test_no_curves_are_refused():
    with pytest.raises(ValueError, match="no curves"):
        figure_curves({}, n_walkers=40)
    with pytest.raises(ValueError, match="no curves"):
        figure_regression_curves({})


def trait_curves(told, fitted=None):
    n = np.arange(1, len(told) + 1)
    fitted = 1 - 0.8**n if fitted is None else fitted
    return SimpleNamespace(n_components=n, trained_r2=fitted, r2=np.array(told))


def test_the_curves_of_a_trait_are_those_given_in_the_same_look():
    given = {title: trait_curves([0.1 * k, 0.3, 0.0]) for k, title in enumerate("abcde")}
    figure = figure_regression_curves(given)
    drawn = [axes for axes in figure.axes if axes.get_visible()]
    for axes, (title, curve) in zip(drawn, given.items(), strict=True):
        separation, generalisation, ring = axes.get_lines()[:3]
        assert axes.get_title(loc="left") == title
        np.testing.assert_array_equal(separation.get_ydata(), curve.trained_r2)
        np.testing.assert_array_equal(generalisation.get_ydata(), curve.r2)
        assert (separation.get_color(), generalisation.get_color()) == (TEAL, PURPLE)
        assert separation.is_dashed()
        assert not generalisation.is_dashed()
        assert ring.get_ydata()[0] == curve.r2.max()


def test_a_trait_that_nothing_tells_leaves_the_panel_and_leaves_words():
    figure = figure_regression_curves({"a": trait_curves([-1.4, -2, -9]), "b": trait_curves([1.0])})
    low, high = figure.axes[0].get_ylim()
    assert -1 < low < high < 2
    words = [[text.get_text() for text in axes.texts] for axes in figure.axes]
    assert "best: \N{MINUS SIGN}1.40 at 1" in words[0]
    assert "best: 1.00 at 1" in words[1]
    markers = [[line.get_marker() for line in axes.lines] for axes in figure.axes]
    assert ("o" in markers[0], "o" in markers[1]) == (False, True)


def test_bars_are_mean_and_sd_of_the_variance_shares(walker):
    share = np.array(walker.fit.variance_share)
    other = replace(walker, fit=replace(walker.fit, variance_share=share * 0.9))
    figure = figure_variance([walker, other], n_components=4)
    heights = [bar.get_height() for bar in figure.axes[0].patches]
    np.testing.assert_allclose(heights, 95 * share[:4])
    whiskers = figure.axes[0].containers[1].lines[2][0].get_segments()
    np.testing.assert_allclose(
        [np.ptp(whisker[:, 1]) / 2 for whisker in whiskers], 10 * share[:4] / np.sqrt(2)
    )


def test_walkers_that_come_from_no_capture_have_no_variance_to_show(walker):
    made = Walker(walker.markers, walker.p0, walker.p, walker.harmonics, walker.phases, 1.0)
    with pytest.raises(ValueError, match="decompose_pca"):
        figure_variance([made])


def test_scores_above_and_sines_below_with_their_r2(walk, walker):
    figure = figure_scores(walk, walker)
    above, below = figure.axes
    scores, sines = scores_of(walk, walker)
    for component in range(4):
        upper, lower = above.lines[component + 1], below.lines[component + 1]
        np.testing.assert_allclose(upper.get_ydata(), scores[:600, component])
        np.testing.assert_allclose(lower.get_ydata(), sines[:600, component])
        assert len(upper.get_xdata()) == 600
    assert below.texts[0].get_text().endswith(f"{walker.fit.sine_r2[0]:.2f}")


def test_scores_are_projections_whose_variance_is_that_of_the_components(walk, walker):
    scores, sines = scores_of(walk, walker)
    total = ((walk - walk.mean("time")) ** 2).sum().item()
    np.testing.assert_allclose(
        (scores**2).sum(axis=0) / total, walker.fit.variance_share[:4], rtol=1e-3
    )
    r2 = 1 - ((scores - sines) ** 2).sum(axis=0) / (scores**2).sum(axis=0)
    np.testing.assert_allclose(r2, walker.fit.sine_r2, atol=1e-3)


def test_the_joints_are_drawn_where_they_are_and_named(walker):
    axes = figure_joints(walker).axes[0]
    named = {text.get_text() for text in axes.texts}
    assert {marker.replace("_", " ") for marker in JOINTS.markers} <= named
    assert {"front", "three-quarter", "side"} <= named
    drawn = {tuple(np.round(xy, 6)) for line in axes.lines for xy in line.get_xydata()}
    for y, z in walker.p0[1:, 1:]:
        assert tuple(np.round([y, z], 6)) in drawn
    heads = [patch for patch in axes.patches if isinstance(patch, Circle)]
    assert len(heads) == 3


def test_names_do_not_lie_on_each_other(walker):
    axes = figure_joints(walker, azimuths_deg=[0]).axes[0]
    for side in ("left", "right"):
        heights = sorted(t.get_position()[1] for t in axes.texts if t.get_ha() == side)
        assert np.diff(heights).min() > 90


def test_eigenpostures_are_drawn_enlarged_when_they_are_small():
    p = np.zeros((2, 1, 3))
    p[0, 0], p[1, 0] = [250, 0, 0], [0, 0, 20]
    figure = figure_eigenpostures(Walker(["foot"], [[0, 0, 50]], p, [1, 2], [0, 0], 1.0))
    words = [text.get_text() for text in figure.axes[0].texts]
    assert "harmonic 1" in words
    assert "harmonic 2, 10-fold" in words


def test_moler_names_the_four_postures(walker):
    words = [text.get_text() for text in figure_eigenpostures(walker).axes[0].texts]
    assert [w for w in words if "harmonic" not in w] == [
        "1  stride",
        "2  sway",
        "3  hop",
        "4  bounce",
    ]


def test_walkers_stand_side_by_side_at_one_scale(walker):
    small = Walker(
        walker.markers, walker.p0 / 2, walker.p / 2, walker.harmonics, walker.phases, 1.0
    )
    axes = figure_walkers({"as is": walker, "half": small}, azimuths_deg=[0]).axes[0]
    assert [text.get_text() for text in axes.texts] == ["as is", "half"]
    whole, half = (patch.get_center()[1] for patch in axes.patches)
    assert whole / half == pytest.approx(2)
    assert axes.get_aspect() == 1


def test_the_space_shows_each_walker_at_its_scores():
    rng = np.random.default_rng(2)
    X = rng.normal(size=(30, 6)) * [5, 3, 1, 1, 1, 1]
    space = WalkerSpace().fit(X)
    sex = np.where(X[:, 0] > 0, "male", "female")
    figure = figure_space(
        space, X, sex, trait_name="sex", step=space.eigenwalkers_[0], poles=("f", "m")
    )
    axes = figure.axes[0]
    drawn = np.concatenate([np.asarray(group.get_offsets()) for group in axes.collections])
    expected = np.concatenate(
        [space.transform(X[sex == name])[:, :2] for name in ("female", "male")]
    )
    np.testing.assert_allclose(drawn, expected)
    assert {"f", "m"} <= {text.get_text() for text in axes.texts}
    assert f"({100 * space.explained_variance_ratio_[0]:.0f} % of variance)" in axes.get_xlabel()


def test_a_continuous_trait_gets_a_scale_with_its_unit():
    X = np.random.default_rng(2).normal(size=(30, 4))
    figure = figure_space(WalkerSpace().fit(X), X, X[:, 0], trait_name="Weight (kg)")
    assert figure.axes[1].get_ylabel() == "Weight (kg)"
    np.testing.assert_allclose(figure.axes[0].collections[0].get_array(), X[:, 0])


def test_more_classes_than_can_be_told_apart_are_refused():
    X = np.random.default_rng(2).normal(size=(30, 4))
    names = [f"style {number % 7}" for number in range(30)]
    with pytest.raises(ValueError, match="7 classes"):
        figure_space(WalkerSpace().fit(X), X, names, trait_name="style")


def test_views_have_names():
    assert [view_name(view) for view in (0, 30, 90.0, 90.5)] == [
        "front",
        "three-quarter",
        "side",
        "90.5°",
    ]


def test_figures_leave_no_state_behind(walker):
    before, pyplot = dict(mpl.rcParams), sys.modules.get("matplotlib.pyplot")
    n_open = len(pyplot.get_fignums()) if pyplot else 0
    figure_joints(walker)
    figure_eigenpostures(walker)
    figure_curves({"a": curves(5, 1)}, n_walkers=40)
    assert dict(mpl.rcParams) == before
    assert sys.modules.get("matplotlib.pyplot") is pyplot
    assert (len(pyplot.get_fignums()) if pyplot else 0) == n_open
