"""Markers whose names say nothing are known by their places."""

from __future__ import annotations

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.markers.mapping import mapping_to_begin_with, read_mapping
from eigenwalker.study.marker_hints import marker_hints


@pytest.mark.parametrize("angle", [0.0, 2.0, None])
def test_joints_are_known_by_their_places_whichever_way_one_walks(angle, tmp_path) -> None:
    walk = ew.simulate_walk(seed=2, duration_s=4, rate_hz=60)
    moved = walk.values.copy()
    if angle is not None:
        cos, sin = np.cos(angle), np.sin(angle)
        moved[..., 0] += 1300 * walk.time.values[:, None]
        moved = moved @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    names = [f"pt{number:02d}" for number in range(15)]
    capture = ew.label_trajectories(moved[:, ::-1], markers=names, rate_hz=60)
    truth = dict(zip(ew.JOINTS.markers, reversed(names), strict=True))
    hints = marker_hints(capture)
    assert hints.sides_known == (angle is not None)
    assert len(hints.joints) >= 13
    assert hints.joints.items() <= truth.items()
    assert ("left of the middle" in hints.places[truth["left_hip"]]) == hints.sides_known
    text = mapping_to_begin_with(names, "a.c3d", hints.places, hints.joints)
    path = tmp_path / "names.toml"
    path.write_text(
        "\n".join(
            line.removeprefix("# ") if "by its place" in line else line for line in text.split("\n")
        )
    )
    assert read_mapping(path).joints == {joint: (name,) for joint, name in hints.joints.items()}
