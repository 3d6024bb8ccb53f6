"""Dots, blobs, boxes and first frames, measured in pictures: none tells who walks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.plotting.layout import arrange, positions_at
from eigenwalker.stimulus import Figure, make_stimulus
from eigenwalker.stimulus.drawing import drawn_frames
from eigenwalker.stimulus.start_phase import beginning_at, leg_phase

SCREEN = {"viewing_distance_mm": 570, "px_per_cm": 38}


@pytest.fixture(scope="module")
def people():
    population = ew.load_population()
    step = ew.trait_axis(population, "sex").step
    return [population.walker(population.average + sd * step) for sd in (-6, -3, 0, 3, 6)]


def diameter_px(stimulus) -> float:
    """Of the dots that lie alone in pictures of half a second, from the light that they give."""
    times, light = np.linspace(0, 0.5, 4), []
    display, played = stimulus.display, stimulus.play(times)
    middle = np.array([display.width_px, display.height_px]) / 2
    places = middle + display.px_per_mm * played.picture * [1, -1] - 0.5
    reach = int(np.ceil(display.dot_px / 2)) + 1
    for cover, here, seen in zip(
        drawn_frames(stimulus, times), places, played.visible, strict=True
    ):
        apart = np.abs(here[:, None] - here[seen]).max(axis=2)
        for x, y in np.rint(here[seen & (np.sort(apart)[:, 1] > 2 * reach)]).astype(int):
            spot = cover[y - reach : y + reach + 1, x - reach : x + reach + 1]
            light.append(spot.sum() / 255)
    assert len(light) > 3
    return float(2 * np.sqrt(np.mean(light) / np.pi))


@pytest.mark.parametrize("azimuth_deg", [0, 30, 90])
def test_dots_of_all_walkers_are_alike_in_pictures(people, azimuth_deg):
    shown = [make_stimulus(walker, azimuth_deg=azimuth_deg) for walker in people]
    assert {each.display.dot_px for each in shown} == {10.24}
    assert len({round(each.display.px_per_mm, 3) for each in shown}) == 5
    for high in (5, 8):
        sized = [each.sized(high, **SCREEN) for each in shown]
        found = [diameter_px(each) for each in sized]
        assert np.ptp(found) < 0.1
        assert np.mean(found) == pytest.approx(0.12 * 9.948 * 3.8, abs=0.15)


def test_dots_are_as_large_as_asked_for(people):
    walker = people[0]
    for asked, px in (
        ({"dot_px": 6}, 6),
        ({"dot_deg": 0.2, **SCREEN}, 2 * 570 * np.tan(np.deg2rad(0.1)) * 3.8),
        ({"dot_mm": 2, **SCREEN}, 7.6),
    ):
        shown = make_stimulus(walker, size_px=(700, 700), **asked)
        assert diameter_px(shown) == pytest.approx(px, abs=0.15)
        assert shown.sized(5, **SCREEN).display.dot_px == shown.display.dot_px
    assert make_stimulus(walker).sized(5, dot_px=9, **SCREEN).display.dot_px == 9
    with pytest.raises(ValueError, match="give one of them"):
        make_stimulus(walker, dot_px=5, dot_deg=0.2, **SCREEN)
    with pytest.raises(ValueError, match="give viewing_distance_mm and px_per_cm"):
        make_stimulus(walker, dot_deg=0.2)


def test_a_file_of_older_days_plays_with_its_own_dots(people):
    made = make_stimulus(people[1])
    old = replace(made, display=replace(made.display, dot_px=5.02))
    assert ew.Stimulus.from_json(old.to_json()).display.dot_px == 5.02
    assert diameter_px(old) == pytest.approx(5.02, abs=0.15)


def test_dots_of_several_figures_in_one_scene_are_alike(people):
    scene = [Figure(w, position_mm=(0, 900 * i, 0)) for i, w in enumerate((people[0], people[4]))]
    shown = make_stimulus(scene, azimuth_deg=0, size_px=(900, 700), eye_distance_mm=4000)
    one, other = (
        diameter_px(shown.then("occlude", figures=[hidden], markers=list(ew.JOINTS.markers)))
        for hidden in (0, 1)
    )
    assert one == pytest.approx(other, abs=0.15)


@pytest.mark.parametrize("azimuth_deg", [0, 30, 90])
def test_sticks_blobs_and_boxes_of_noise_do_not_go_with_the_walker(people, azimuth_deg):
    drawn = set()
    for walker in people:
        shown = make_stimulus(walker, azimuth_deg=azimuth_deg, dot_px=8).sized(5, **SCREEN)
        shown = shown.then("blur", sd_usual_mm=40).then("mask", number=20, seed=1)
        mask, scramble = shown.transforms[1], shown.then("scramble", seed=1).transforms[-1]
        boxes = np.array([mask["box_mm"], scramble["box_mm"]]) * shown.display.px_per_mm
        drawn.add((*boxes.ravel().round(1), round(shown.transforms[0]["sd_px"], 2)))
    assert len(drawn) == 1
    assert next(iter(drawn))[-1] == pytest.approx(40 / 1500 * 189.3, abs=0.05)


def test_a_blob_in_pixels_is_the_blob_that_is_drawn(people):
    shown = make_stimulus(people[0], azimuth_deg=90, size_px=(800, 800)).then("blur", sd_px=6)
    (cover,) = drawn_frames(shown.then("occlude", show=["head"]), np.zeros(1))
    assert cover.sum() / 255 == pytest.approx(2 * np.pi * 6**2, rel=0.02)
    in_mm = make_stimulus(people[0]).then("blur", sd_mm=40)
    assert in_mm.scene[0].blob_px(0.5) == 20
    with pytest.raises(ValueError, match="either sd_mm or sd_px"):
        shown.then("blur", sd_px=3, sd_mm=3)


def test_all_walkers_begin_at_one_phase_of_the_stride(people):
    assert np.ptp(np.rad2deg([leg_phase(walker) for walker in people])) > 1
    for phase_deg in (0.0, 90.0):
        shown = [make_stimulus(walker, phase_deg=phase_deg) for walker in people]
        phases = [leg_phase(each.figures[0].motion) for each in shown]
        np.testing.assert_allclose(np.rad2deg(phases), phase_deg, atol=1e-6)
    still = make_stimulus(people[0], phase_deg=None).figures[0].motion
    np.testing.assert_array_equal(still.phases, people[0].phases)


@pytest.mark.parametrize("form", ["eigenposture", "fourier"])
def test_a_walker_that_begins_elsewhere_is_the_same_walker(people, form):
    walker = people[3]
    if form == "fourier":
        walker = ew.decompose_fourier(walker.trajectories(np.arange(0, 6, 0.01)))
    later = beginning_at(walker, 40)
    ahead = (np.deg2rad(40) - leg_phase(walker)) / (2 * np.pi)
    cycle = np.linspace(0, 6, 20)
    np.testing.assert_allclose(
        later.positions(cycle), walker.positions(cycle + 2 * np.pi * ahead), atol=1e-9
    )
    if form == "fourier":
        np.testing.assert_array_equal(later.phases, walker.phases)


@pytest.mark.parametrize("style", ["dots", "sticks"])
def test_films_draw_all_walkers_with_dots_and_sticks_alike(people, style):
    drawn = set()
    for walker in people:
        layout = arrange(
            [positions_at(walker, np.arange(0, 1, 0.1))],
            azimuth_deg=30,
            elevation_deg=0,
            eye_distance_mm=None,
            style=style,
            size_px=400,
            titles=(),
        )
        drawn.add((layout.shape, layout.dot_px))
    assert drawn == {((400, 200), 8.0)}
