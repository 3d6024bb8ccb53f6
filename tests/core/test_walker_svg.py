"""What notebooks show of walkers and populations: drawings that move, and tables."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

import eigenwalker as ew
from eigenwalker.core.walker_svg import VIEW_DEG, stride_svg
from eigenwalker.plotting.projection import project

SVG = "{http://www.w3.org/2000/svg}"


def frames_of(svg: str, path: int = -1) -> np.ndarray:
    """Where dots are in each drawing: array of shape (frame, dot, 2)."""
    root = ElementTree.fromstring(svg)
    animate = root.findall(f"{SVG}path")[path].find(f"{SVG}animate")
    assert animate is not None
    drawings = animate.attrib["values"].split(";")
    return np.array(
        [
            [[float(number) for number in dot.removesuffix("h0").split()] for dot in dots]
            for dots in ([each for each in drawing.split("M") if each] for drawing in drawings)
        ]
    )


def test_the_drawing_is_what_an_observer_sees_of_the_walker():
    walker = ew.simulate_population(1, 1, seed=2).walkers[0]
    svg = walker.moving_svg()
    drawn = frames_of(svg)
    time = walker.time_origin_s + np.arange(25) * walker.period_s / 24
    seen = project(walker.trajectories(time), azimuth_deg=VIEW_DEG) * [1, -1]
    scale = np.ptp(drawn[..., 1]) / np.ptp(seen[..., 1])
    apart = drawn - scale * seen
    assert np.ptp(apart, axis=(0, 1)).max() < 0.3  # a constant shift, but for rounding
    assert f'dur="{walker.period_s:.4f}s"' in svg


@given(
    arrays(float, (3, 2, 3), elements=st.floats(-1e6, 1e6)),
    st.text(max_size=20),
)
def test_any_movement_fits_in_its_drawing(positions, label):
    printable = "".join(letter for letter in label if letter.isprintable())
    svg = stride_svg(positions, period_s=1.0, height_px=100, label=printable)
    root = ElementTree.fromstring(svg)
    assert root.attrib["aria-label"] == printable
    drawn = frames_of(svg)
    assert (drawn[0] == drawn[-1]).all()
    assert drawn.min() >= 7.9
    assert (drawn <= np.array([float(root.attrib["width"]), 100]) - 7.4).all()


def test_walkers_of_any_markers_have_a_drawing():
    hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    told = hop._repr_html_()
    assert frames_of(hop.moving_svg()).shape == (25, 1, 2)
    assert "1.000 Hz" in told
    assert "speed" not in told


def test_a_population_tells_what_is_known_of_its_walkers():
    people = ew.simulate_population(3, 3, seed=1)
    hostile = people.traits.assign(
        **{"<script>": ["</table><b>"] * 6, "flag": ["limps"] + [""] * 5, "empty": [np.nan] * 6}
    )
    told = replace(people, traits=hostile)._repr_html_()
    assert "6 walkers, 1 flagged, 229 features" in told
    assert "3 female, 3 male" in told
    assert "&lt;script&gt;" in told
    assert "<b>" not in told
    assert "<animate" in told


@pytest.mark.parametrize("columns", [0, 40])
def test_populations_of_no_or_many_traits_have_a_table(columns):
    people = ew.simulate_population(1, 1, seed=1)
    traits = pd.DataFrame({f"t{i}": [f"v{i}", "w"] for i in range(columns)}, index=range(2))
    told = replace(people, traits=traits)._repr_html_()
    assert ("and 28 more" in told) == (columns == 40)
