"""All that is wrong with a capture is found, and nothing that is not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import eigenwalker as ew
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.label_repair import Repair
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.quality.assessment import assess
from eigenwalker.simulation.walk import simulate_walk
from eigenwalker.study.messages import reasons
from eigenwalker.study.process_capture import process_capture


@pytest.fixture(scope="module")
def person():
    return simulate_walk(seed=4, duration_s=6, rate_hz=100, variability=1.0, noise_mm=1.0)


def changed(walk, change):
    values = walk.values.copy()
    change(values)
    return walk.copy(data=values)


def test_a_good_walk_is_for_use(person):
    quality = assess(person)
    assert quality.verdict == "use"
    assert quality.findings == ()
    assert quality.r2 > 0.95
    assert quality.periodicity > 0.95
    assert quality.level
    assert quality.treadmill
    assert quality.n_strides >= 4
    assert max(quality.bone_length_variation.values()) < 0.02


@pytest.mark.parametrize("rise", [-0.5, 0.6])
def test_stairs_are_no_level_walk(person, rise):
    time = person.time.values[:, None, None]
    steps = person + person.attrs["speed_mm_s"] * time * np.array([1, 0, rise])
    quality = assess(steps)
    assert not quality.level
    assert quality.verdict == "do not use"
    assert "not_level" in quality.findings
    assert quality.climb == pytest.approx(rise, rel=0.1)


def test_a_floor_that_was_set_up_askew_is_level(person):
    time = person.time.values[:, None, None]
    assert assess(person + 1200 * time * np.array([1, 0, 0.02])).level


def test_standing_is_no_walk(person):
    rng = np.random.default_rng(0)
    still = person.isel(time=0).values + rng.normal(size=person.shape)
    quality = assess(person.copy(data=still))
    assert quality.verdict == "do not use"
    assert {"not_periodic", "no_steady_walk"} & set(quality.findings)


def test_noise_is_no_steady_walk(person):
    rng = np.random.default_rng(0)
    quality = assess(person + 60 * rng.normal(size=person.shape))
    assert quality.verdict != "use"
    assert quality.r2 < 0.9
    assert "elastic_limbs" in quality.findings


def test_a_walk_that_breaks_off_again_and_again_is_unsteady():
    pieces = [
        simulate_walk(seed=seed, duration_s=2.5, rate_hz=60, noise_mm=1).values for seed in range(5)
    ]
    capture = label_trajectories(np.concatenate(pieces), markers=JOINTS.markers, rate_hz=60)
    quality = assess(capture)
    assert quality.verdict == "use with care"
    assert quality.steady_share < 0.4


def test_missing_samples_are_counted(person):
    def hide(values):
        values[300:305, 4] = np.nan

    quality = assess(changed(person, hide))
    assert quality.missing_share == {"left_wrist": pytest.approx(5 / 600)}
    assert quality.verdict == "use"


def test_a_gap_that_cannot_be_filled_is_the_reason(person):
    def hide(values):
        values[280:330, 4] = np.nan

    quality = assess(changed(person, hide))
    assert quality.verdict == "do not use"
    assert "left_wrist" in quality.problem
    assert quality.n_strides == 0


def test_a_marker_that_flickers_is_counted_and_forgiven(person):
    def jump(values):
        values[250:253, 3] += [0, 300, 0]

    quality = assess(changed(person, jump))
    assert quality.jumps == {"left_elbow": 1}
    assert quality.removed_share == {"left_elbow": pytest.approx(3 / 600)}
    assert quality.verdict == "use"


def test_a_marker_that_flickers_often_is_named(person):
    def jump(values):
        for start in range(40, 590, 50):
            values[start : start + 3, 3] += [0, 300, 0]

    quality = assess(changed(person, jump))
    assert quality.jumps == {"left_elbow": 11}
    assert quality.verdict == "use with care"
    assert quality.findings == ("flicker",)


def test_a_marker_that_stays_elsewhere_jumps(person):
    def jump(values):
        values[250:290, 3] += [0, 300, 0]

    quality = assess(changed(person, jump))
    assert quality.jumps == {"left_elbow": 1}
    assert "jumps" in quality.findings


def test_markers_that_change_sides_are_told_and_put_right(person):
    left, right = JOINTS.index("left_knee"), JOINTS.index("right_knee")

    def swap(values):
        values[250:270, [left, right]] = values[250:270, [right, left]]

    quality = assess(changed(person, swap))
    assert quality.left_right_swaps == 1
    assert quality.repairs == (Repair("left_knee", "swap", 250, 269, "right_knee"),)
    assert quality.verdict == "use with care"
    assert quality.r2 == pytest.approx(assess(person).r2)
    assert assess(person).left_right_swaps == 0


@pytest.mark.filterwarnings("ignore")  # the rate is assumed, and read_mocap says so
def test_noisy_captures_of_a_toy_camera_are_told_to_be_such(captures):
    files = sorted((captures / "kinect").glob("*GeometricPositions*"))
    assert len(files) >= 50
    found = [assess(virtual_markers(read_mocap(file))) for file in files]
    assert {quality.verdict for quality in found} <= {"use with care", "do not use"}
    assert all("elastic_limbs" in quality.findings for quality in found)
    unsteady = {"no_steady_walk", "not_periodic", "hardly_periodic", "unsteady"}
    assert sum(bool(unsteady & set(quality.findings)) for quality in found) > len(found) / 3


def test_a_body_whose_left_is_called_right_is_noticed(person):
    renamed = person.copy(data=person.values[:, JOINTS.mirror()])
    quality = assess(renamed)
    assert quality.sides_swapped
    assert "sides_swapped" in quality.findings


def test_any_markers_can_be_assessed(person):
    quality = assess(person.assign_coords(marker=[f"*{number}" for number in range(15)]))
    assert quality.bone_length_variation == {}
    assert quality.verdict == "use"


@pytest.mark.parametrize(
    ("factor", "finding"),
    [
        (1000, "impossible_height"),
        (0.001, "impossible_height"),
        (2.54, "impossible_height"),
        (1 / 2.54, "small_body"),
    ],
)
def test_a_body_that_no_person_has_tells_of_a_wrong_unit(person, factor, finding):
    quality = assess(person.copy(data=person.values * factor))
    assert finding in quality.findings
    assert quality.verdict != "use"
    assert quality.height_mm == pytest.approx(factor * assess(person).height_mm)


def test_a_body_upside_down_is_noticed(person):
    quality = assess(person.copy(data=person.values * [1, -1, -1]))
    assert quality.verdict == "do not use"
    assert "head_below_feet" in quality.findings


def test_what_is_no_capture_is_refused():
    with pytest.raises(TypeError, match="label_trajectories"):
        assess(np.zeros((10, 15, 3)))  # pyright: ignore[reportArgumentType] # that is the point


def test_walking_down_stairs_is_noticed(captures):
    quality = assess(virtual_markers(read_mocap(captures / "pycgm" / "Movement_trial.c3d")))
    assert "not_level" in quality.findings
    assert quality.verdict == "do not use"


def test_a_real_walk_is_for_use(captures):
    assert assess(virtual_markers(read_mocap(captures / "cmu" / "02_01.c3d"))).verdict == "use"


@pytest.mark.filterwarnings("ignore")  # the unit is guessed, and read_mocap says so
def test_the_stumble_among_acted_styles_is_flagged(captures):
    folder = captures / "bandai-namco"
    stumble = read_mocap(folder / "dataset-2_walk_elderly_008.bvh")
    steady = read_mocap(folder / "dataset-2_walk_normal_001.bvh")
    assert {"unsteady", "hardly_periodic"} & set(assess(virtual_markers(stumble)).findings)
    assert assess(virtual_markers(steady)).verdict == "use"


def test_a_partial_file_that_is_kept_is_flagged(tmp_path: Path) -> None:
    walk = ew.simulate_walk(seed=1, duration_s=8, noise_mm=1)
    path = ew.write_mocap(walk, tmp_path / "walk.trc")
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:-20]))
    capture = ew.read_mocap(path, partial="keep")
    quality = ew.assess(capture)
    assert quality.n_frames_cut == 20
    assert "cut_short" in quality.findings
    assert quality.verdict == "use with care"


def in_a_room(walk, per_second):
    return walk.copy(data=walk.values + np.multiply.outer(walk.time.values, per_second)[:, None])


def tilted(walk, axis, degrees):
    turn = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    return walk.copy(data=walk.values @ turn.T)


@pytest.mark.parametrize("markers", ["joints", "skin"])
def test_frames_that_drift_or_are_tilted_are_noticed(markers):
    walk = simulate_walk(seed=1, duration_s=8, rate_hz=50, markers=markers)
    speed = walk.attrs["speed_mm_s"]

    def findings(capture):
        return assess(virtual_markers(capture)).findings

    for progress in (0.0, speed):
        assert findings(in_a_room(walk, [progress, 0, 0])) == ()
        assert findings(in_a_room(walk, [progress, 0, 125])) == ("not_level",)
        for degrees in (-10, 10):
            assert findings(tilted(in_a_room(walk, [progress, 0, 0]), "x", degrees)) == ("tilted",)
    for degrees in (-10, 10):
        assert findings(tilted(walk, "y", degrees)) == ("sloping",)


@pytest.mark.parametrize("markers", ["joints", "skin"])
@pytest.mark.parametrize("progress", [0.0, 1.0])
def test_a_walk_that_is_played_backwards_is_told(markers, progress):
    walk = simulate_walk(seed=3, duration_s=6, rate_hz=60, markers=markers)
    capture = in_a_room(walk, [progress * walk.attrs["speed_mm_s"], 0, 0])
    backwards = capture[::-1].assign_coords(time=capture.time.values)
    quality = assess(virtual_markers(backwards))
    assert (quality.verdict, quality.findings) == ("use with care", ("backwards",))
    assert quality.speed_mm_s == pytest.approx(-walk.attrs["speed_mm_s"], rel=0.06)
    assert "somebody walks backwards, or the capture is played backwards" in reasons(quality)[0]


def test_a_capture_in_two_dimensions_is_told(person):
    for axes in ([1, 0, 1], [0, 1, 1]):
        flat = person.copy(data=person.values * axes)
        quality = assess(tilted(flat, "z", 30))
        assert quality.verdict == "do not use"
        assert "flat" in quality.findings
        assert "sides_swapped" not in quality.findings


@pytest.fixture(scope="module")
def skin():
    return simulate_walk(seed=3, duration_s=4, rate_hz=30, markers="skin")


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("noise_mm", [0, 3])
def test_markers_in_one_plane_are_said_to_be_so_first(skin, axis, noise_mm):
    values = skin.values.copy()
    values[..., axis] = noise_mm * np.random.default_rng(0).standard_normal(values.shape[:2])
    quality = process_capture(tilted(skin.copy(data=values), "z", 30)).quality
    assert quality.findings[0] == "flat"
    assert not {"tilted", "no_double_support", "wrong_joints"} & {*quality.findings}


@pytest.mark.parametrize(
    ("mirror", "finding"),
    [
        ([1, -1, 1], "sides_swapped"),
        ([-1, 1, 1], "sides_swapped"),
        ([1, -1, -1], "head_below_feet"),
        ([1, 1, -1], "head_below_feet"),
    ],
)
@pytest.mark.parametrize("markers", ["skin", "person"])
def test_a_mirrored_or_inverted_body_is_neither_tilted_nor_backwards(
    request, markers, mirror, finding
):
    walk = request.getfixturevalue(markers)
    quality = process_capture(walk.copy(data=walk.values * mirror)).quality
    assert quality.findings[0] == finding
    assert not {"tilted", "backwards", "no_double_support", "wrong_joints"} & {*quality.findings}


def test_a_small_child_has_limbs(skin):
    for seed in (1, 3):
        child = simulate_walk(seed=seed, duration_s=6, rate_hz=30, markers="skin", height_mm=1100.0)
        assert process_capture(child).quality.findings == ()


def test_who_walks_slowly_with_short_steps_is_told_from_a_wrong_frame_rate():
    walk = simulate_walk(seed=1, duration_s=8, rate_hz=60)
    half = walk.assign_coords(time=walk.time.values * 2)
    assert assess(half).findings == ("cadence",)
    assert "the frame rate is wrong" in reasons(assess(half))[0]
    short = half.copy()
    legs = [f"{side}_{part}" for side in ("left", "right") for part in ("knee", "ankle")]
    pelvis = half.sel(marker="pelvis", axis="x")
    short.loc[{"marker": legs, "axis": "x"}] = pelvis + 0.6 * (
        half.sel(marker=legs, axis="x") - pelvis
    )
    quality = assess(short)
    assert quality.stride_of_leg < 1.2
    assert "cadence" not in quality.findings


def test_a_speed_at_which_nobody_walks_is_told(person):
    fast = person.assign_coords(time=person.time.values / 3)
    assert {"speed", "cadence"} <= set(assess(fast).findings)
    assert assess(fast).frequency_hz == pytest.approx(3 * assess(person).frequency_hz, rel=1e-3)


def test_a_run_has_no_double_support(person):
    """Feet that are on the ground for less than half of the stride, as they are lifted early."""
    walk = person.copy()
    strike = np.radians(64)  # feet are furthest ahead as they come down
    phase = 2 * np.pi * person.attrs["frequency_hz"] * person.time.values - strike
    for side, shift in (("left", 0.0), ("right", np.pi)):
        for joint, size in (("ankle", 350.0), ("knee", 200.0)):
            swing = np.sin(phase + shift) + 0.35 * np.sin(2 * (phase + shift))
            walk.loc[{"marker": f"{side}_{joint}", "axis": "x"}] = -size * swing
    assert 0 < assess(walk).stance_shares < 1
    assert "no_double_support" in assess(walk).findings


@pytest.mark.parametrize("markers", ["joints", "skin"])
def test_the_wrong_unit_comes_before_what_follows_from_it(markers):
    walk = simulate_walk(seed=1, duration_s=5, rate_hz=50, markers=markers)
    quality = assess(virtual_markers(walk.copy(data=walk.values / 1000)))
    assert quality.findings == ("impossible_height",)
    assert "unit='m'" in reasons(quality)[0]


def test_a_number_does_not_look_like_the_limit_that_it_is_beyond(person):
    quality = replace(assess(person), r2=0.8967, frequency_hz=1.4012)
    assert quality.findings == ("hardly_periodic", "cadence")
    unsteady, pace = reasons(quality)
    assert "0.897 of the movement" in unsteady
    assert "0.90 or more" in unsteady
    assert "1.401 strides a second" in pace


@pytest.mark.parametrize("trait", ["sex", "weight_kg", "height_mm", "age_years"])
@pytest.mark.parametrize("steps", [-3, 3])
@pytest.mark.parametrize("overground", [False, True])
def test_walkers_that_are_made_of_two_harmonics_are_for_use(trait, steps, overground, tmp_path):
    """Two harmonics let feet slide and shanks change length a little."""
    people = ew.load_population()
    walker = people.walker(people.average + steps * ew.trait_axis(people, trait).step)
    file = ew.write_mocap(walker, tmp_path / "w.c3d", n_strides=5, overground=overground)
    assert assess(virtual_markers(read_mocap(file))).findings == ()


@pytest.mark.parametrize(
    ("factor", "advice"),
    [(1e-3, "unit='m'"), (1 / 304.8, "unit='ft'"), (1 / 25.4, "unit='in'"), (10, "No unit")],
)
def test_the_unit_that_is_named_makes_a_person_of_the_body(person, factor, advice):
    walk = virtual_markers(person)
    assert advice in reasons(assess(walk.copy(data=walk.values * factor)))[0]
