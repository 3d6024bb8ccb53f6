from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings, strategies as st
from scipy.spatial.transform import Rotation

import eigenwalker as ew
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.joint_centres import MARKER_RADIUS_MM, Pelvis, davis
from eigenwalker.markers.virtual_markers import virtual_markers

LEFT, UP = np.array([0.0, 1, 0]), np.array([0.0, 0, 1])
WIDTHS = {"knee": 100.0, "ankle": 70.0, "elbow": 66.0}


def _at(*xyz: float) -> np.ndarray:
    return np.array(xyz, dtype=float)


def _truth(n_frames: int = 9) -> dict[str, np.ndarray]:
    """Return the joints of somebody who stands with bent knees and elbows, and moves forward."""
    forward, outward, up = davis(Pelvis(UP, UP, 240, 150), 900)
    joints = {"pelvis": [-75.0, 0, 1000], "hip": [forward, outward, 1000 + up]}
    joints |= {"knee": [60.0, 95, 500], "ankle": [-60.0, 90, 90]}
    joints |= {"shoulder": [-20.0, 170, 1400], "elbow": [-60.0, 200, 1130], "wrist": [60, 210, 900]}
    joints |= {"head": [0.0, 0, 1650], "sternum": [-10.0, 0, 1380]}
    steps = 12.0 * np.arange(n_frames)[:, None] * [1, 0, 0]
    both: dict[str, np.ndarray] = {}
    for name, place in joints.items():
        if place[1]:
            both[f"left_{name}"] = place + steps
            both[f"right_{name}"] = place * np.array([1, -1, 1]) + steps
        else:
            both[name] = place + steps
    return both


def _beside(joint: np.ndarray, above: np.ndarray, width: float, towards: np.ndarray) -> np.ndarray:
    """Return a marker at the side of a hinge, at right angles to the segment above it."""
    segment = above - joint
    segment /= np.linalg.norm(segment, axis=1, keepdims=True)
    side = towards - (segment * towards).sum(axis=1, keepdims=True) * segment
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    return joint + side * (width / 2 + MARKER_RADIUS_MM)


def _capture(n_frames: int = 9) -> xr.DataArray:
    """Return Plug-in Gait markers on the body of `_truth`."""
    joints = _truth(n_frames)
    root = joints["pelvis"] + [75, 0, 0]
    markers = {"C7": joints["sternum"] + [-60, 0, 60], "T10": joints["sternum"] + [-120, 0, -60]}
    markers |= {"CLAV": joints["sternum"] + [90, 0, 0], "STRN": joints["sternum"] + [110, 0, -120]}
    for side, sign in (("left", 1), ("right", -1)):
        out, s = sign * LEFT, side[0].upper()
        markers[f"{s}ASI"] = root + 120 * out
        markers[f"{s}PSI"] = root + [-150, 0, 0] + 50 * out
        markers[f"{s}FHD"] = joints["head"] + [80, 0, 0] + 70 * out
        markers[f"{s}BHD"] = joints["head"] + [-80, 0, 0] + 70 * out
        knee, ankle, hip = (joints[f"{side}_{part}"] for part in ("knee", "ankle", "hip"))
        markers[f"{s}KNE"] = _beside(knee, hip, WIDTHS["knee"], out)
        markers[f"{s}ANK"] = _beside(ankle, knee, WIDTHS["ankle"], markers[f"{s}KNE"] - knee)
        markers[f"{s}THI"] = (hip + knee) / 2 + 90 * out
        markers[f"{s}TIB"] = (knee + ankle) / 2 + 70 * (markers[f"{s}KNE"] - knee) / 57
        markers[f"{s}TOE"], markers[f"{s}HEE"] = ankle + _at(150, 0, -60), ankle + _at(-60, 0, -50)
        shoulder, elbow, wrist = (
            joints[f"{side}_{part}"] for part in ("shoulder", "elbow", "wrist")
        )
        markers[f"{s}SHO"] = shoulder + 0.050 * 900 * UP + 24 * out
        axis = np.cross(elbow - shoulder, wrist - elbow) * -sign
        markers[f"{s}ELB"] = _beside(elbow, shoulder, WIDTHS["elbow"], axis)
        markers[f"{s}WRA"] = wrist + _at(0, 0, 30)
        markers[f"{s}WRB"] = wrist - _at(0, 0, 30)
        markers[f"{s}FIN"] = wrist + _at(20, 0, -90)
    names = sorted(markers)
    values = np.stack([markers[name] for name in names], axis=1)
    capture = ew.label_trajectories(values, markers=names, rate_hz=100)
    return capture.assign_coords(left_leg_length_mm=900.0, right_leg_length_mm=900.0)


