from __future__ import annotations

import pytest

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.markers.marker_sets import (
    MarkerNames,
    known_sets,
    numbered,
    repeated,
    side_pairs,
    subjects,
)


@pytest.mark.parametrize(
    "name",
    [
        *(
            "LKNE",
            "l kne ",
            "L_KNE",
            "L.Kne",
            "Anna:LKNE",
            "LeftKne",
            "left_kne",
            "KNE_L",
            "kneLeft",
        ),
        *("Lab 3:Anna:LKNE", "Armature|LeftKne"),
    ],
)
def test_a_marker_is_found_in_any_spelling(name):
    hit = MarkerNames(["C7", name]).find("{left}KNE")
    assert hit is not None
    assert hit.markers == (name,)


@pytest.mark.parametrize("name", ["RKNE", "LKNEE", "KNE", "RightKne", "KNE_R"])
def test_another_marker_is_not_taken_for_it(name):
    assert MarkerNames(["C7", name]).find("{left}KNE") is None


def test_a_beginning_that_most_names_share_does_not_matter():
    bones = ["Pelvis", "L Thigh", "L Calf", "R Thigh", "Head"]
    names = MarkerNames(["Bip01", *(f"Bip01 {bone}" for bone in bones)])
    hit = names.find("{left}Thigh")
    assert hit is not None
    assert hit.markers == ("Bip01 L Thigh",)


def test_sides_are_no_common_beginning():
    names = MarkerNames(["L_Hip", "L_Knee", "L_Ankle", "L_Foot", "R_Hip"])
    hit = names.find("{left}Knee")
    assert hit is not None
    assert hit.markers == ("L_Knee",)


def test_alternatives_are_tried_in_turn_and_midpoints_need_all():
    names = MarkerNames(["LWRA", "RWRA", "RWRB"])
    entry = "{left}WRA + {left}WRB | ~ {left}WRA"
    assert names.find(entry) == (("LWRA",), True, ("LWRB",))
    assert names.find(entry.replace("left", "right")) == (("RWRA", "RWRB"), False, ())


def test_every_set_describes_all_15_joints_or_landmarks_that_lead_there():
    for known in known_sets():
        if not known.landmarks:
            assert set(JOINTS.markers) <= set(known.joints), known.name
        else:
            sided = {f"{side}_{part}" for side in ("left", "right") for part in SKIN}
            landmarks = set(known.landmarks)
            assert sided <= landmarks, known.name
            assert {"sacrum"} & landmarks or {"left_back_waist"} <= landmarks, known.name
            assert {"left_wrist", "right_wrist"} <= set(known.joints), known.name
            assert "head" in known.joints or {"c7", "clavicle"} <= landmarks, known.name


SKIN = ("front_waist", "knee", "ankle", "shoulder", "elbow")


def test_numbers_tell_same_names_apart():
    assert numbered(["a", "a", "a_2", "a"]) == ["a", "a_2", "a_2_2", "a_3"]


def test_names_tell_subjects_sides_and_repetitions():
    assert subjects(["Anna:LKNE", "Ben:LKNE", "floor"]) == ["Anna", "Ben"]
    assert repeated(["head", "hand", "hand"]) == ["hand"]
    names = ["LASI", "RASI", "C7", "Knee_R", "Knee_L", "left_hip", "right_hip"]
    pairs = [("LASI", "RASI"), ("Knee_L", "Knee_R"), ("left_hip", "right_hip")]
    assert side_pairs(names) == pairs


def test_stand_ins_and_midpoints_are_told_apart():
    names = MarkerNames(["mixamorig:LeftUpLeg", "thigh.R", "Anna:LWRA", "Anna:LWRB"])
    hit = names.find("{right}UpLeg | ~ {right}Thigh")
    assert hit is not None
    assert (hit.markers, hit.stand_in) == (("thigh.R",), True)
    hit = names.find("{left}WRA + {left}WRB")
    assert hit is not None
    assert hit.markers == ("Anna:LWRA", "Anna:LWRB")
