"""A capture put in place: what was added to a walk is taken out again, and nothing else."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

from eigenwalker.core import share_explained
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories, sampling_rate
from eigenwalker.gait.heading import stance_speed
from eigenwalker.gait.in_place import in_place
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.simulation.walk import simulate_walk

STANDING_S = 2.0


def walking_through_a_room(
    walk, *, heading_deg=0.0, speed_mm_s=None, sway_mm=0.0, start=(0.0, 0.0, 0.0)
):
    """Return a capture of someone in place as it were if they went through the room."""
    time = walk.time.values - walk.time.values[0]
    speed = walk.attrs["speed_mm_s"] if speed_mm_s is None else speed_mm_s
    aside = sway_mm * np.sin(2 * np.pi * 0.1 * time)
    path = np.stack([speed * time, aside, 0 * time], axis=1)
    positions = turned(walk.values + path[:, None], heading_deg) + start
    return plain(walk.copy(data=positions))


def turned(positions, degrees):
    return positions @ Rotation.from_euler("z", degrees, degrees=True).as_matrix().T


def plain(walk):
    """Return a capture that knows nothing but its unit."""
    return xr.DataArray(
        walk.values,
        dims=walk.dims,
        coords={name: walk[name].values for name in walk.dims},
        attrs={"units": "mm"},
    )


def mirrored(walk):
    return walk.copy(data=walk.values[:, JOINTS.mirror()] * [1, -1, 1])


def r2(walk):
    cycles = np.arange(len(walk)) * walk.attrs["frequency_hz"] / sampling_rate(walk)
    return share_explained(walk.values.reshape(len(walk), -1), cycles)


@pytest.fixture(scope="module")
def person():
    """Six seconds of someone on a treadmill, as they are: strides vary, nothing is noise."""
    return simulate_walk(seed=4, duration_s=6, rate_hz=100, variability=1.0)


def test_a_walk_in_place_stays_as_it_is():
    walk = simulate_walk(seed=1, duration_s=8)
    placed = in_place(walk)
    same = walk.sel(time=placed.time)
    moved = placed.values - same.values
    assert np.abs(moved - moved.mean(axis=(0, 1))).max() < 0.5
    assert np.abs(moved.mean(axis=(0, 1))).max() < 15  # the floor is found from the ankles
    assert placed.attrs["treadmill"]
    assert placed.attrs["speed_mm_s"] == pytest.approx(walk.attrs["speed_mm_s"], rel=0.05)
    known = in_place(walk, speed_mm_s=1234)
    assert known.attrs["speed_mm_s"] == 1234


@pytest.mark.parametrize("heading_deg", [0, 90, -90, 180, 37])
def test_progress_is_turned_to_x_and_taken_out(person, heading_deg):
    capture = walking_through_a_room(person, heading_deg=heading_deg, start=(3000, -500, 20))
    placed = in_place(capture)
    off = placed.attrs["heading_deg"] - heading_deg
    assert abs((off + 180) % 360 - 180) < 0.5
    assert placed.attrs["speed_mm_s"] == pytest.approx(person.attrs["speed_mm_s"], rel=0.02)
    assert not placed.attrs["treadmill"]
    known = person.sel(time=placed.time).values
    difference = placed.values - known
    assert np.abs(difference - difference.mean(axis=(0, 1))).max() < 15
    assert (
        placed.sel(marker="left_hip", axis="y").mean()
        > placed.sel(marker="right_hip", axis="y").mean()
    )


@settings(max_examples=20, deadline=None)
@given(
    degrees=st.floats(-180, 180),
    shift=st.tuples(*[st.floats(-1e4, 1e4)] * 3),
    later_s=st.floats(-1e3, 1e3),
)
def test_where_when_and_which_way_change_nothing(person, degrees, shift, later_s):
    capture = walking_through_a_room(person[:400])
    elsewhere = capture.copy(data=turned(capture.values, degrees) + shift)
    elsewhere = elsewhere.assign_coords(time=capture.time.values + later_s)
    one, other = in_place(capture), in_place(elsewhere)
    np.testing.assert_allclose(other.values, one.values, atol=1e-6)
    np.testing.assert_allclose(other.time.values, one.time.values + later_s)
    off = other.attrs["heading_deg"] - one.attrs["heading_deg"] - degrees
    assert abs((off + 180) % 360 - 180) < 1e-6


def test_the_unit_changes_nothing(person):
    capture = walking_through_a_room(person)
    metres = label_trajectories(
        capture.values / 1000,
        markers=JOINTS.markers,
        rate_hz=100,
        unit="m",
        start_s=float(capture.time[0]),
    )
    np.testing.assert_allclose(in_place(metres).values, in_place(capture).values, atol=1e-6)


def test_a_mirrored_capture_gives_the_mirrored_walk(person):
    capture = walking_through_a_room(person, heading_deg=20)
    np.testing.assert_allclose(
        in_place(mirrored(capture)).values, mirrored(in_place(capture)).values, atol=1e-6
    )


@pytest.mark.parametrize("heading_deg", [0, 90])
def test_a_second_time_changes_nothing(person, heading_deg):
    noisy = person + np.random.default_rng(0).normal(size=person.shape)
    capture = walking_through_a_room(noisy.assign_attrs(person.attrs), heading_deg=heading_deg)
    once = in_place(capture)
    twice = in_place(once, heading_deg=0, speed_mm_s=once.attrs["speed_mm_s"])
    np.testing.assert_allclose(twice.values, once.values, atol=1e-6)
    for name in ("speed_mm_s", "n_strides"):
        assert twice.attrs[name] == pytest.approx(once.attrs[name], abs=1e-6), name


@pytest.mark.parametrize("speed_mm_s", [0, None])
def test_attributes_of_the_capture_change_nothing(person, speed_mm_s):
    capture = walking_through_a_room(person, speed_mm_s=speed_mm_s, heading_deg=20)
    once = in_place(capture)
    for walk in (capture, once):
        bare, full = in_place(plain(walk)), in_place(walk.assign_attrs(person.attrs | walk.attrs))
        np.testing.assert_array_equal(full.values, bare.values)
        for name, value in bare.attrs.items():
            assert full.attrs[name] == value, name


def test_wander_on_the_belt_is_taken_out():
    walk = simulate_walk(seed=1, duration_s=12)
    time = walk.time.values
    wander = np.stack([50 * np.sin(0.6 * time), 30 * np.cos(0.4 * time), 0 * time], axis=1)
    wandering, still = in_place(walk + wander[:, None]), in_place(walk)
    common = wandering.time.values[np.isin(wandering.time, still.time)]
    difference = wandering.sel(time=common).values - still.sel(time=common).values
    assert np.sqrt((difference**2).mean()) < 3
    assert wandering.attrs["wander_mm"] > 10 > still.attrs["wander_mm"]


def test_standing_before_and_after_is_left_out(person):
    capture = walking_through_a_room(person)
    still = round(STANDING_S * 100)
    standing = np.concatenate(
        [[capture.values[0]] * still, capture.values, [capture.values[-1]] * still]
    )
    longer = label_trajectories(standing, markers=JOINTS.markers, rate_hz=100)
    placed = in_place(longer)
    assert placed.attrs["steady_start_s"] > STANDING_S - 0.3
    assert placed.attrs["steady_end_s"] < longer.time[-1] - STANDING_S + 0.3
    assert placed.attrs["n_strides"] >= in_place(capture).attrs["n_strides"] - 1
    assert r2(placed) > 0.97


def test_turning_round_is_left_out(person):
    there = walking_through_a_room(person)
    angles = np.linspace(0, np.pi, 100)
    turning = [turned(there.values[-1], np.rad2deg(angle)) for angle in angles]
    capture = label_trajectories(
        np.concatenate([there.values, turning]), markers=JOINTS.markers, rate_hz=100
    )
    assert in_place(capture).attrs["steady_end_s"] < there.time[-1] - there.time[0] + 0.3


def test_strides_are_whole_to_the_nearest_frame(person):
    placed = in_place(walking_through_a_room(person))
    strides = len(placed) * placed.attrs["frequency_hz"] / 100
    assert placed.attrs["n_strides"] == pytest.approx(strides, abs=0.5 * 0.01)
    assert placed.attrs["n_strides"] == int(6 * placed.attrs["frequency_hz"])


def test_the_pelvis_is_over_the_origin_and_ankles_above_the_floor(person):
    placed = in_place(walking_through_a_room(person, start=(700, 800, 900)))
    np.testing.assert_allclose(placed.sel(marker="pelvis").mean("time")[:2], 0, atol=1e-9)
    ankles = placed.sel(marker=["left_ankle", "right_ankle"], axis="z")
    assert 50 < ankles.min() < 100


def test_backwards_walkers_face_forwards_with_negative_speed(person):
    capture = walking_through_a_room(person[::-1].assign_coords(time=person.time), speed_mm_s=-900)
    placed = in_place(capture)
    assert abs(placed.attrs["heading_deg"]) < 1
    assert placed.attrs["speed_mm_s"] == pytest.approx(-900, rel=0.02)


def test_unknown_marker_names_turn_along_their_way(person):
    capture = walking_through_a_room(person, heading_deg=-120)
    anonymous = capture.assign_coords(marker=[f"*{number}" for number in range(15)])
    placed = in_place(anonymous)
    assert placed.attrs["heading_deg"] == pytest.approx(-120, abs=0.5)
    known = in_place(capture)
    assert placed.attrs["n_strides"] == known.attrs["n_strides"]


@pytest.mark.parametrize("n_strides", [1.6, 2.2, 3.1])
def test_few_strides_are_enough(person, n_strides):
    n_frames = round(n_strides / person.attrs["frequency_hz"] * 100)
    capture = walking_through_a_room(person[30 : 30 + n_frames], heading_deg=-90)
    placed = in_place(capture)
    assert placed.attrs["n_strides"] == int(n_strides)
    assert placed.attrs["frequency_hz"] == pytest.approx(person.attrs["frequency_hz"], rel=0.04)
    assert placed.attrs["heading_deg"] == pytest.approx(-90, abs=1)


def test_less_than_a_stride_is_refused(person):
    with pytest.raises(ValueError, match=r"too short|No stride"):
        in_place(walking_through_a_room(person[:40]))


def test_a_short_gap_is_filled(person):
    capture = walking_through_a_room(person)
    broken = capture.copy()
    broken.loc[{"marker": "left_ankle", "time": capture.time[200:212]}] = np.nan
    placed, whole = in_place(broken), in_place(capture)
    assert placed.attrs["filled_samples"] == 12
    np.testing.assert_allclose(placed.values, whole.values, atol=12)


def test_a_long_gap_in_the_midst_is_refused_by_name(person):
    broken = walking_through_a_room(person)
    broken.loc[{"marker": "left_wrist", "time": broken.time[280:320]}] = np.nan
    with pytest.raises(ValueError, match=r"left_wrist from .* \(frames 280 to 319\)"):
        in_place(broken)


@pytest.mark.parametrize("n_missing", [24, 100, 300, 600])
def test_a_gap_between_steady_strides_is_refused_however_long(n_missing):
    broken = simulate_walk(seed=1, duration_s=12, rate_hz=120)
    broken.loc[{"marker": "left_knee", "time": broken.time[500 : 500 + n_missing]}] = np.nan
    with pytest.raises(ValueError, match=rf"left_knee from .* \(frames 500 to {499 + n_missing}\)"):
        in_place(broken)


def test_who_left_the_room_between_two_passes_left_no_gap():
    walk = simulate_walk(seed=1, duration_s=12, rate_hz=120)
    walk.values[500:800] = np.nan
    assert in_place(walk).attrs["n_strides"] >= 3


def test_gaps_at_the_ends_do_not_matter(person):
    broken = walking_through_a_room(person)
    broken.loc[{"marker": "head", "time": broken.time[:60]}] = np.nan
    broken.loc[{"marker": "left_wrist", "time": broken.time[-70:]}] = np.nan
    placed = in_place(broken)
    assert placed.attrs["filled_samples"] == 0
    assert placed.attrs["n_strides"] >= 3


def test_markers_never_seen_are_named(person):
    with pytest.raises(ValueError, match=r"head.*never seen"):
        in_place(person.where(person.marker != "head"))


def test_rotations_are_turned_with_the_walk(person):
    vectors = np.zeros(person.shape)
    vectors[..., 2] = np.deg2rad(70)
    capture = walking_through_a_room(person, heading_deg=70)
    capture = capture.assign_coords(rotation=(("time", "marker", "axis"), vectors))
    placed = in_place(capture)
    left = placed.rotation.values[..., 2]
    np.testing.assert_allclose(left, np.deg2rad(70 - placed.attrs["heading_deg"]), atol=1e-9)


def test_standing_feet_tell_the_speed_of_the_belt():
    shares = []
    for seed in range(5):
        walk = simulate_walk(seed=seed, duration_s=5)
        shares.append(stance_speed(walk) / walk.attrs["speed_mm_s"])
    assert 0.94 < min(shares) <= max(shares) < 1.0


def test_minutes_on_a_treadmill_give_strides_that_share_a_frequency():
    walk = simulate_walk(seed=1, duration_s=90, rate_hz=60, variability=1, wander_mm=25, noise_mm=1)
    placed = in_place(plain(walk))
    assert placed.attrs["n_strides"] >= 20
    assert r2(placed) > 0.94


@pytest.mark.parametrize(("name", "least"), [("cmu/02_01.c3d", 0.97), ("cmu/12_01.bvh", 0.94)])
@pytest.mark.filterwarnings("ignore")  # the unit is guessed, and read_mocap says so
def test_real_walks_keep_what_two_harmonics_explain(captures, name, least):
    placed = in_place(virtual_markers(read_mocap(captures / name)))
    assert r2(placed) >= least
    assert placed.attrs["n_strides"] >= 2


@pytest.mark.filterwarnings("ignore")  # the unit is guessed, and read_mocap says so
def test_the_steady_strides_of_acted_styles_are_found(captures):
    files = sorted((captures / "bandai-namco").glob("*.bvh"))[::9]
    found = [r2(in_place(virtual_markers(read_mocap(file)))) for file in files]
    assert np.median(found) >= 0.96
    assert min(found) > 0.88


def test_a_point_that_stays_in_the_room_is_no_part_of_the_body():
    walk = simulate_walk(seed=4, duration_s=5.0, truth=False)
    capture = walking_through_a_room(walk, heading_deg=30.0)
    origin = (0 * capture.isel(marker=[0])).assign_coords(marker=["origin"])
    found = in_place(xr.concat([origin, capture], "marker", combine_attrs="override"))
    expected = in_place(capture)
    assert found.attrs["still_points"] == ["origin"]
    assert found.attrs["speed_mm_s"] == pytest.approx(expected.attrs["speed_mm_s"])
    np.testing.assert_allclose(found.sel(marker=expected.marker), expected)


def test_a_joint_that_stays_where_the_body_stays_is_kept():
    walk = simulate_walk(seed=4, duration_s=5.0, truth=False)
    about = plain(walk - walk.sel(marker="pelvis"))
    assert "pelvis" in in_place(about).marker


def test_the_middle_of_large_swings_is_no_point_of_the_room():
    legs = [name for name in JOINTS.markers if name.endswith(("hip", "knee", "ankle"))]
    walk = simulate_walk(seed=4, duration_s=5.0, truth=False).sel(marker=["pelvis", *legs])
    swung = plain((walk - walk.sel(marker="pelvis")) * [3.0, 1.0, 1.0])
    assert "pelvis" in in_place(swung).marker