def _distance(joints: xr.DataArray, truth: dict[str, np.ndarray], name: str) -> float:
    return float(np.linalg.norm(joints.sel(marker=name).values - truth[name], axis=1).max())


def test_joints_come_out_where_they_were_put():
    joints = virtual_markers(_capture(), widths_mm=WIDTHS)
    assert joints.marker.values.tolist() == list(JOINTS.markers)
    assert joints.attrs["marker_set"] == "Plug-in Gait"
    truth = _truth()
    for name in ("pelvis", "head", "sternum", "left_hip", "right_hip", "left_wrist"):
        assert _distance(joints, truth, name) < 1e-6, name
    for name in ("left_knee", "right_knee", "left_ankle", "right_ankle"):
        assert _distance(joints, truth, name) < 2, name
    for name in ("left_shoulder", "right_shoulder", "left_elbow", "right_elbow"):
        assert _distance(joints, truth, name) < 20, name
    assert not {"left_knee", "head", "left_wrist"} & set(joints.attrs["approximate"])


def test_inner_markers_are_better_than_any_width():
    capture, truth = _capture(), _truth()
    inner = 2 * truth["left_knee"] - capture.sel(marker="LKNE").values
    named = ew.label_trajectories(inner[:, None], markers=["LKNM"], rate_hz=100)
    joints = virtual_markers(xr.concat([capture, named], "marker"), widths_mm={"knee": 20})
    assert _distance(joints, truth, "left_knee") < 1e-6
    assert _distance(joints, truth, "right_knee") > 20


@settings(max_examples=20, deadline=None)
@given(st.floats(-180, 180), st.floats(-3000, 3000))
def test_facing_and_place_do_not_matter(heading, shift):
    turn = Rotation.from_euler("z", heading, degrees=True)

    def moved(walk: xr.DataArray) -> xr.DataArray:
        values = turn.apply(walk.values.reshape(-1, 3)).reshape(walk.shape)
        return walk.copy(data=values + _at(shift, -shift, 0))

    capture = _capture(3)
    np.testing.assert_allclose(
        virtual_markers(moved(capture)).values, moved(virtual_markers(capture)).values, atol=1e-6
    )


def test_a_mirrored_capture_gives_the_mirrored_joints():
    capture = _capture()
    swap = {"L": "R", "R": "L"}
    names = [swap.get(name[0], name[0]) + name[1:] for name in capture.marker.values]
    mirrored = (capture * [1, -1, 1]).assign_coords(marker=names)
    mirrored.attrs = capture.attrs
    expected = virtual_markers(capture)[:, list(JOINTS.mirror())].values * [1, -1, 1]
    np.testing.assert_allclose(virtual_markers(mirrored).values, expected, atol=1e-9)


@pytest.mark.parametrize("prefix", ["Anna:", "Subject 1:", "anna_", ""])
def test_spelling_does_not_matter(prefix):
    capture = _capture()
    names = [f"{prefix}{name.lower()}" for name in capture.marker.values]
    renamed = capture.assign_coords(marker=names)
    np.testing.assert_array_equal(virtual_markers(renamed).values, virtual_markers(capture).values)


