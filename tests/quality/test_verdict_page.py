"""docs/verdict.md lists every finding, with its verdict and its limits."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import get_args, get_type_hints

import pytest

from eigenwalker import study
from eigenwalker.gait import body_points
from eigenwalker.quality import anthropometry as joints, assessment, quality as of

ROWS = {
    code: (limit, verdict.strip(" |"))
    for code, limit, verdict in re.findall(
        r"(?m)^\| `(\w+)` \|[^|]*\|([^|]*)\|(.*)$",
        (Path(__file__).parents[2] / "docs/verdict.md").read_text("utf-8"),
    )
}
MESSAGES = tomllib.loads((Path(study.__path__[0]) / "messages.toml").read_text("utf-8"))
KINDS = set(get_args(get_type_hints(joints.WrongJoint)["kind"]))
LIMITS = {
    "flat": (body_points.FLAT, assessment.FEWEST_POINTS),
    "impossible_height": (*of.HEIGHTS_MM, *of.EXTENTS_MM),
    "leaning": (of.MOST_LEAN_DEG,),
    "small_body": (of.CHILD_MM,),
    "not_level": (of.LEVEL_CLIMB, of.LEVEL_MM),
    "sloping": (*of.STANDING_SLOPE, of.SYNTHESISED_R2),
    "tilted": (of.MOST_ROLL_DEG,),
    "backwards": (of.BACKWARDS_MM_S,),
    "speed": (of.FASTEST_FROUDE,),
    "hardly_periodic": (of.HOPELESS_R2, of.STEADY_R2),
    "not_periodic": (of.HOPELESS_R2,),
    "cadence": (*of.FREQUENCIES_HZ, of.SLOWEST_HZ, of.SHORT_STRIDE),
    "one_stride": (of.FEWEST_STRIDES,),
    "unsteady": (of.ENOUGH_STRIDES, of.STEADY_SHARE),
    "filled_gaps": (of.MISSING_SHARE,),
    "elastic_limbs": (of.BONE_VARIATION, of.GROWN_MM, of.SYNTHESISED_R2),
    "flicker": (of.FLICKER_SHARE,),
    "length": (joints.LENGTH_FACTOR,),
    "unequal": (joints.SIDE_FACTOR,),
    "place": (joints.ONE_PLACE,),
    "middle": (joints.MIDDLE, joints.NEAR_MIDDLE),
    "breadth": (*joints.TORSO_FACTORS, *joints.BREADTH_FACTORS, *sum(joints.BOTH_FACTORS, ())),
    "link": (joints.LINK_VARIATION, joints.LINK_OF_LIMBS),
}


def test_every_finding_and_kind_is_listed_and_no_other():
    assert set(ROWS) == {*MESSAGES["findings"], *KINDS}
    assert set(ROWS) >= of.RULES_OUT


@pytest.mark.parametrize("code", MESSAGES["findings"])
def test_the_verdict_is_that_of_the_code(code):
    expected = "do not use" if code in of.RULES_OUT else "use with care"
    assert ROWS[code][1] == expected


@pytest.mark.parametrize("code", LIMITS)
def test_the_limits_are_those_of_the_code(code):
    assert {f"{each:g}" for each in LIMITS[code]} <= set(re.findall(r"-?[\d.]*\d", ROWS[code][0]))
