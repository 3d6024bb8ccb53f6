"""The mannequin: wood that goes with the dots, and how it is seen."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import av
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from matplotlib.image import imread

from eigenwalker.core.skeleton import JOINTS, Skeleton
from eigenwalker.datasets.built_in import load_population
from eigenwalker.plotting.shades import FIRST_FULL, composite_mannequin, mannequin_shades, rgb
from eigenwalker.stimulus.drawing import (
    drawn_frames,
    drawn_shades,
    hulls_of,
    mannequins,
    places_px,
)
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.mannequin import Hulls, body_heights, hulls_at, mannequin_of
from eigenwalker.stimulus.solids import LIGHT, Lit, Look, brightness, draw_hulls
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus

POSTURE = load_population().walkers[0].p0


@pytest.fixture(scope="module")
def average():
    people = load_population()
    return people.walker(people.average)


def wooden(walker, **options) -> Stimulus:
    return make_stimulus(walker, style="mannequin", **{"size_px": (200, 300), **options})


def hulls(stimulus: Stimulus, time_s: float = 0.3) -> Hulls:
    bodies = mannequins(stimulus)
    return hulls_of(stimulus, bodies, stimulus.play([time_s]), 0)


def frame(stimulus: Stimulus, time_s: float = 0.3) -> np.ndarray:
    """Red, green and blue of each pixel, 0 to 255."""
    (numbers,) = drawn_frames(stimulus, np.array([time_s]))
    return np.rint(drawn_shades(stimulus))[numbers]


def whole(lit: Lit, shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    cover, light = np.zeros(shape), np.zeros(shape)
    cover[lit.box], light[lit.box] = lit.cover, lit.light
    return cover, light


def by_balls(hull: Hulls, look: Look, n_balls: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Whether each pixel's line of sight meets the hull, and how bright: ball after ball."""
    rows, columns = np.mgrid[: look.shape[0], : look.shape[1]]
    x = (columns - look.middle_px[0]) / look.px_per_mm
    y = -(rows - look.middle_px[1]) / look.px_per_mm
    if look.eye_mm is None:
        start = np.stack([x, y, np.full(x.shape, 1e4)], -1)
        way = np.broadcast_to([0.0, 0.0, -1.0], start.shape)
    else:
        start = np.broadcast_to([0, 0, look.eye_mm], (*x.shape, 3))
        way = np.stack([x, y, np.full(x.shape, -look.eye_mm)], -1)
        way = way / np.linalg.norm(way, axis=-1, keepdims=True)
    first, light = np.full(x.shape, np.inf), np.zeros(x.shape)
    for share in np.linspace(0, 1, n_balls):
        middle = (1 - share) * hull.middles[0, 0] + share * hull.middles[0, 1]
        radius = (1 - share) * hull.radii[0, 0] + share * hull.radii[0, 1]
        to_middle = middle - start
        along = np.sum(to_middle * way, axis=-1)
        half2 = radius**2 - np.sum(to_middle**2, axis=-1) + along**2
        met = along - np.sqrt(np.maximum(half2, 0))
        nearer = (half2 >= 0) & (met < first)
        normal = (start + met[..., None] * way - middle) / radius
        shade = brightness(normal @ LIGHT, -np.sum(normal * way, axis=-1))
        first, light = np.where(nearer, met, first), np.where(nearer, shade, light)
    return np.isfinite(first), light


place = st.floats(-30, 30)


@settings(max_examples=12, deadline=None)
@given(
    ends=st.lists(st.tuples(place, place, place), min_size=2, max_size=2),
    radii=st.tuples(st.floats(3, 15), st.floats(3, 15)),
    eye_mm=st.sampled_from([None, 150.0, 600.0]),
)
def test_a_hull_is_all_balls_between_its_two(ends, radii, eye_mm):
    hull = Hulls(np.array([ends]), np.array([radii]), np.ones(1))
    look = Look((44, 44), 0.5, (21.5, 21.5), eye_mm)
    cover, light = whole(draw_hulls(hull, look), look.shape)
    met, lit = by_balls(hull, look)
    assert np.abs(cover - met).sum() <= 0.5 * np.count_nonzero((cover > 0) & (cover < 1)) + 1
    assert (cover[~met] < 0.6).all()
    assert (cover[met] > 0.4).all()
    inside = cover > 0.999
    assert np.abs(light - lit)[inside].max(initial=0) < 0.02