@pytest.mark.parametrize(
    ("gone", "joint", "within"),
    [
        ("LFHD", "head", 1e-6),
        ("LPSI", "pelvis", 1e-6),
        ("LASI", "pelvis", 1e-6),
        ("RASI", "right_hip", 1e-6),
        ("T10", "sternum", 30),
        ("CLAV", "sternum", 30),
        ("LTHI", "left_knee", 5),
        ("LTIB", "left_ankle", 5),
        ("LWRB", "left_wrist", 31),
        ("STRN", "sternum", 1e-6),
    ],
)
def test_one_marker_may_be_missing_altogether(gone, joint, within):
    capture = _capture()
    rest = capture.sel(marker=capture.marker != gone)
    never_seen = capture.where(capture.marker != gone)
    for lacking in (rest, never_seen):
        joints = virtual_markers(lacking, widths_mm=WIDTHS)
        assert _distance(joints, _truth(), joint) <= within
        assert np.isfinite(joints.values).all()


def test_a_sacrum_stands_for_the_back_of_the_pelvis():
    capture = _capture()
    back = capture.sel(marker=["LPSI", "RPSI"]).mean("marker").expand_dims(marker=["SACR"])
    rest = capture.sel(marker=~capture.marker.isin(["LPSI", "RPSI"]))
    joints = virtual_markers(xr.concat([rest, back], "marker").transpose("time", "marker", "axis"))
    assert _distance(joints, _truth(), "left_hip") < 20


@pytest.mark.parametrize(
    ("gone", "missing"),
    [
        ("LKNE", {"left_knee"}),
        ("LTHI", set()),
        ("LASI", set()),
        ("LFHD", set()),
        ("LWRA", set()),
        ("T10", set()),
        ("LSHO", {"left_shoulder"}),
    ],
)
def test_joints_are_missing_only_where_they_must_be(gone, missing):
    capture = _capture()
    capture.loc[{"marker": gone}][3:5] = np.nan
    joints = virtual_markers(capture, widths_mm=WIDTHS)
    lacking = np.isnan(joints.values).any(axis=2)
    assert {str(name) for name in joints.marker.values[lacking.any(axis=0)]} == missing
    assert not lacking[[0, 1, 2, 5, 6, 7, 8]].any()
    whole = virtual_markers(_capture(), widths_mm=WIDTHS).values
    np.testing.assert_allclose(joints.values[~lacking], whole[~lacking], atol=1e-6)


def test_full_keeps_feet_and_hands():
    joints = virtual_markers(_capture(), joints="full")
    assert joints.marker.values.tolist()[:15] == list(JOINTS.markers)
    assert {"left_toe", "right_heel", "left_hand"} <= set(joints.marker.values)


def test_a_mapping_of_ones_own_is_enough():
    rng = np.random.default_rng(0)
    names = [f"p{number}" for number in range(30)]
    capture = ew.label_trajectories(rng.normal(size=(4, 30, 3)), markers=names, rate_hz=50)
    mapping = {joint: [f"p{2 * i}", f"p{2 * i + 1}"] for i, joint in enumerate(JOINTS.markers)}
    joints = virtual_markers(capture, mapping=mapping | {"head": "p7"})
    np.testing.assert_array_equal(joints.sel(marker="head"), capture.sel(marker="p7"))
    middle = capture.sel(marker=["p20", "p21"]).mean("marker")
    np.testing.assert_allclose(joints.sel(marker=JOINTS.markers[10]), middle)
    assert joints.attrs["marker_set"] == "own mapping"


def test_a_mapping_may_mend_a_known_set():
    capture = _capture().assign_coords(
        marker=[{"LKNE": "odd"}.get(name, name) for name in _capture().marker.values]
    )
    with pytest.raises(ValueError, match="left_knee"):
        virtual_markers(capture)
    joints = virtual_markers(capture, mapping={"left_knee": "odd", "left_ankle": ["LANK"]})
    np.testing.assert_array_equal(joints.sel(marker="left_knee"), capture.sel(marker="odd"))
    assert joints.attrs["marker_set"] == "Plug-in Gait, with own mapping"


def test_a_set_without_arms_is_refused_with_what_is_missing():
    capture = _capture()
    arms = ("SHO", "ELB", "WRA", "WRB", "FIN")
    legs = capture.sel(marker=[n for n in capture.marker.values if not n.endswith(arms)])
    with pytest.raises(ValueError, match="left_shoulder") as refusal:
        virtual_markers(legs)
    told = str(refusal.value)
    assert "'left_elbow', 'left_wrist', 'right_shoulder'" in told
    assert "left_knee" not in told.partition("Tell which")[0]
    assert "virtual_markers(..., mapping='names.toml')" in told


