"""Walks that turn, last one stride or minutes, come slow or fast: the same walker comes out."""

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.fourier import share_explained
from eigenwalker.core.kinematics import rotate_z
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.gait.filtering import low_passed
from eigenwalker.gait.in_place import in_place
from eigenwalker.gait.turning import slow_heading
from eigenwalker.quality.assessment import assess
from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.walk import simulate_walk

RATE_HZ = 60.0


def plain(walk):
    """Return a capture that knows nothing but its unit."""
    return xr.DataArray(
        walk.values,
        dims=walk.dims,
        coords={name: walk[name].values for name in walk.dims},
        attrs={"units": "mm"},
    )


def led(walk, heading):
    """Return a walk in place as it were along a path of this heading, in radians."""
    steps = np.stack([np.cos(heading), np.sin(heading), 0 * heading], axis=1)
    path = np.cumsum(steps * walk.attrs["speed_mm_s"] / sampling_rate(walk), axis=0)
    return plain(walk.copy(data=rotate_z(walk.values, heading) + path[:, None]))


def eased(time, start_s, duration_s=1.2):
    share = np.clip((time - start_s) / duration_s, 0, 1)
    return share**2 * (3 - 2 * share)


def about_its_mean(walk):
    posture = walk.values.mean(axis=0)
    return posture - posture.mean(axis=0)


def r2(walk):
    cycles = np.arange(len(walk)) * walk.attrs["frequency_hz"] / sampling_rate(walk)
    return share_explained(walk.values.reshape(len(walk), -1), cycles)


@pytest.fixture(scope="module")
def person():
    return simulate_walk(seed=3, duration_s=24, rate_hz=RATE_HZ, variability=1, noise_mm=1)


CURVES = {
    "a circle": lambda time: np.deg2rad(30) * time,
    "a wide bend": lambda time: np.deg2rad(4) * time,
    "a figure of eight": lambda time: np.deg2rad(220) * np.sin(2 * np.pi * time / 16),
    "a slalom": lambda time: np.deg2rad(40) * np.sin(2 * np.pi * time / 6),
}


@pytest.mark.parametrize("curve", CURVES)
def test_a_curved_walk_is_unwound(person, curve):
    heading = CURVES[curve](person.time.values)
    placed, straight = in_place(led(person, heading)), in_place(plain(person))
    assert placed.attrs["straight_passes"] == 0
    assert placed.attrs["unwound_deg"] == pytest.approx(np.rad2deg(np.ptp(heading)), abs=16)
    assert placed.attrs["n_strides"] >= straight.attrs["n_strides"] - 1
    assert r2(placed) > r2(straight) - 0.01
    assert np.abs(about_its_mean(placed) - about_its_mean(straight)).max() < 8
    assert placed.attrs["speed_mm_s"] == pytest.approx(person.attrs["speed_mm_s"], rel=0.01)
    assert placed.attrs["frequency_hz"] == pytest.approx(straight.attrs["frequency_hz"], rel=0.003)
    again = in_place(placed, heading_deg=0)
    np.testing.assert_allclose(again.values, placed.values, atol=1e-6)


@pytest.mark.parametrize(
    ("turns_s", "fewest"), [((14,), 10), ((5, 11, 17), 4), ((3, 7, 11, 15, 19), 2)]
)
def test_there_and_back_the_longest_straight_pass_is_taken(person, turns_s, fewest):
    time = person.time.values
    heading = np.pi * sum(eased(time, turn) for turn in turns_s)
    placed = in_place(led(person, heading))
    assert placed.attrs["straight_passes"] == len(turns_s) + 1
    assert placed.attrs["unwound_deg"] == 0
    assert placed.attrs["n_strides"] >= fewest
    assert r2(placed) > 0.98
    inside = (time >= placed.attrs["steady_start_s"]) & (time <= placed.attrs["steady_end_s"])
    assert np.ptp(heading[inside]) < np.deg2rad(3)
    assert placed.attrs["speed_mm_s"] == pytest.approx(person.attrs["speed_mm_s"], rel=0.01)
    again = in_place(placed, heading_deg=0)
    np.testing.assert_allclose(again.values, placed.values, atol=1e-6)


def test_a_simulated_person_who_goes_round_is_unwound():
    walk = simulate_walk(seed=3, duration_s=12, rate_hz=RATE_HZ, route=Route(turning_deg_s=30))
    quality = assess(plain(walk))
    assert quality.verdict == "use"
    assert quality.n_strides >= 10
    assert quality.unwound_deg == pytest.approx(330, abs=30)


def test_nothing_of_a_turning_walk_depends_on_where_it_begins(person):
    capture = led(person[:600], np.deg2rad(30) * person.time.values[:600])
    quarter = Rotation.from_euler("z", 90, degrees=True).as_matrix().T
    elsewhere = capture.copy(data=capture.values @ quarter + [5000, 0, 0])
    np.testing.assert_allclose(in_place(elsewhere).values, in_place(capture).values, atol=1e-6)
    mirrored = capture.copy(data=capture.values[:, JOINTS.mirror()] * [1, -1, 1])
    expected = in_place(capture).values[:, JOINTS.mirror()] * [1, -1, 1]
    np.testing.assert_allclose(in_place(mirrored).values, expected, atol=1e-6)


