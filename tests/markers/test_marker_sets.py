"""One simulated body under the names that other marker sets give its landmarks."""

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.markers.label_repair import Rebuilt
from eigenwalker.markers.virtual_markers import virtual_markers

PLUG_IN_GAIT = ["C7", "T10", "CLAV", "STRN"]
BOTH = [
    "FHD",
    "BHD",
    "SHO",
    "ELB",
    "WRA",
    "WRB",
    "ASI",
    "PSI",
    "THI",
    "KNE",
    "TIB",
    "ANK",
    "HEE",
    "TOE",
]

LOWER = {"KNE_IN": "knee", "ANK_IN": "ankle", "ELB_IN": "elbow"}

SETS = {
    # name of the set: names of Plug-in Gait's landmarks in it; # stands for the side
    "Helen Hayes": (
        "CLAV=Sternum SHO=#.Shoulder ELB=#.Elbow WRI=#.Wrist ASI=#.ASIS SACR=V.Sacral "
        "THI=#.Thigh KNE=#.Knee TIB=#.Shank ANK=#.Ankle HEE=#.Heel TOE=#.Toe "
        "HEAD_FRONT=Front.Head HEAD_BACK=Rear.Head HEAD_TOP=Top.Head"
    ),
    "OpenSim gait2392": (
        "CLAV=Sternum SHO=#.Acromium ELB=#.Elbow WRA=#.Wrist.Lat WRB=#.Wrist.Med ASI=#.ASIS "
        "SACR=V.Sacral THI=#.Thigh.Upper KNE=#.Knee.Lat KNE_IN=#.Knee.Med TIB=#.Shank.Upper "
        "ANK=#.Ankle.Lat ANK_IN=#.Ankle.Med HEE=#.Heel TOE=#.Toe.Tip HEAD_TOP=Top.Head"
    ),
    "OpenSim Rajagopal": (
        "C7=C7 CLAV=CLAV SHO=#ACR ELB=#LEL ELB_IN=#MEL WRA=#FAradius WRB=#FAulna ASI=#ASI "
        "PSI=#PSI THI=#TH1 KNE=#LFC KNE_IN=#MFC TIB=#TB1 ANK=#LMAL ANK_IN=#MMAL HEE=#CAL TOE=#TOE"
    ),
    "Xsens MVN points": (
        "C7=pC7SpinalProcess T10=pT8SpinalProcess CLAV=pIJ STRN=pPX SHO=p##Acromion "
        "ELB=p##ArmLatEpicondyle ELB_IN=p##ArmMedEpicondyle WRA=p##RadialStyloid "
        "WRB=p##UlnarStyloid ASI=p##ASI SACR=pSacrum KNE=p##KneeLatEpicondyle "
        "KNE_IN=p##KneeMedEpicondyle ANK=p##LatMalleolus ANK_IN=p##MedMalleolus HEE=p##HeelFoot "
        "TOE=p##Toe EAR=p##Auricularis HEAD_TOP=pTopOfHead"
    ),
    "van Sint Jan landmarks": (  # as Qualisys' Sports set has them
        "C7=CV7 CLAV=SJN STRN=SXS SHO=#_SAE ELB=#_HLE ELB_IN=#_HME WRA=#_RSP WRB=#_USP ASI=#_IAS "
        "PSI=#_IPS KNE=#_FLE KNE_IN=#_FME ANK=#_FAL ANK_IN=#_TAM HEE=#_FCC TOE=#_FM2 "
        "EAR=#_HEAD HEAD_FRONT=SGL"
    ),
    "OptiTrack and Qualisys": (  # as Qualisys' Animation set has them
        "C7=SpineTop CLAV=Chest SHO=#ShoulderTop ELB=#ElbowOut WRA=#WristOut WRB=#WristIn "
        "ASI=Waist#Front SACR=WaistBack THI=#Thigh KNE=#KneeOut ANK=#AnkleOut HEE=#HeelBack "
        "TOE=#ToeTip EAR=Head# HEAD_TOP=HeadTop HEAD_FRONT=HeadFront"
    ),
}


@pytest.fixture(scope="module")
def body():
    """A walk of 1.5 s: its true joints, and landmarks on the skin by Plug-in Gait's names."""
    told = {"seed": 6, "duration_s": 1.5, "rate_hz": 50}
    joints = ew.simulate_walk(**told)
    skin = ew.simulate_walk(**told, markers="skin", soft_tissue=0)
    points = {name: skin.sel(marker=name).values for name in skin.marker.values.tolist()}
    for side in "LR":
        word = {"L": "left", "R": "right"}[side]
        for inner, joint in LOWER.items():
            centre = joints.sel(marker=f"{word}_{joint}").values
            points[side + inner] = 2 * centre - points[side + inner.removesuffix("_IN")]
        points[f"{side}WRI"] = (points[f"{side}WRA"] + points[f"{side}WRB"]) / 2
        points[f"{side}EAR"] = (points[f"{side}FHD"] + points[f"{side}BHD"]) / 2
    points["SACR"] = (points["LPSI"] + points["RPSI"]) / 2
    points["HEAD_FRONT"] = (points["LFHD"] + points["RFHD"]) / 2
    points["HEAD_BACK"] = (points["LBHD"] + points["RBHD"]) / 2
    points["HEAD_TOP"] = (points["HEAD_FRONT"] + points["HEAD_BACK"]) / 2 + [0, 0, 110]
    return joints, points


def in_the_words_of(points, spelling):
    """Return a capture with the markers of a set."""
    called = {}
    for entry in spelling.split():
        known, name = entry.split("=")
        if known in points:
            called[name] = points[known]
        else:
            for side, word in (("L", "Left"), ("R", "Right")):
                called[name.replace("##", word).replace("#", side)] = points[side + known]
    values = np.stack(list(called.values()), axis=1)
    return ew.label_trajectories(values, markers=list(called), rate_hz=50)