def test_a_capture_of_two_people_is_refused():
    capture = _capture()
    names = [f"{who}:{name}" for who in ("Anna", "Ben") for name in capture.marker.values]
    both = ew.label_trajectories(np.tile(capture.values, (1, 2, 1)), markers=names, rate_hz=100)
    with pytest.raises(ValueError, match=r"\['Anna', 'Ben'\]"):
        virtual_markers(both)


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"joints": "all"}, "joints='all'"),
        ({"hip_regression": "guess"}, "hip_regression='guess'"),
        ({"marker_set": "mine"}, "marker_set='mine'"),
        ({"widths_mm": {"nose": 30}}, "nose"),
        ({"widths_mm": {"knee": -1}}, "knee"),
        ({"mapping": {"head": "NOSE"}}, "NOSE"),
        ({"mapping": {"head": []}}, "names no marker"),
    ],
)
def test_wrong_arguments_are_told(wrong, told):
    with pytest.raises(ValueError, match=told):
        virtual_markers(_capture(), **wrong)


SKELETONS = {
    "Mixamo": (
        "mixamorig:",
        "Hips Spine Neck Head HeadTop_End LeftShoulder LeftArm LeftForeArm LeftHand "
        "LeftUpLeg LeftLeg LeftFoot LeftToeBase",
    ),
    "Xsens": (
        "",
        "Hips Chest Chest4 Neck Head LeftCollar LeftShoulder LeftElbow LeftWrist LeftHip "
        "LeftKnee LeftAnkle LeftToe",
    ),
    "Rokoko": (
        "",
        "Hips Spine Neck Head LeftShoulder LeftArm LeftForeArm LeftHand LeftThigh LeftShin "
        "LeftFoot",
    ),
    "MotionBuilder": (
        "Character1_",
        "Hips Spine Neck Head LeftShoulder LeftArm LeftForeArm LeftHand LeftUpLeg LeftLeg LeftFoot",
    ),
    "Biped": (
        "Bip01 ",
        "Pelvis Spine Neck Head L-Clavicle L-UpperArm L-Forearm L-Hand L-Thigh L-Calf L-Foot",
    ),
    "Bandai Namco": (
        "",
        "Hips Spine Chest Neck Head Shoulder_L UpperArm_L LowerArm_L Hand_L UpperLeg_L LowerLeg_L "
        "Foot_L",
    ),
    "Rigify": (
        "DEF-",
        "spine spine.006 shoulder.L upper_arm.L forearm.L hand.L thigh.L shin.L foot.L",
    ),
    "SMPL": (
        "",
        "Pelvis Neck Head L_Collar L_Shoulder L_Elbow L_Wrist L_Hip L_Knee L_Ankle L_Foot",
    ),
    "Unreal": (
        "",
        "pelvis neck_01 head clavicle_l upperarm_l lowerarm_l hand_l thigh_l calf_l foot_l",
    ),
    "Poser": ("", "hip chest neck head lCollar lShldr lForeArm lHand lThigh lShin lFoot"),
    "Kinect": (
        "",
        "SpineBase Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft HipLeft KneeLeft AnkleLeft",
    ),
}
PARTS = ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")


@pytest.mark.parametrize("name", SKELETONS)
def test_common_skeletons_are_known(name):
    prefix, text = SKELETONS[name]
    swaps = (
        ("Left", "Right"),
        ("L-", "R-"),
        ("L_", "R_"),
        ("_L", "_R"),
        (".L", ".R"),
        ("_l", "_r"),
    )
    names: list[str] = []
    for bone in text.split():
        names.append(bone)
        swap = next((pair for pair in swaps if pair[0] in bone), None)
        if swap:
            names.append(bone.replace(*swap))
        elif bone[0] == "l" and bone[1].isupper():
            names.append("r" + bone[1:])
    markers = [prefix + bone for bone in names]
    values = np.arange(len(markers))[None, :, None] * np.ones(3)
    capture = ew.label_trajectories(values, markers=markers, rate_hz=1)
    joints = virtual_markers(capture)
    for part in PARTS:
        left_one, right_one = (
            markers[int(joints.sel(marker=f"{side}_{part}").values[0, 0])]
            for side in ("left", "right")
        )
        assert left_one != right_one
        assert markers.index(right_one) == markers.index(left_one) + 1
    order = [float(joints.sel(marker=f"left_{part}").values[0, 0]) for part in PARTS]
    assert order[0] < order[1] < order[2]
    assert order[3] < order[4] < order[5]


