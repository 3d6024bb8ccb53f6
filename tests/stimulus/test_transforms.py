"""Transforms: what each keeps and what it breaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.datasets.built_in import load_population
from eigenwalker.plotting.projection import observer_axes, project
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.make import make_stimulus, with_information
from eigenwalker.stimulus.moving_dots import parents_of
from eigenwalker.stimulus.stimulus import Stimulus

TIME = np.arange(0, 2.5, 0.04)
INDEX = {name: JOINTS.index(name) for name in JOINTS.markers}


@pytest.fixture(scope="module")
def people():
    return load_population()


@pytest.fixture(scope="module")
def walker(people) -> Walker:
    return people.walkers[5]


@pytest.fixture(scope="module")
def plain(walker) -> Stimulus:
    return make_stimulus(walker, azimuth_deg=30)


def at(stimulus: Stimulus, time=TIME) -> np.ndarray:
    return stimulus.play(time).positions


def same(one: np.ndarray, other: np.ndarray, atol: float = 1e-9) -> None:
    np.testing.assert_allclose(one, other, rtol=0, atol=atol)


def of(name: str, positions: np.ndarray) -> np.ndarray:
    return positions[:, INDEX[name]]


def test_a_plain_stimulus_is_the_walker_from_its_first_phase(walker):
    plain = make_stimulus(walker, phase_deg=None)
    same(at(plain), walker.trajectories(walker.time_origin_s + TIME).values)


def test_the_picture_is_the_projection_about_the_centre(walker):
    for view, elevation in ((0, 0), (30, 10), (-90, -20)):
        shown = make_stimulus(walker, azimuth_deg=view, elevation_deg=elevation)
        centre = project(shown.view.centre_mm, azimuth_deg=view, elevation_deg=elevation)
        seen = project(at(shown), azimuth_deg=view, elevation_deg=elevation) - centre
        same(shown.play(TIME).picture, seen)


def test_perspective_shows_the_near_larger_and_the_centre_as_it_is(walker):
    shown = make_stimulus(walker, azimuth_deg=90, eye_distance_mm=2000)
    flat = make_stimulus(walker, azimuth_deg=90)
    near, far = INDEX["right_wrist"], INDEX["left_wrist"]
    ratio = np.linalg.norm(shown.play(TIME).picture, axis=2) / np.linalg.norm(
        flat.play(TIME).picture, axis=2
    )
    assert (ratio[:, near] > 1).all()
    assert (ratio[:, far] < 1).all()
    away = (at(shown) - shown.view.centre_mm) @ observer_axes(90)[2]
    same(ratio, 2000 / (2000 - away))


def test_dots_behind_the_eye_are_not_seen(walker):
    afar = make_stimulus(walker, azimuth_deg=90)
    towards = (at(afar) - afar.view.centre_mm) @ observer_axes(90)[2]
    eye_mm = 0.5 + float(np.median(towards[:, INDEX["right_wrist"]]))
    played = make_stimulus(walker, azimuth_deg=90, eye_distance_mm=eye_mm).play(TIME)
    assert played.visible.tolist() == (towards <= eye_mm - 1).tolist()
    assert 0 < played.visible[:, INDEX["right_wrist"]].mean() < 1


@pytest.mark.parametrize("name", ["invert", "mirror", "reverse"])
def test_twice_is_nothing(plain, name):
    same(at(plain.then(name).then(name)), at(plain), atol=1e-8)
    assert np.abs(at(plain.then(name)) - at(plain)).max() > 50


def test_inversion_turns_heights_over_and_keeps_the_rest(plain):
    before, after = at(plain), at(plain.then("invert"))
    same(after[..., :2], before[..., :2])
    sum_of_heights = before[..., 2] + after[..., 2]
    same(sum_of_heights, np.full_like(sum_of_heights, sum_of_heights[0, 0]))
    assert (of("head", after)[:, 2] < of("left_ankle", after)[:, 2]).all()


def test_a_mirror_swaps_the_sides(plain):
    before, after = at(plain), at(plain.then("mirror"))
    for left, right in JOINTS.pairs:
        same(of(left, after)[:, [0, 2]], of(right, before)[:, [0, 2]])
        sums = of(left, after)[:, 1] + of(right, before)[:, 1]
        same(sums, np.full_like(sums, sums[0]))


def test_a_mirror_is_the_other_view_mirrored(walker):
    """J33: views of 30 and -30 degrees, of a walker and its mirror image."""
    one = make_stimulus(walker, azimuth_deg=30).then("mirror").play(TIME).picture
    other = make_stimulus(walker, azimuth_deg=-30).play(TIME).picture
    swapped = other[:, list(JOINTS.mirror())] * [-1, 1]
    same(one - one[:1, :1], swapped - swapped[:1, :1])


@given(
    axis=st.lists(st.floats(-5, 5), min_size=3, max_size=3).filter(lambda a: np.abs(a).max() > 0.1),
    angle=st.floats(-720, 720),
)
@settings(max_examples=20, deadline=None)
def test_a_rotation_keeps_all_distances_and_can_be_undone(plain, axis, angle):
    turned = plain.then("rotate", axis=axis, angle_deg=angle)
    before, after = at(plain), at(turned)
    gaps = [np.linalg.norm(x[:, :1] - x, axis=2) for x in (before, after)]
    same(gaps[0], gaps[1], atol=1e-6)


def test_a_rotation_about_up_is_a_change_of_view(walker):
    turned = make_stimulus(walker, azimuth_deg=30).then("rotate", axis="z", angle_deg=40)
    seen = make_stimulus(walker, azimuth_deg=70).play(TIME).picture
    found = turned.play(TIME).picture
    same(found - found[:1, :1], seen - seen[:1, :1])


def test_half_a_turn_about_the_line_of_sight_turns_the_picture(plain):
    before = plain.play(TIME).picture
    after = plain.then("rotate", axis="sight", angle_deg=180).play(TIME).picture
    same(after - after[:1, :1], -(before - before[:1, :1]))


def test_a_turning_figure_is_back_after_a_turn(plain):
    turning = plain.then("freeze").then("rotate", axis="z", speed_deg_s=90)
    same(at(turning, [0.0]), at(turning, [4.0]))
    assert np.abs(at(turning, [0.0]) - at(turning, [2.0])).max() > 200


def test_resizing_keeps_the_floor_and_the_proportions(plain):
    before, after = at(plain), at(plain.then("resize", factor=0.5))
    same(after[..., 2], before[..., 2] / 2)
    same(after[:, 3] - after[:, 7], (before[:, 3] - before[:, 7]) / 2)


def test_a_walker_over_ground_goes_with_its_speed_and_is_in_the_middle_at_half_time(plain, walker):
    shown = plain.then("overground")
    travelled = at(shown) - at(plain)
    same(travelled[..., 1:], np.zeros_like(travelled[..., 1:]))
    same(np.gradient(travelled[:, 0, 0], TIME), np.full(len(TIME), walker.speed_mm_s), atol=1e-6)
    same(at(shown, [2.0]), at(plain, [2.0]))


def test_speed_reversal_and_phase_change_only_the_clock(plain, walker):
    same(at(plain.then("speed", factor=2)), at(plain, 2 * TIME))
    same(at(plain.then("reverse")), at(plain, 4 - TIME))
    quarter = plain.then("start", phase_deg=90)
    same(at(quarter), at(plain, TIME + walker.period_s / 4))
    fast = plain.then("speed", factor=2).then("start", phase_deg=90)
    same(at(fast, [0.0]), at(quarter, [0.0]))
    assert np.ptp(at(plain.then("freeze", time_s=0.3)), axis=0).max() == 0


def test_phase_scrambling_keeps_each_path_and_breaks_the_order(plain, walker):
    cycle = np.arange(0, 1, 1 / 200) * walker.period_s
    before, after = at(plain, cycle), at(plain.then("phase_scramble", seed=4), cycle)
    spectra = [np.abs(np.fft.rfft(x, axis=0)) for x in (before, after)]
    same(spectra[0], spectra[1], atol=1e-6)
    assert np.abs(before - after).max() > 100


def test_delayed_arms_lag_and_the_rest_does_not(plain, walker):
    later = plain.then("delay", parts="arms", phase_deg=90)
    arms = [INDEX[name] for name in JOINTS.groups["arms"]]
    rest = [INDEX[name] for name in JOINTS.markers if name not in JOINTS.groups["arms"]]
    same(at(later)[:, rest], at(plain)[:, rest])
    same(at(later)[:, arms], at(plain, TIME - walker.period_s / 4)[:, arms])


def test_a_morph_begins_as_one_and_ends_as_the_other(plain, people):
    other = people.walkers[33]
    shown = plain.then("morph", walker=other, start_s=0.5, end_s=1.5)
    before = np.array([0.0, 0.2, 0.5])
    same(at(shown, before), at(plain, before))
    mean_hz = (plain.figures[0].motion.frequency_hz + other.frequency_hz) / 2
    phase = plain.figures[0].motion.frequency_hz * 0.5 + mean_hz * 1.0
    same(
        at(shown, [1.5, 1.7]),
        at(make_stimulus(other), phase / other.frequency_hz + np.array([0, 0.2])),
    )


def test_in_between_a_morph_is_the_mean_of_the_fourier_coefficients(walker, people):
    """WDP2002: linear combinations of walkers are walks too."""
    other = replace(people.walkers[33], frequency_hz=walker.frequency_hz)
    time = np.linspace(0.5, 1.5, 11)
    share = (time - 0.5)[:, None, None]
    shown = make_stimulus(walker).then("morph", walker=other, start_s=0.5, end_s=1.5)
    between = (1 - share) * at(make_stimulus(walker), time) + share * at(make_stimulus(other), time)
    same(at(shown, time), between)


@pytest.mark.parametrize(("words", "hidden"), [({"parts": "lower_body"}, "lower_body"),
                                               ({"show": "upper_body"}, "lower_body")])  # fmt: skip
def test_occlusion_hides_parts_and_changes_no_motion(plain, words, hidden):
    shown = plain.then("occlude", **words).play(TIME)
    same(shown.positions, at(plain))
    for name, visible in zip(shown.dots, shown.visible.T, strict=True):
        assert (not visible.any()) if name in JOINTS.groups[hidden] else visible.all()


def test_arm_swing_changes_arms_only_and_keeps_the_mean_posture(plain, walker):
    cycle = np.arange(0, 1, 1 / 100) * walker.period_s
    before, after = at(plain, cycle), at(plain.then("arm_swing", factor=0), cycle)
    same(before.mean(axis=0), after.mean(axis=0), atol=1e-6)
    hang = of("left_wrist", after) - of("left_shoulder", after)
    same(hang, np.broadcast_to(hang[0], hang.shape))
    others = [i for name, i in INDEX.items() if "elbow" not in name and "wrist" not in name]
    same(before[:, others], after[:, others])


def test_a_gain_of_one_is_nothing(plain):
    same(at(plain.then("gain", parts=["legs", "arms", "head"], factor=1)), at(plain))


def test_a_gain_on_one_axis_leaves_the_others(plain):
    changed = at(plain.then("gain", parts="legs", factor=3, axes="x"))
    same(changed[..., 1:], at(plain)[..., 1:])


def test_widths_and_sway_are_set_apart(plain, walker):
    """Mather and Murdoch (1994): structure of one kind with dynamics of the other."""
    cycle = np.arange(0, 1, 1 / 100) * walker.period_s

    def width_and_sway(stimulus: Stimulus, joint: str) -> tuple[float, float]:
        left, right = (of(f"{s}_{joint}", at(stimulus, cycle))[:, 1] for s in ("left", "right"))
        return (left - right).mean(), np.ptp((left + right) / 2)

    shown = plain.then("conflict", shoulder_width=1.3, hip_width=0.8, shoulder_sway=0, hip_sway=3)
    for joint, width, sway in (("shoulder", 1.3, 0), ("hip", 0.8, 3)):
        before, after = width_and_sway(plain, joint), width_and_sway(shown, joint)
        assert after[0] == pytest.approx(width * before[0])
        assert after[1] == pytest.approx(sway * before[1], abs=1e-6)
    same(at(shown)[..., [0, 2]], at(plain)[..., [0, 2]])
    narrower = 0.1 * width_and_sway(plain, "hip")[0]
    ankles = [of("left_ankle", at(x))[:, 1] for x in (plain, shown)]
    same(ankles[0] - ankles[1], np.full(len(TIME), narrower))


def test_shoulders_and_hips_go_round_ellipses_opposite_to_each_other(plain, walker):
    """Cutting (1978)."""
    cycle = np.arange(0, 1, 1 / 100) * walker.period_s
    shown = at(plain.then("ellipses", shoulder_mm=[40, 10], hip_mm=[15, 25]), cycle)
    for joint, (a, b) in (("shoulder", (40, 10)), ("hip", (15, 25))):
        for side in ("left", "right"):
            ring = of(f"{side}_{joint}", shown)[:, [0, 2]]
            ring = ring - ring.mean(axis=0)
            same(np.sum((ring / [a, b]) ** 2, axis=1), np.ones(len(ring)))
    x = {n: of(n, shown)[:, 0] - of(n, shown)[:, 0].mean() for n in INDEX}
    same(x["left_hip"] / 15, -x["right_hip"] / 15)
    same(x["left_hip"] / 15, -x["left_shoulder"] / 40)
    assert np.corrcoef(x["left_hip"], x["left_ankle"])[0, 1] > 0.8
    before = at(plain, cycle)
    for one, other in (("left_wrist", "left_shoulder"), ("right_ankle", "right_hip")):
        same(of(one, shown) - of(other, shown), of(one, before) - of(other, before))


def test_a_perturbation_moves_its_joint_in_its_time_only(plain):
    shown = plain.then("perturb", markers="left_knee", amount_mm=[0, 50, 0], frequency_hz=0,
                       phase_deg=90, start_s=0.5, end_s=1.0)  # fmt: skip
    change = at(shown) - at(plain)
    during = (TIME >= 0.5) & (TIME < 1.0)
    same(change[during, INDEX["left_knee"], 1], np.full(during.sum(), 50.0))
    change[during, INDEX["left_knee"], 1] -= 50
    same(change, np.zeros_like(change))


@pytest.mark.parametrize("keep", ["nothing", "structure"])
def test_a_scrambled_walker_has_each_dots_own_motion_unchanged(plain, keep):
    before, after = at(plain), at(plain.then("scramble", seed=9, keep=keep))
    moved = after - before
    same(moved, np.broadcast_to(moved[0], moved.shape))
    assert np.linalg.norm(moved[0], axis=1).max() > 100
    same(moved @ observer_axes(30)[2], np.zeros(moved.shape[:2]))


def test_scrambling_that_keeps_structure_takes_the_same_places(plain, walker):
    cycle = np.arange(64) / 64 * walker.period_s

    def places(stimulus: Stimulus) -> np.ndarray:
        return stimulus.play(cycle).picture.mean(axis=0)

    before, after = places(plain), places(plain.then("scramble", seed=9, keep="structure"))
    same(before[np.lexsort(before.T)], after[np.lexsort(after.T)], atol=1e-6)


def test_scrambling_stays_in_its_box_and_in_its_direction(plain, walker):
    cycle = np.arange(64) / 64 * walker.period_s
    shown = plain.then("scramble", seed=2, box_mm=[300, 900])
    mean = shown.play(cycle).picture.mean(axis=0)
    plain_mean = plain.play(cycle).picture.mean(axis=0)
    low, high = plain_mean.min(axis=0), plain_mean.max(axis=0)
    assert (np.abs(mean[:, 1] - (low + high)[1] / 2) <= 450.001).all()
    assert np.ptp(mean[:, 0]) <= 300.001
    level = plain.then("scramble", seed=2, directions="horizontal").play(cycle).picture
    same(level[..., 1], plain.play(cycle).picture[..., 1])


@pytest.mark.parametrize("name", ["scramble", "phase_scramble"])
def test_the_seed_alone_decides(plain, name):
    one, again, other = (at(plain.then(name, seed=seed)) for seed in (5, 5, 6))
    same(one, again, atol=0)
    assert np.abs(one - other).max() > 10


def test_dots_of_a_limited_life_are_on_the_limbs_for_their_life(plain):
    shown = plain.then("limb_dots", number=6, lifetime_s=0.2, seed=1)
    time = np.arange(0, 1.2, 0.01)
    dots, body = at(shown, time), at(plain, time)
    ends = [(INDEX[a], INDEX[b]) for a, b in JOINTS.segments]
    for now, dot in ((t, d) for t in (0, 33, 95) for d in range(6)):
        gaps = [
            np.linalg.norm(dots[now, dot] - body[now, a]) + np.linalg.norm(
                dots[now, dot] - body[now, b]) - np.linalg.norm(body[now, a] - body[now, b])
            for a, b in ends
        ]  # fmt: skip
        assert min(np.abs(gaps)) < 1e-6
    jumps = np.linalg.norm(np.diff(dots, axis=0), axis=2) > 40
    assert jumps.sum(axis=0).max() <= 6
    for dot in range(6):
        moments = time[1:][jumps[:, dot]]
        renewed = (moments - 0.2 * (1 - dot / 6)) % 0.2
        assert (np.minimum(renewed, 0.2 - renewed) < 0.011).all()


@pytest.mark.parametrize(("asynchrony", "at_once"), [(0.0, 10), (1.0, 1)])
def test_dots_begin_anew_together_or_one_after_the_other(plain, asynchrony, at_once):
    shown = plain.then("freeze").then(
        "limb_dots", number=10, lifetime_s=0.2, seed=1, asynchrony=asynchrony
    )
    time = np.arange(0.205, 0.8, 0.01)
    changed = (np.abs(np.diff(at(shown, time), axis=0)).max(axis=2) > 0).sum(axis=1)
    assert set(changed.tolist()) <= {0, at_once, *range(at_once)}
    assert changed.max() == at_once


def test_dots_on_limbs_are_as_many_as_the_limbs_are_long(plain, walker):
    shown = plain.then("freeze").then("limb_dots", number=4000, lifetime_s=None, seed=3)
    dots, body = at(shown, [0.0])[0], at(plain, [0.0])[0]
    shins = [(INDEX[f"{s}_knee"], INDEX[f"{s}_ankle"]) for s in ("left", "right")]
    lengths = {(a, b): np.linalg.norm(walker.p0[INDEX[a]] - walker.p0[INDEX[b]])
               for a, b in JOINTS.segments}  # fmt: skip
    on_shin = 0
    for a, b in shins:
        along = np.linalg.norm(dots - body[a], axis=1) + np.linalg.norm(dots - body[b], axis=1)
        on_shin += (along - np.linalg.norm(body[a] - body[b]) < 1e-6).sum()
    share = sum(v for (a, _), v in lengths.items() if a.endswith("knee")) / sum(lengths.values())
    assert on_shin / 4000 == pytest.approx(share, abs=0.03)


def test_a_mask_fills_its_box_evenly_and_faces_the_observer(plain):
    shown = plain.then("mask", kind="random", number=2000, seed=4, box_mm=[800, 2000])
    played = shown.play([0.0])
    noise = played.figures == 1
    assert noise.sum() == 2000
    places = played.picture[0, noise]
    middle = places.mean(axis=0)
    assert np.ptp(places, axis=0) == pytest.approx([800, 2000], rel=0.02)
    counts, _, _ = np.histogram2d(*(places - middle).T, bins=4)
    assert counts.min() > 125 * 0.6
    depth = (played.positions[0, noise] - shown.transforms[0]["centre_mm"]) @ observer_axes(30)[2]
    same(depth, np.zeros(2000), atol=1e-6)
    same(played.positions[:, ~noise], plain.play([0.0]).positions)


@pytest.mark.parametrize(("words", "number"), [
    ({"signal_to_noise": 0.5}, 30), ({"dots_per_m2": 20, "box_mm": [1000, 2000]}, 40),
])  # fmt: skip
def test_density_and_signal_to_noise_say_how_many(plain, words, number):
    assert plain.then("mask", seed=1, **words).transforms[0]["number"] == number


def test_noise_of_scrambled_walkers_moves_as_the_walker_does(plain):
    shown = plain.then("mask", kind="scrambled", number=30, seed=4).play(TIME)
    body = at(plain)
    noise = shown.positions[:, 15:]
    for dot in range(30):
        same(noise[:, dot] - noise[:1, dot], body[:, dot % 15] - body[:1, dot % 15])


def test_linear_noise_keeps_its_speed_and_stays_in_the_box(plain):
    shown = plain.then("mask", kind="linear", number=50, speed_mm_s=400, seed=4)
    time = np.arange(0, 3, 0.01)
    picture = shown.play(time).picture[:, 15:]
    steps = np.linalg.norm(np.diff(picture, axis=0), axis=2)
    kept = steps < 10
    assert kept.mean() > 0.98
    same(steps[kept], np.full(kept.sum(), 4.0), atol=1e-6)
    assert (np.ptp(picture, axis=(0, 1)) <= np.array(shown.transforms[0]["box_mm"]) + 1e-6).all()


def test_noise_of_a_limited_life_is_renewed_in_turn(plain):
    shown = plain.then("mask", number=20, lifetime_s=0.2, seed=4)
    picture = shown.play(np.arange(0, 1, 0.01)).picture[:, 15:]
    changed = np.abs(np.diff(picture, axis=0)).max(axis=2) > 0
    assert changed.sum(axis=0).min() >= 4
    assert changed.sum(axis=1).max() <= 3


def test_later_transforms_leave_a_mask_as_it_is(plain):
    masked = plain.then("mask", kind="scrambled", number=15, seed=1)
    same(at(masked.then("invert"))[:, 15:], at(masked)[:, 15:])
    assert np.abs(at(masked.then("invert"))[:, :15] - at(masked)[:, :15]).max() > 100


def test_several_walkers_stand_where_they_are_put(walker, people):
    other = Figure(people.walkers[20], position_mm=(0, 1000, 0), heading_deg=90)
    scene = make_stimulus([walker, other])
    played = scene.then("invert", figures=1).play(TIME)
    same(played.positions[:, :15], at(make_stimulus(walker)))
    alone = at(make_stimulus(people.walkers[20]).then("invert"))
    turned = np.stack([-alone[..., 1], alone[..., 0] + 1000, alone[..., 2]], axis=2)
    same(played.positions[:, 15:], turned)


def test_figures_of_one_scene_are_scrambled_differently(walker):
    twins = make_stimulus([walker, walker]).then("scramble", seed=3)
    assert np.abs(at(twins)[:, :15] - at(twins)[:, 15:]).max() > 100


def test_sampled_trajectories_are_held_or_begin_anew():
    walk = label_trajectories(np.arange(12.0).reshape(4, 1, 3), markers=["dot"], rate_hz=2)
    held = make_stimulus(Figure(walk))
    same(at(held, [-1, 0, 0.25, 1.5, 9])[:, 0, 0], [0, 0, 1.5, 9, 9])
    again = make_stimulus(Figure(walk, repeat=True))
    same(at(again, [0, 1.75, 2, 3.5])[:, 0, 0], [0, 4.5, 0, 9])


def test_a_missing_dot_is_not_seen():
    values = np.zeros((4, 2, 3))
    values[1, 0] = np.nan
    walk = label_trajectories(values, markers=["one", "two"], rate_hz=2)
    seen = make_stimulus(walk).play([0.0, 0.25, 0.5, 0.75, 1.0]).visible
    assert seen[:, 0].tolist() == [True, False, False, False, True]
    assert seen[:, 1].all()


def test_a_walker_of_an_angle_is_that_high_on_the_screen(plain):
    """J34: 5 degrees."""
    sized = plain.sized(5, viewing_distance_mm=800, px_per_cm=40)
    cycle = np.arange(64) / 64 * plain.figures[0].motion.period_s
    high = np.ptp(sized.play(cycle).picture[..., 1]) * sized.display.px_per_mm / 4  # mm on screen
    assert np.rad2deg(2 * np.arctan(high / 2 / 800)) == pytest.approx(5)


def test_structure_only_and_dynamics_only_share_what_they_should(people):
    """J35, A16, A17."""
    alike = people.size_normalised()
    structure = with_information(people, 4, "structure")
    dynamics = with_information(people, 4, "dynamics")
    average = alike.walker(alike.average)
    same(structure.p0, alike.walkers[4].p0)
    same(structure.p, average.p)
    assert structure.frequency_hz == pytest.approx(average.frequency_hz)
    same(dynamics.p0, average.p0)
    same(dynamics.p, alike.walkers[4].p)
    assert dynamics.frequency_hz == alike.walkers[4].frequency_hz
    same(dynamics.phases, alike.walkers[4].phases)


def test_a_point_of_the_space_is_size_normalised_too(people):
    by_number = with_information(people, 4, "full")
    by_vector = with_information(people, people.X[4], "full")
    same(by_vector.p0, by_number.p0)
    same(by_vector.p, by_number.p)


def test_all_hangs_on_the_pelvis():
    parents = parents_of(JOINTS)
    assert [parents[i] for i in range(15)] == [1, 8, 1, 2, 3, 1, 5, 6, -1, 8, 9, 10, 8, 12, 13]