def off(found, truth, joint):
    away = found.sel(marker=joint).values - truth.sel(marker=joint).values
    return float(np.linalg.norm(away, axis=1).max())


@pytest.mark.parametrize("name", SETS)
def test_the_joints_come_out_by_the_names_of_each_set(body, name):
    truth, points = body
    found = virtual_markers(in_the_words_of(points, SETS[name]))
    assert found.attrs["marker_set"] == name
    assert found.attrs["marker_set_share"] >= 0.75
    assert found.attrs["marker_set_runner_up"].partition(",")[0] not in ("", name)
    for side in ("left", "right"):
        for joint, most in (("hip", 35), ("knee", 30), ("ankle", 35), ("wrist", 5), ("elbow", 40)):
            assert off(found, truth, f"{side}_{joint}") < most, (side, joint)
        assert off(found, truth, f"{side}_shoulder") < 40
    assert off(found, truth, "pelvis") < 5
    assert off(found, truth, "sternum") < 90
    bare = {"OpenSim gait2392": 115, "OpenSim Rajagopal": 90}  # a marker on top of the head; none
    assert off(found, truth, "head") < bare.get(name, 60)


@pytest.mark.parametrize("name", ["Helen Hayes", "OpenSim Rajagopal", "van Sint Jan landmarks"])
def test_inner_markers_say_where_hinges_are(body, name):
    truth, points = body
    spelling = SETS[name]
    if name == "Helen Hayes":
        spelling += " KNE_IN=#.Knee.Medial ANK_IN=#.Ankle.Medial"
    found = virtual_markers(in_the_words_of(points, spelling))
    for joint in ("left_knee", "right_knee", "left_ankle", "right_ankle"):
        assert off(found, truth, joint) < 1e-6
    assert not {"left_knee", "left_ankle"} & set(found.attrs["approximate"])


def test_joint_centres_in_the_file_are_taken(body):
    truth, points = body
    centres = {
        f"{side}{short}": truth.sel(marker=f"{word}_{joint}").values
        for side, word in (("L", "left"), ("R", "right"))
        for short, joint in (("HJC", "hip"), ("KJC", "knee"), ("AJC", "ankle"), ("SJC", "shoulder"))
    }
    spelling = SETS["OpenSim Rajagopal"] + " HJC=#HJC KJC=#KJC AJC=#AJC SJC=#SJC"
    found = virtual_markers(in_the_words_of(points | centres, spelling))
    for joint in ("left_hip", "right_knee", "left_ankle", "right_shoulder"):
        assert off(found, truth, joint) < 1e-6
    assert "left_hip" not in found.attrs["approximate"]


def test_a_head_without_markers_is_put_above_the_neck_and_said_so(body):
    _, points = body
    found = virtual_markers(in_the_words_of(points, SETS["OpenSim Rajagopal"]))
    assert "head" in found.attrs["approximate"]
    assert Rebuilt("head", "above neck") in found.attrs["rebuilt"]


@pytest.mark.parametrize(
    ("gone", "said"),
    [
        ("LFHD", Rebuilt("head", "from", ("RFHD", "LBHD"), ("LFHD",))),
        ("RASI", Rebuilt("right_front_waist", "mirrored", ("left_front_waist",))),
        ("LPSI", None),
        ("RWRB", Rebuilt("right_wrist", "from", ("RWRA",), ("RWRB",))),
    ],
)
def test_what_stands_for_a_marker_that_was_never_seen_is_said(body, gone, said):
    truth, points = body
    rest = {name: points[name] for name in points if name != gone and "HEAD" not in name}
    plain = [name for name in rest if name in PLUG_IN_GAIT or name[1:] in BOTH]
    values = np.stack([rest[name] for name in plain], axis=1)
    found = virtual_markers(ew.label_trajectories(values, markers=plain, rate_hz=50))
    assert found.attrs["marker_set"] == "Plug-in Gait"
    assert np.isfinite(found.values).all()
    assert off(found, truth, "pelvis") < 10
    assert off(found, truth, "head") < 10
    if said:
        assert found.attrs["rebuilt"] == (said,)
    else:
        assert len(found.attrs["rebuilt"]) == 1


def test_a_whole_set_has_nothing_rebuilt(body):
    _, points = body
    plain = [name for name in points if name in PLUG_IN_GAIT or name[1:] in BOTH]
    values = np.stack([points[name] for name in plain], axis=1)
    found = virtual_markers(ew.label_trajectories(values, markers=plain, rate_hz=50))
    assert found.attrs["rebuilt"] == ()
    assert found.attrs["marker_set_share"] > 0.9
    assert found.attrs["marker_set_runner_up"] == "landmarks in words, 93%"


XSENS = (
    "Pelvis L5 L3 T12 T8 Neck Head #Shoulder #UpperArm #ForeArm #Hand #UpperLeg #LowerLeg "
    "#Foot #Toe"
)


def test_segments_of_xsens_are_joints():
    names = [
        bone.replace("#", side)
        for bone in XSENS.split()
        for side in (("Left", "Right") if "#" in bone else ("",))
    ]
    values = np.arange(len(names))[None, :, None] * np.ones(3)
    found = virtual_markers(ew.label_trajectories(values, markers=names, rate_hz=60))
    assert found.attrs["marker_set"] == "Xsens MVN segments"
    for joint, name in (("left_hip", "LeftUpperLeg"), ("right_elbow", "RightForeArm")):
        assert found.sel(marker=joint).values[0, 0] == names.index(name)
