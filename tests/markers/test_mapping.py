"""A mapping for marker names of one's own: in Python, as a file, begun by a guess."""

from __future__ import annotations

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.markers.mapping import as_mapping, mapping_to_begin_with, read_mapping

OWN = (
    *(
        "Kopf",
        "Brustbein",
        "Schulter_L",
        "EllbogenL",
        "Hand_L",
        "Schulter_R",
        "EllbogenR",
        "Hand_R",
    ),
    *("Becken", "H\u00fcfte_L", "KnieL", "FussL", "H\u00fcfte_R", "KnieR", "FussR"),
)
WALK = ew.simulate_walk(seed=1, duration_s=3)


def test_a_mapping_that_is_begun_with_guesses_gives_the_joints(tmp_path):
    path = tmp_path / "names.toml"
    text = mapping_to_begin_with(OWN, "a.c3d")
    assert text.count("# guess") >= 10
    assert "Markers of the file: Kopf, Brustbein" in text
    path.write_text(text, encoding="utf-8")
    joints = ew.virtual_markers(WALK.assign_coords(marker=list(OWN)), mapping=path)
    np.testing.assert_allclose(joints.values, ew.virtual_markers(WALK).values)


def test_landmarks_on_the_skin_give_the_same_joints_as_a_known_set(tmp_path):
    skin = ew.simulate_walk(seed=1, duration_s=3, markers="skin")
    names = [str(name) for name in skin.marker.values]
    text = mapping_to_begin_with(names, "a.c3d")
    for name in sorted(names, key=len, reverse=True):
        text = text.replace(f'"{name}"', f'"my {name}"')
    path = tmp_path / "names.toml"
    path.write_text(text, encoding="utf-8")
    own = skin.assign_coords(marker=[f"my {name}" for name in names])
    found = ew.virtual_markers(own, mapping=path)
    np.testing.assert_allclose(found.values, ew.virtual_markers(skin).values)
    assert found.attrs["marker_set"].endswith("with own mapping")
    assert as_mapping(read_mapping(path).as_dict()) == read_mapping(path)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('[joints]\n\nleft_anke = "a"\n', r"'left_anke' in line 3.*did you mean 'left_ankle'"),
        ('[joints]\nhead = ""\n', "head in line 2 names no marker"),
        ("[joints]\nhead = 3\n", "head in line 2 is no marker"),
        ('head = "a"\n', r"'head' in line 1, outside of \[joints\]"),
        ('[joints]\n# head = "a"\n', "has no effect"),
        ('[joints]\nhead = "a\n', "is no TOML.*line 2"),
        ('[joints]\nhead = "Helm"\n', r"\['Helm'\] for head \(line 2 of names.toml\)"),
    ],
)
def test_errors_name_the_line_and_the_marker(tmp_path, text, told):
    (tmp_path / "names.toml").write_text(text)
    with pytest.raises(ValueError, match=told):
        ew.virtual_markers(WALK, mapping=tmp_path / "names.toml")


def test_a_changed_mapping_makes_a_resumed_fit_anew(tmp_path):
    ew.write_mocap(WALK.assign_coords(marker=list(OWN)), tmp_path / "a.c3d")
    mapping = dict(zip(ew.JOINTS.markers, OWN, strict=True))
    settings = {"n_jobs": 1, "checkpoint": tmp_path / "x.part"}
    assert ew.fit_folder(tmp_path, mapping=mapping, **settings).n_resumed == 0
    assert ew.fit_folder(tmp_path, mapping=mapping, **settings).n_resumed == 1
    swapped = mapping | {"head": ["Kopf", "Brustbein"]}
    assert ew.fit_folder(tmp_path, mapping=swapped, **settings).n_resumed == 0
