"""Colours are what they stand for, wherever they are."""

import re
from pathlib import Path

from matplotlib.colors import to_rgb

import eigenwalker as ew
from eigenwalker.plotting.style import NEGATIVE, POSITIVE

FRONTEND = Path(__file__).parents[2] / "frontend" / "src"


def test_women_and_men_have_the_colours_of_the_page():
    css = (FRONTEND / "page" / "classColours.css").read_text(encoding="utf-8")
    colours = dict(re.findall(r"--(negative|positive): (#\w{6});", css))
    assert colours == {"negative": NEGATIVE, "positive": POSITIVE}
    for page in ("explorer/interactive.css", "widget/widget.css"):
        text = (FRONTEND / page).read_text(encoding="utf-8")
        assert "classColours.css" in text
        assert not re.search(r"--(negative|positive):", text)


def test_a_class_keeps_its_colour_when_poles_are_named_the_other_way_round():
    people = ew.simulate_population(3, 3, seed=1)
    space, sex = ew.WalkerSpace().fit(people.X), people.traits["sex"]
    for poles in (("female", "male"), ("male", "female")):
        figure = ew.plotting.figure_space(space, people.X, sex, trait_name="sex", poles=poles)
        inks = {
            dots.get_label(): dots.get_facecolor()[0, :3] for dots in figure.axes[0].collections
        }
        assert [tuple(inks[pole]) for pole in poles] == [to_rgb(NEGATIVE), to_rgb(POSITIVE)]
