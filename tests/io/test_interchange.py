"""To and from other packages: against their documented layouts, and against them if installed."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import eigenwalker as ew
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.interchange import from_movement, from_pyomeca, to_movement, to_pyomeca

NAMES = ["head", "left_ankle"]


@pytest.fixture
def walk() -> xr.DataArray:
    values = np.random.default_rng(0).normal(scale=500, size=(5, 2, 3))
    values[2, 1] = np.nan
    return ew.label_trajectories(values, markers=NAMES, rate_hz=120, start_s=0.5)


def _poses(**attrs: object) -> xr.Dataset:
    """A poses dataset as the documentation of movement lays it out, of two people, in metres."""
    position = np.arange(4 * 3 * 2 * 2, dtype=float).reshape(4, 3, 2, 2)
    return xr.Dataset(
        {
            "position": (("time", "space", "keypoints", "individuals"), position),
            "confidence": (("time", "keypoints", "individuals"), np.full((4, 2, 2), 0.9)),
        },
        coords={
            "time": np.arange(4) / 50,
            "space": ["x", "y", "z"],
            "keypoints": NAMES,
            "individuals": ["anna", "bo"],
        },
        attrs={
            "fps": 50.0,
            "time_unit": "seconds",
            "source_software": "Anipose",
            "ds_type": "poses",
            **attrs,
        },
    )


def test_what_goes_to_movement_comes_back(walk):
    again = from_movement(to_movement(walk))
    xr.testing.assert_identical(again.drop_attrs(), walk.drop_attrs())


def test_what_goes_to_pyomeca_comes_back(walk):
    again = from_pyomeca(to_pyomeca(walk))
    xr.testing.assert_identical(again.drop_attrs(), walk.drop_attrs())


def test_a_dataset_of_movement_gives_the_person_asked_for():
    poses = _poses()
    walk = from_movement(poses, individual="bo", unit="m")
    np.testing.assert_array_equal(walk.sel(marker="head").values[0], [1000, 5000, 9000])
    assert (walk.attrs["units"], sampling_rate(walk)) == ("mm", pytest.approx(50))
    np.testing.assert_array_equal(walk["confidence"], np.full((4, 2), 0.9))
    back = to_movement(walk, individual="bo")
    np.testing.assert_allclose(back["position"][..., 0], 1000 * poses["position"][..., 1])
    np.testing.assert_array_equal(back["confidence"][..., 0], poses["confidence"][..., 1])


def test_dims_in_the_singular_are_understood():
    poses = _poses().rename(keypoints="keypoint", individuals="individual")
    xr.testing.assert_equal(
        from_movement(poses, individual="anna", unit="m"),
        from_movement(_poses(), individual="anna", unit="m"),
    )


def test_time_in_frames_needs_a_rate():
    poses = _poses(time_unit="frames", fps=None).assign_coords(time=np.arange(4))
    with pytest.raises(ValueError, match="rate_hz"):
        from_movement(poses, individual="bo", unit="m")
    walk = from_movement(poses, individual="bo", unit="m", rate_hz=25)
    np.testing.assert_allclose(walk.time, [0, 0.04, 0.08, 0.12])


def test_cameras_that_look_along_z_are_turned_upright():
    poses = _poses().isel(individuals=[0])
    walk = from_movement(poses, unit="mm", up="-y")
    down = poses["position"].values[:, 1, :, 0]
    np.testing.assert_array_equal(walk.sel(axis="z").values, -down)


@pytest.mark.parametrize(
    ("poses", "options", "told"),
    [
        (_poses(), {"unit": "m"}, r"one of \['anna', 'bo'\]"),
        (_poses(), {"individual": "cy", "unit": "m"}, "'cy'"),
        (_poses(), {"individual": "bo"}, "unit="),
        (_poses(), {"individual": "bo", "unit": "px"}, "'px'"),
        (_poses(), {"individual": "bo", "unit": "m", "up": "w"}, "up='w'"),
        (_poses().isel(space=slice(2)), {"individual": "bo"}, "triangulate"),
        (_poses().rename(keypoints="points"), {"individual": "bo"}, "keypoints"),
    ],
)
def test_what_a_dataset_leaves_open_is_asked_for(poses, options, told):
    with pytest.raises(ValueError, match=told):
        from_movement(poses, **options)


def test_other_things_are_refused(walk):
    with pytest.raises(TypeError, match="poses dataset"):
        from_movement(walk)
    with pytest.raises(TypeError, match="pyomeca"):
        from_pyomeca(walk)
    with pytest.raises(ValueError, match="5 axes"):
        from_pyomeca(xr.DataArray(np.zeros((5, 2, 3)), dims=("axis", "channel", "time")))


def test_markers_without_names_ones_or_times_are_understood():
    markers = xr.DataArray(np.ones((3, 2, 4)), dims=("axis", "channel", "time"))
    markers.attrs = {"rate": 200.0, "units": "cm"}
    walk = from_pyomeca(markers, up="y")
    assert walk.marker.values.tolist() == ["channel_0", "channel_1"]
    assert (walk.values == 10).all()
    np.testing.assert_allclose(walk.time, [0, 0.005, 0.01, 0.015])


# ---------------------------------------------------------------- the packages themselves


@pytest.mark.filterwarnings("default")
def test_movement_takes_what_we_give_and_we_what_it_gives(walk):
    load_poses = pytest.importorskip("movement.io").load_poses
    from movement.validators.datasets import ValidPosesInputs

    ours = to_movement(walk)
    ValidPosesInputs.validate(ours)
    theirs = load_poses.from_numpy(
        position_array=ours["position"].values,
        confidence_array=ours["confidence"].values,
        individual_names=["walker"],
        keypoint_names=NAMES,
        fps=120,
        source_software="eigenwalker",
    )
    assert theirs["position"].dims == ours["position"].dims
    assert theirs["confidence"].dims == ours["confidence"].dims
    assert {*theirs.attrs} <= {*ours.attrs}
    assert {theirs.attrs[name] == ours.attrs[name] for name in theirs.attrs} == {True}
    again = from_movement(theirs, unit="mm")
    np.testing.assert_array_equal(again.values, walk.values)
    from movement.kinematics import compute_velocity

    velocity = compute_velocity(ours["position"])
    assert velocity.shape == ours["position"].shape


@pytest.mark.filterwarnings("default")
def test_pyomeca_takes_what_we_give_and_we_what_it_gives(walk, tmp_path):
    pyomeca = pytest.importorskip("pyomeca")
    ours = to_pyomeca(walk)
    theirs = pyomeca.Markers(walk.values.transpose(2, 1, 0), channels=NAMES, time=walk.time.values)
    xr.testing.assert_equal(ours, theirs)
    assert ours.meca.norm(dim="axis").shape == (2, 5)
    from eigenwalker.io.write import write_mocap

    read = pyomeca.Markers.from_c3d(write_mocap(walk, tmp_path / "walk.c3d"))
    assert {name: read.attrs[name] for name in ours.attrs} == ours.attrs
    again = from_pyomeca(read)
    np.testing.assert_allclose(again.values, walk.values, atol=1e-3)
    path = write_mocap(walk, tmp_path / "walk.trc", up="z")
    read = pyomeca.Markers.from_trc(path, pandas_kwargs={"sep": "\t"})
    assert read.channel.values.tolist() == NAMES
    np.testing.assert_allclose(read.values[:3], ours.values[:3], atol=1e-4)