@pytest.mark.parametrize("eye_mm", [None, 300.0])
@pytest.mark.parametrize("radii", [(8, 12), (12, 8), (10, 10)])
@pytest.mark.parametrize("way", [(1, 0, 30), (1, 2, -30), (0, 0, 3), (3, 0, 30)])
def test_a_hull_seen_along_its_axis(way, radii, eye_mm):
    hull = Hulls(np.array([[[0, 0, 0], way]], float), np.array([radii], float), np.ones(1))
    look = Look((44, 44), 1.0, (21.5, 21.5), eye_mm)
    cover, light = whole(draw_hulls(hull, look), look.shape)
    met, lit = by_balls(hull, look, 400)
    assert cover.sum() == pytest.approx(met.sum(), rel=0.02)
    assert np.abs(light - lit)[cover > 0.999].max() < 0.02


def test_what_is_worked_out_in_parts_is_the_same(average, monkeypatch):
    whole_picture = frame(wooden(average))
    monkeypatch.setattr("eigenwalker.stimulus.solids.MAX_PIXELS", 200)
    np.testing.assert_array_equal(frame(wooden(average)), whole_picture)


def test_the_nearer_hides_the_farther():
    near, far = [[-10, 0, 30], [10, 0, 30]], [[0, -10, 0], [0, 10, 0]]
    look = Look((40, 40), 1.0, (19.5, 19.5), None)
    for order in ([near, far], [far, near]):
        tones = np.where([item is near for item in order], 1.0, 0.5)
        lit = draw_hulls(Hulls(np.array(order, float), np.full((2, 2), 4.0), tones), look)
        _, light = whole(lit, look.shape)
        alone = draw_hulls(Hulls(np.array([near], float), np.full((1, 2), 4.0), np.ones(1)), look)
        assert light[20, 20] == pytest.approx(whole(alone, look.shape)[1][20, 20])


@settings(max_examples=10, deadline=None)
@given(shift=st.tuples(place, place, place), weight=st.floats(0.1, 3))
def test_wood_goes_with_the_dots(shift, weight):
    places = weight * POSTURE
    seen = np.ones(15, dtype=bool)
    body = mannequin_of(JOINTS, 1700.0)
    there = hulls_at(body, places, seen, None)
    moved = hulls_at(body, places + shift, seen, None)
    np.testing.assert_allclose(moved.middles, there.middles + shift, atol=1e-9)
    np.testing.assert_array_equal(moved.radii, there.radii)
    assert body.weights.sum(axis=2) == pytest.approx(1)


def test_each_joint_but_those_of_the_trunk_has_a_ball_in_its_middle(average):
    stimulus = wooden(average)
    middles = hulls(stimulus).middles
    balls = middles[np.ptp(middles, axis=1).max(axis=1) == 0, 0]
    seen = stimulus.play([0.3]).picture[0]
    names = [name for name in JOINTS.markers if "_" in name]
    assert len(balls) == len(names) == 12
    for name in names:
        assert np.abs(balls[:, :2] - seen[JOINTS.index(name)]).sum(axis=1).min() < 1e-9


@pytest.mark.parametrize("eye_distance_mm", [None, 2500.0])
@pytest.mark.parametrize("name", ["left_ankle", "right_wrist", "left_shoulder"])
def test_joints_are_drawn_where_the_dots_are(average, name, eye_distance_mm):
    stimulus = wooden(average, size_px=(600, 800), eye_distance_mm=eye_distance_mm)
    bodies = mannequins(stimulus)
    alone = bodies[0].weights[..., JOINTS.index(name)].min(axis=1) == 1
    body = bodies[0]._replace(
        **{part: getattr(bodies[0], part)[alone] for part in bodies[0]._fields}
    )
    played = stimulus.play([0.3])
    look = Look((800, 600), stimulus.display.px_per_mm, (299.5, 399.5), eye_distance_mm)
    cover, _ = whole(draw_hulls(hulls_of(stimulus, {0: body}, played, 0), look), look.shape)
    rows, columns = np.mgrid[:800, :600] + 0.5
    centre = np.array([(cover * columns).sum(), (cover * rows).sum()]) / cover.sum()
    assert np.abs(centre - places_px(stimulus, played)[0, JOINTS.index(name)]).max() < 0.5


def test_thickness_goes_with_height_and_with_resize_alone(average):
    plain = wooden(average)
    (height,) = body_heights(plain)
    assert 1500 < height < 1800
    changed = plain.then("invert").then("scramble", seed=1).then("gain", parts="legs", factor=3)
    assert body_heights(changed) == [height]
    assert body_heights(plain.then("resize", factor=0.5)) == [height / 2]
    two = wooden([average, Figure(average, position_mm=(0, 900, 0))])
    assert body_heights(two.then("resize", factor=0.5, figures=1)) == [height, height / 2]


def test_what_hides_a_dot_takes_its_wood_away(average):
    plain = wooden(average)
    no_legs = hulls(plain.then("occlude", parts="legs"))
    assert len(no_legs.tones) < len(hulls(plain).tones)
    assert no_legs.middles[..., 1].min() > hulls(plain).middles[..., 1].min() + 300
    assert not frame(plain.then("occlude", markers=list(JOINTS.markers))).any()