def test_the_15_joints_stay_as_they_are():
    values = np.random.default_rng(0).normal(size=(3, 15, 3))
    capture = ew.label_trajectories(values, markers=JOINTS.markers[::-1], rate_hz=30)
    np.testing.assert_array_equal(virtual_markers(capture).values, values[:, ::-1])


def _bone_lengths(joints: xr.DataArray) -> dict[tuple[str, str], np.ndarray]:
    return {
        (a, b): np.linalg.norm(joints.sel(marker=a).values - joints.sel(marker=b).values, axis=1)
        for a, b in JOINTS.segments
    }


def test_joints_on_the_stairs_agree_with_plug_in_gait(captures: Path):
    capture = read_mocap(captures / "pycgm" / "Movement_trial.c3d")
    table = np.genfromtxt(
        captures / "pycgm" / "Movement_trial.csv", delimiter=",", skip_header=5, encoding="utf-8"
    )
    header = (captures / "pycgm" / "Movement_trial.csv").read_text().splitlines()[2].split(",")
    joints = virtual_markers(capture)
    assert joints.attrs["marker_set"] == "Plug-in Gait"
    for side in ("left", "right"):
        for part, segment in (("knee", "FE"), ("ankle", "TI")):
            first = header.index(f"Test:{side[0].upper()}{segment}") + 3  # RX RY RZ, then TX TY TZ
            away = joints.sel(marker=f"{side}_{part}").values - table[:, first : first + 3]
            assert np.linalg.norm(away, axis=1).mean() < 2, (side, part)
        hip = capture.sel(marker=f"{side[0].upper()}FEP").values
        away = joints.sel(marker=f"{side}_hip").values - hip
        assert np.linalg.norm(away, axis=1).mean() < 5


def test_joints_on_the_stairs_need_no_measured_widths(captures: Path):
    capture = read_mocap(captures / "pycgm" / "Movement_trial.c3d")
    measured = virtual_markers(capture)
    assert virtual_markers(capture.drop_attrs()).equals(measured)
    guessed = virtual_markers(capture.reset_coords(drop=True))
    away = np.linalg.norm((guessed - measured).values, axis=2).mean(axis=0)
    assert away.max() < 30
    assert {"left_knee", "right_ankle"} <= set(guessed.attrs["approximate"])


def test_the_41_markers_of_cmu_make_a_body(captures: Path):
    joints = virtual_markers(read_mocap(captures / "cmu" / "02_01.c3d"))
    assert joints.attrs["marker_set"] == "CMU 41 markers"
    lengths = _bone_lengths(joints)
    assert max(length.std() for length in lengths.values()) < 8
    means = {bone: length.mean() for bone, length in lengths.items()}
    for (a, b), mean in means.items():
        if a.startswith("left"):
            other = means[a.replace("left", "right"), b.replace("left", "right")]
            assert abs(mean - other) < 15, (a, b)
    assert means["left_hip", "left_knee"] == pytest.approx(430, abs=25)
    assert means["left_knee", "left_ankle"] == pytest.approx(410, abs=25)


@pytest.mark.filterwarnings("ignore::eigenwalker.io.UnitGuessed")
def test_skeletons_of_real_captures_have_rigid_bones(captures: Path):
    for name in ("cmu/12_01.bvh", "bandai-namco/dataset-2_walk_active_001.bvh"):
        joints = virtual_markers(read_mocap(captures / name))
        limbs = {
            bone: length
            for bone, length in _bone_lengths(joints).items()
            if bone[0].startswith(("left", "right"))
        }
        assert len(limbs) == 8
        assert max(length.std() for length in limbs.values()) < 0.01