def test_markers_without_names_turn_too(person):
    capture = led(person, np.deg2rad(20) * person.time.values)
    anonymous = capture.assign_coords(marker=[f"*{number}" for number in range(15)])
    placed = in_place(anonymous)
    assert placed.attrs["n_strides"] >= in_place(capture).attrs["n_strides"] - 1
    again = in_place(placed, heading_deg=0)
    np.testing.assert_allclose(again.values, placed.values, atol=1e-6)


def test_a_straight_walk_has_no_slow_heading(person):
    assert not slow_heading(person.values, JOINTS.markers, RATE_HZ).any()
    assert in_place(plain(person)).attrs["straight_passes"] == 1


def test_rotations_are_unwound_with_the_walk(person):
    heading = np.deg2rad(30) * person.time.values[:600]
    vectors = np.zeros((600, 15, 3))
    vectors[..., 2] = (heading[:, None] + np.pi) % (2 * np.pi) - np.pi
    capture = led(person[:600], heading)
    capture = capture.assign_coords(rotation=(("time", "marker", "axis"), vectors))
    left = in_place(capture).rotation.values[..., 2]
    assert np.abs(left).max() < np.deg2rad(6)


@pytest.mark.parametrize("rate_hz", [25, 50, 120, 1000])
@pytest.mark.parametrize("start", [0.0, 0.3, 0.7])
def test_exactly_one_stride_is_enough(rate_hz, start):
    frames = round(rate_hz / 0.9)
    walk = simulate_walk(seed=2, duration_s=3, rate_hz=rate_hz, frequency_hz=rate_hz / frames)
    first = round(start * frames)
    once = plain(walk)[first : first + frames]
    placed = in_place(once)
    assert len(placed) == frames
    assert placed.attrs["frequency_hz"] == pytest.approx(rate_hz / frames)
    assert placed.attrs["n_strides"] == 1
    moved = placed.values - once.values
    assert np.abs(moved - moved.mean(axis=(0, 1))).max() < 1
    again = in_place(placed, heading_deg=0)
    np.testing.assert_allclose(again.values, placed.values, atol=1e-6)
    quality = assess(once)
    assert quality.verdict == "use with care"
    assert "one_stride" in quality.findings


def test_one_stride_through_a_room_keeps_its_speed():
    walk = simulate_walk(seed=2, duration_s=3, rate_hz=100, frequency_hz=100 / 111)
    through = led(walk, np.full(len(walk), 0.5))[40:151]
    placed = in_place(through)
    assert placed.attrs["speed_mm_s"] == pytest.approx(walk.attrs["speed_mm_s"], rel=0.01)
    assert placed.attrs["heading_deg"] == pytest.approx(np.rad2deg(0.5), abs=0.5)


@pytest.mark.parametrize(("rate_hz", "duration_s"), [(25, 20), (250, 10), (1000, 6)])
def test_slow_and_fast_cameras_see_the_same_walker(rate_hz, duration_s):
    seen = in_place(simulate_walk(seed=5, duration_s=duration_s, rate_hz=rate_hz))
    usual = in_place(simulate_walk(seed=5, duration_s=duration_s, rate_hz=120))
    assert np.abs(about_its_mean(seen) - about_its_mean(usual)).max() < 2
    assert r2(seen) == pytest.approx(r2(usual), abs=0.002)


def test_minutes_of_walking_can_be_used():
    walk = simulate_walk(
        seed=1, duration_s=240, rate_hz=50, variability=1, noise_mm=1, wander_mm=20, truth=False
    )
    quality = assess(plain(walk))
    assert quality.verdict == "use"
    assert quality.n_strides > 20


def test_a_low_pass_takes_noise_and_leaves_the_walk():
    clean = simulate_walk(seed=4, duration_s=8, rate_hz=100)
    noisy = simulate_walk(seed=4, duration_s=8, rate_hz=100, noise_mm=10)
    smooth = in_place(noisy, low_pass_hz=6)
    assert smooth.attrs["low_pass_hz"] == 6
    assert "low_pass_hz" not in in_place(noisy).attrs
    truth = clean.sel(time=smooth.time).values
    off = smooth.values - truth
    raw = noisy.sel(time=smooth.time).values - truth
    assert (off - off.mean(axis=(0, 1))).std() < 0.5 * raw.std()


def test_a_low_pass_shifts_nothing_and_leaves_gaps():
    time = np.arange(0, 5, 0.01)
    path = np.sin(2 * np.pi * 1.0 * time)[:, None, None] * [[100.0, 0, 0]]
    path[200:210] = np.nan
    smooth = low_passed(path, 100, 8.0)
    assert np.isnan(smooth[200:210]).all()
    np.testing.assert_allclose(smooth[50:150], path[50:150], atol=0.2)


@pytest.mark.parametrize("cut_off", [0, -1, 30, np.nan])
def test_a_cut_off_that_makes_no_sense_is_refused(person, cut_off):
    with pytest.raises(ValueError, match=r"below 30, for instance 6"):
        in_place(person, low_pass_hz=cut_off)