def test_torn_limbs_stay_between_their_dots(average):
    torn = wooden(average).then("scramble", seed=2)
    played = torn.play([0.3])
    drawn = hulls(torn).middles
    wrist, elbow = (played.picture[0, JOINTS.index(f"left_{part}")] for part in ("wrist", "elbow"))
    between = 0.87 * elbow + 0.13 * wrist
    assert np.abs(drawn[..., :2] - between).sum(axis=-1).min() < 1e-9


def test_a_figure_of_other_joints_gets_rods():
    links = Skeleton(("tip", "tail"), (("tip", "tail"),))
    body = mannequin_of(links, 1000.0)
    assert body.weights.tolist() == [[[1, 0], [0, 1]]]
    assert body.radii_mm.tolist() == [[14, 14]]


def test_feet_take_the_place_of_stumps():
    plain = mannequin_of(JOINTS, 1.0)
    more = (*JOINTS.markers, "left_toe", "left_heel")
    feet = mannequin_of(Skeleton(more), 1.0)
    assert len(feet.tones) == len(plain.tones) - 1 + 3


def test_masks_and_limb_dots_stay_dots(average):
    plain = wooden(average)
    as_dots = make_stimulus(average, size_px=(200, 300))
    limb_dots = {"number": 8, "lifetime_s": 0.1, "seed": 1}
    np.testing.assert_array_equal(
        frame(plain.then("limb_dots", **limb_dots)), frame(as_dots.then("limb_dots", **limb_dots))
    )
    masked = plain.then("mask", kind="random", number=40, seed=1)
    wood_alone, both = frame(plain), frame(masked)
    noise = masked.play([0.3])
    spots = np.floor(places_px(masked, noise)[0, noise.figures == 1]).astype(int)
    inside = spots[((spots > 3) & (spots < [197, 297])).all(axis=1)]
    assert (both[inside[:, 1], inside[:, 0]] == 255).all()
    changed = (wood_alone != both).any(axis=2).mean()
    assert 0 < changed < 0.1


def test_shades_are_the_ground_the_dots_and_the_wood():
    shades = mannequin_shades("#103060", "#ff8800")
    assert shades.shape == (256, 3)
    assert shades[0].tolist() == list(rgb("#103060"))
    assert shades[15].tolist() == list(rgb("#ff8800"))
    assert shades[-1].tolist() == pytest.approx([255, 0x88 * 0.9 + 25.5, 25.5])
    assert not shades[FIRST_FULL].any()


def test_half_covered_is_half_way_to_the_ground():
    canvas = np.zeros((1, 2), np.uint8)
    cover = np.array([[0.6, 1.0]])
    composite_mannequin(canvas, (slice(0, 1), slice(0, 2)), cover, 0.5 * cover)
    edge, wood = mannequin_shades("#ffffff", "#ffffff")[canvas[0], 0]
    assert wood == pytest.approx(127.5, abs=1)
    assert edge == pytest.approx(0.4 * 255 + 0.6 * 127.5, abs=4)


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_films_show_the_mannequin_in_its_colours(average, tmp_path, suffix):
    made = wooden(average, duration_s=0.2, rate_hz=25, colour="#c8965a", background="#e8f0ff")
    with av.open(str(write_stimulus(made, tmp_path / f"film{suffix}"))) as film:
        shown = next(film.decode(video=0)).to_ndarray(format="rgb24").astype(float)
    wanted = frame(made, 0.0)
    assert np.abs(shown - wanted).mean() < 3  # H.264 keeps colours by half
    red, green, blue = shown[(wanted != rgb("#e8f0ff")).any(axis=2)].mean(axis=0)
    assert red > green > blue


def test_frames_are_the_same_picture(average, tmp_path):
    made = wooden(average)
    picture = imread(write_stimulus(made, tmp_path / "one.png"))[..., :3] * 255
    np.testing.assert_array_equal(picture.round(), frame(made, 0.0))


def test_a_drawing_has_an_outline_for_each_piece(average, tmp_path):
    made = wooden(average)
    svg = ET.fromstring(write_stimulus(made, tmp_path / "one.svg").read_text())
    pieces = hulls(made, 0.0)
    assert len(svg.findall("{*}path")) == len(svg.findall("{*}linearGradient")) == len(pieces.tones)
    assert not svg.findall("{*}circle")


def test_a_mannequin_beside_the_picture_or_behind_the_eye_is_not_drawn(average):
    away = wooden(Figure(average, position_mm=(0, 0, 0))).then("translate", offset_mm=[0, 1e5, 0])
    assert not frame(away).any()
    behind = wooden(average, eye_distance_mm=3000, azimuth_deg=0)
    assert not frame(behind.then("translate", offset_mm=[5000, 0, 0])).any()
