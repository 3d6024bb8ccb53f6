"""The neutral mannequin: movements stay, bodies do not."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from sklearn.linear_model import LogisticRegression
from sklearn.model_selection import cross_val_score

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.gait.in_place import in_place
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.metric import (
    HEIGHT_MM,
    SHARES,
    angle_between,
    joint_quaternions,
    prepare_walk,
    retarget,
)
from eigenwalker.simulation.walk import simulate_walk

BONES = [
    *(("pelvis", "sternum"), ("sternum", "head")),
    *(
        (f"{s}_{a}", f"{s}_{b}")
        for s in ("left", "right")
        for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))
    ),
]


def lengths(walk: xr.DataArray) -> np.ndarray:
    """Mean lengths of all links and of hips and shoulders, in mm."""
    links = [*JOINTS.segments, ("left_hip", "right_hip"), ("left_shoulder", "right_shoulder")]
    ways = [walk.sel(marker=a).values - walk.sel(marker=b).values for a, b in links]
    return np.array([np.linalg.norm(way, axis=1).mean() for way in ways])


def with_other_bones(walk: xr.DataArray, seed: int) -> xr.DataArray:
    """Someone who moves alike in the directions of all bones, with other lengths and widths."""
    rng = np.random.default_rng(seed)
    at = {str(name): walk.sel(marker=name).values for name in walk.marker.values}
    new = {"pelvis": at["pelvis"]}
    for start, end in BONES[:2]:
        new[end] = new[start] + rng.uniform(0.8, 1.25) * (at[end] - at[start])
    middle = {"hip": "pelvis", "shoulder": "sternum"}
    for joint, centre in middle.items():
        across = (at[f"left_{joint}"] - at[f"right_{joint}"]) / 2
        off = (at[f"left_{joint}"] + at[f"right_{joint}"]) / 2 - at[centre]
        wide, away = rng.uniform(0.7, 1.4, 2)
        for side, sign in (("left", 1), ("right", -1)):
            new[f"{side}_{joint}"] = new[centre] + away * off + sign * wide * across
    for a, b in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")):
        longer = rng.uniform(0.8, 1.25)
        for side in ("left", "right"):
            way = at[f"{side}_{b}"] - at[f"{side}_{a}"]
            new[f"{side}_{b}"] = new[f"{side}_{a}"] + longer * way
    return walk.copy(data=np.stack([new[str(name)] for name in walk.marker.values], axis=1))


@pytest.fixture(scope="module")
def walk() -> xr.DataArray:
    return in_place(simulate_walk(seed=3, duration_s=5.0, rate_hz=60))


def test_all_bones_have_the_mannequin_s_lengths(walk):
    placed = retarget(walk)
    for (start, end), part in zip(
        BONES, ("spine", "neck", *("upper_arm", "forearm", "thigh", "calf") * 2), strict=True
    ):
        way = placed.sel(marker=end).values - placed.sel(marker=start).values
        np.testing.assert_allclose(np.linalg.norm(way, axis=1), HEIGHT_MM * SHARES[part])


def test_directions_of_limbs_are_kept(walk):
    placed = retarget(walk)
    for start, end in BONES:
        before, after = (
            c.sel(marker=end).values - c.sel(marker=start).values for c in (walk, placed)
        )
        scale = np.linalg.norm(after, axis=1) / np.linalg.norm(before, axis=1)
        np.testing.assert_allclose(after, before * scale[:, None], atol=1e-8)


def test_joint_angles_are_kept_and_clavicles_are_parts_of_the_build(walk):
    before, after = joint_quaternions(walk), joint_quaternions(retarget(walk))
    lost = set(before.joint.values.tolist()) - set(after.joint.values.tolist())
    assert lost == {"left_clavicle", "right_clavicle"}
    apart = angle_between(before.sel(joint=after.joint), after)
    assert np.rad2deg(apart).max() < 0.01


def test_feet_stand_on_the_ground(walk):
    placed = retarget(walk)
    ankles = placed.sel(marker=["left_ankle", "right_ankle"]).values[..., 2]
    lower, level = ankles.min(axis=1), HEIGHT_MM * SHARES["ankle_height"]
    assert abs(np.quantile(lower, 0.05) - level) < 10
    before = walk.sel(marker=["left_ankle", "right_ankle"]).values[..., 2].min(axis=1)
    assert np.corrcoef(lower, before)[0, 1] > 0.95


@settings(deadline=None, max_examples=15)
@given(st.floats(0.5, 2.0), st.integers(0, 100))
def test_size_alone_makes_no_difference(size, seed):
    walk = in_place(simulate_walk(seed=seed, duration_s=3.0, rate_hz=30))
    np.testing.assert_allclose(retarget(size * walk).values, retarget(walk).values, atol=1e-6)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_people_of_other_build_with_the_same_angles_become_the_same_clip(walk, seed):
    other = with_other_bones(walk, seed)
    assert np.abs(lengths(other) / lengths(walk) - 1).max() > 0.1
    same, mine = retarget(other), retarget(walk)
    pelvis = mine.marker.values.tolist().index("pelvis")
    about = [clip.values - clip.values[:, [pelvis]] for clip in (same, mine)]
    np.testing.assert_allclose(about[0], about[1], atol=1e-6)
    assert np.abs(same.values - mine.values).max() < 15  # heights of ankles depend on the legs


def test_who_it_was_cannot_be_told_from_bones_any_more():
    people = [
        in_place(simulate_walk(seed=seed, sex=sex, duration_s=3.0, rate_hz=30))
        for seed in range(10)
        for sex in ("female", "male")
    ]
    sex = np.arange(20) % 2
    before = np.stack([lengths(each) for each in people])
    after = np.stack([lengths(retarget(each)) for each in people])
    np.testing.assert_allclose(after, np.broadcast_to(after[0], after.shape), rtol=1e-9)

    def accuracy(bones: np.ndarray) -> float:
        standard = (bones - bones.mean(axis=0)) / (bones.std(axis=0) + 1e-6)
        return cross_val_score(LogisticRegression(), standard, sex, cv=5).mean()

    assert accuracy(before) > 0.8
    assert accuracy(after) == 0.5


def test_hands_and_feet_stay_where_they_were_captured():
    skin = prepare_walk(simulate_walk(seed=5, duration_s=4.0, rate_hz=60, markers="skin"))
    assert skin.marker.values.tolist()[15:] == ["left_hand", "right_hand", "left_toe", "right_toe"]
    assert skin.attrs["hidden_markers"] == []


def test_a_hand_hidden_throughout_is_left_out_and_said():
    capture = simulate_walk(seed=5, duration_s=4.0, rate_hz=60, markers="skin").copy(deep=True)
    capture.loc[{"marker": "LFIN"}][100:] = np.nan
    walk = prepare_walk(capture)
    assert walk.attrs["hidden_markers"] == ["left_hand"]
    assert "right_hand" in walk.marker


def test_what_was_not_seen_is_missing_from_there_outwards(walk):
    holed = walk.copy(deep=True)
    holed.loc[{"marker": "left_elbow"}][4] = np.nan
    placed = retarget(holed)
    missing = np.isnan(placed).any("axis")
    assert placed.marker.values[missing.values[4]].tolist() == ["left_elbow", "left_wrist"]
    assert not missing.values[5].any()


def test_missing_joints_are_named():
    with pytest.raises(ValueError, match=r"\['left_knee'\] are missing"):
        retarget(simulate_walk(seed=1, duration_s=1.0).drop_sel(marker=["left_knee"]))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("cmu/02_01.c3d", {}),
        ("cmu/12_01.bvh", {"unit": "asf"}),
        ("bandai-namco/dataset-2_walk_feminine_003.bvh", {"unit": "cm"}),
    ],
)
def test_captures_become_one_body(captures, name, options):
    capture = read_mocap(captures / name, **options)
    placed = prepare_walk(capture)
    usual = lengths(retarget(in_place(simulate_walk(seed=0, duration_s=3.0, rate_hz=30))))
    np.testing.assert_allclose(lengths(placed), usual, rtol=1e-6)
    ankles = placed.sel(marker=["left_ankle", "right_ankle"]).values[..., 2]
    assert abs(np.quantile(ankles.min(axis=1), 0.05) - HEIGHT_MM * SHARES["ankle_height"]) < 15
    assert virtual_markers(placed).marker.values.tolist() == list(JOINTS.markers)


def check_feet(placed: xr.DataArray) -> None:
    """Toes stand on the floor and do not go through it, whatever the build of the feet."""
    toes = placed.sel(marker=["left_toe", "right_toe"]).values[..., 2]
    level = HEIGHT_MM * SHARES["toe_height"]
    assert toes.min() > level - 15
    assert np.abs(np.quantile(toes, 0.2, axis=0) - level).max() < 10
    ankles = placed.sel(marker=["left_ankle", "right_ankle"]).values[..., 2]
    assert abs(ankles.min() - HEIGHT_MM * SHARES["ankle_height"]) < 10


def test_toes_stand_on_the_floor():
    check_feet(prepare_walk(simulate_walk(seed=5, duration_s=4.0, rate_hz=60, markers="skin")))


@pytest.mark.parametrize(
    "name", ["cmu/02_01.c3d", *(f"bandai-namco/dataset-2_walk_{s}.bvh" for s in ("active_001",))]
)
def test_toes_of_captures_stand_on_the_floor(captures, name):
    check_feet(prepare_walk(read_mocap(captures / name, unit="cm" if "bvh" in name else None)))


def test_feet_turn_as_the_walker_s_do():
    walk = in_place(
        virtual_markers(
            simulate_walk(seed=5, duration_s=4.0, rate_hz=60, markers="skin"), joints="full"
        )
    )
    ways = []
    for clip in (walk, retarget(walk)):
        way = clip.sel(marker="left_toe").values - clip.sel(marker="left_ankle").values
        ways.append(way / np.linalg.norm(way, axis=1, keepdims=True))
    turned = np.rad2deg(np.arccos((ways[0] * ways[1]).sum(axis=1)))
    free = retarget(walk).sel(marker="left_toe", axis="z").values > 60
    assert free.sum() > 20
    assert np.ptp(turned[free]) < 0.5
    assert 1 < turned[free].mean() < 20
    assert np.rad2deg(np.arcsin(np.ptp(ways[1][:, 2]) / 2)) > 20


def test_a_toe_that_is_hidden_for_moments_moves_nothing_else():
    walk = in_place(
        virtual_markers(
            simulate_walk(seed=5, duration_s=4.0, rate_hz=60, markers="skin"), joints="full"
        )
    )
    holed = walk.copy(deep=True)
    holed.loc[{"marker": "left_toe"}][50:53] = np.nan
    moved = np.abs(retarget(holed) - retarget(walk)).drop_sel(marker="left_toe")
    assert float(moved.max()) == 0


def test_the_mannequin_rises_and_falls_as_smoothly_as_the_walker():
    walk = prepare_walk(
        simulate_walk(seed=5, duration_s=6.0, rate_hz=60, markers="skin"), mannequin=False
    )
    placed = retarget(walk)
    heights = [clip.sel(marker="pelvis", axis="z").values for clip in (walk, placed)]
    assert np.corrcoef(*heights)[0, 1] > 0.6
    fastest = [np.abs(np.gradient(height)).max() for height in heights]
    assert fastest[1] < 1.6 * fastest[0]
    bare = retarget(walk.drop_sel(marker=["left_toe", "right_toe"]))
    np.testing.assert_allclose(placed.sel(marker=bare.marker), bare)


@pytest.mark.parametrize("n_frames", [1, 2, 5])
def test_a_few_frames_can_be_shown_too(walk, n_frames):
    assert np.isfinite(retarget(walk.isel(time=slice(n_frames)))).all()
