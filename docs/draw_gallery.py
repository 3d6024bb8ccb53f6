"""Makes docs/gallery.md and its moving pictures: `python docs/draw_gallery.py`.

One table, here, gives the text, the lines and the pictures.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from eigenwalker.stimulus import Stimulus, write_stimulus

DOCS = Path(__file__).parent
PICTURES = DOCS / "images" / "gallery"
SETTING = """\
import eigenwalker as ew
from eigenwalker.stimulus import Figure, make_stimulus, with_information

people = ew.load_population().size_normalised()
average = people.walker(people.average)
along_sex = ew.trait_axis(people, "sex").step
woman, man = (people.walker(people.average + sds * along_sex) for sds in (-3, 3))
small = {"duration_s": 2.38, "rate_hz": 25, "size_px": (128, 128)}
shown = make_stimulus(average, **small)
"""
"""What the lines of all rows begin with; it stands in the page."""
OPTIONS = {"--duration": "2.38", "--rate": "25", "--size": "128x128"}
TITLES = {
    "body": "The body",
    "time": "Time",
    "space": "Space",
    "dots": "Dots",
    "noise": "Noise",
    "begin": "Who walks, and how it is shown",
}
"""Sections: transforms in the order in which the command line applies them, then the rest."""


class Row(NamedTuple):
    """One moving picture.

    Parameters
    ----------
    section : str
        Under which title.
    name : str
        Of the picture; a transform's own name, or that with a word.
    line : str
        Python that makes it, after the setting.
    options : str or None
        The same for the command line; None where only Python can say it.
    see : str
        A sentence: what to see, and the paper.

    """

    section: str
    name: str
    line: str
    options: str | None
    see: str


ROWS = (
    Row(
        *("body", "gain", 'shown.then("gain", parts="legs", factor=0.4)'),
        "--gain parts=legs,factor=0.4",
        "Short steps: the legs make 0.4 of their movement, the mean posture stays.",
    ),
    Row(
        *("body", "arm_swing", 'shown.then("arm_swing", factor=2.5)'),
        "--arm-swing 2.5",
        "A gain of elbows and wrists: arms swing too far to tell the sex by (Kozlowski and "
        "Cutting, 1977).",
    ),
    Row(
        "body",
        "conflict",
        'make_stimulus(average, azimuth_deg=0, **small).then("conflict", shoulder_width=1.3, '
        "hip_width=0.8, shoulder_sway=0.3, hip_sway=4)",
        "--view 0 --conflict shoulder_width=1.3,hip_width=0.8,shoulder_sway=0.3,hip_sway=4",
        "Wide shoulders say a man, swaying hips a woman; sway wins (Mather and Murdoch, 1994).",
    ),
    Row(
        "body",
        "ellipses",
        'make_stimulus(average, azimuth_deg=90, **small).then("ellipses", shoulder_mm=[70, 20], '
        "hip_mm=[15, 10])",
        "--view 90 --ellipses shoulder=70/20,hip=15/10",
        "Shoulders go round large ellipses, hips round small ones: a synthetic man (Cutting, "
        "1978).",
    ),
    Row(
        "body",
        "perturb",
        'shown.then("perturb", markers="left_wrist", amount_mm=[0, 0, 150], frequency_hz=4, '
        "start_s=0.6, end_s=1.6)",
        "--perturb markers=left_wrist,amount=0/0/150,frequency=4,start=0.6,end=1.6",
        "One wrist trembles for a second; all other dots walk on.",
    ),
    Row(
        *("time", "speed", 'shown.then("speed", factor=2)'),
        "--speed 2",
        "The same walk at twice its tempo; the sex is then told hardly above chance (Barclay, "
        "Cutting and Kozlowski, 1978).",
    ),
    Row(
        *("time", "start", 'shown.then("start", phase_deg=90)'),
        "--start 90",
        "The same walk, begun a quarter of a stride later; compare `plain`, at the end.",
    ),
    Row(
        *("time", "reverse", 'shown.then("reverse")'),
        "--reverse",
        "The film backwards: somebody walks rearwards.",
    ),
    Row(
        *("time", "freeze", 'shown.then("freeze", time_s=0.3)'),
        "--freeze 0.3",
        "The static control: without movement the dots look like little (Johansson, 1973).",
    ),
    Row(
        *("time", "delay", 'shown.then("delay", parts="arms", phase_deg=180)'),
        "--delay parts=arms,phase=180",
        "The arms are half a stride late, and swing along with the legs of their own side.",
    ),
    Row(
        *("time", "phase_scramble", 'shown.then("phase_scramble", seed=3)'),
        "--phase-scramble seed=3",
        "Each dot keeps its place, path and tempo, on a clock of its own.",
    ),
    Row(
        *("time", "morph", 'make_stimulus(man, **small).then("morph", walker=woman)'),
        "--trait sex=3 --morph-to sex=-3",
        "A man becomes a woman on his way, 3 standard deviations to either side of the average "
        "(Troje, 2002).",
    ),
    Row(
        *("space", "mirror", 'shown.then("mirror")'),
        "--mirror",
        "Left and right swapped: the view from 30 degrees is that from -30 (Troje, 2002).",
    ),
    Row(
        "space",
        "translate",
        'shown.then("translate", offset_mm=[0, -650, 0], velocity_mm_s=[0, 540, 0])',
        None,
        "The figure slides from left to right while its limbs walk as on a treadmill.",
    ),
    Row(
        "space",
        "overground",
        'make_stimulus(average, azimuth_deg=90, **small | {"size_px": (240, 128)})'
        '.then("overground")',
        "--view 90 --size 240x128 --overground",
        "A translation with the walker's own speed: feet that stand stay where they are.",
    ),
    Row(
        *("space", "resize", 'shown.then("resize", factor=0.6)'),
        None,
        "Smaller about the floor below it: a child's height with the same tempo.",
    ),
    Row(
        *("space", "rotate", 'shown.then("rotate", speed_deg_s=148.76)'),
        "--rotate speed=148.76",
        "Turns to its left, once round in the film; without perspective some see it turn the "
        "other way.",
    ),
    Row(
        *("space", "rotate_sight", 'shown.then("rotate", axis="sight", angle_deg=90)'),
        "--rotate axis=sight,angle=90",
        "Turned in the picture: from 90 degrees on a walker is hardly recognised (Pavlova and "
        "Sokolov, 2000).",
    ),
    Row(
        *("space", "invert", 'shown.then("invert")'),
        "--invert",
        "Upside down: hard to see as a walker (Sumi, 1984), and women look like men (Barclay, "
        "Cutting and Kozlowski, 1978).",
    ),
    Row(
        *("dots", "occlude", 'shown.then("occlude", parts="lower_body")'),
        "--occlude lower_body",
        "Only the upper body is shown (Kozlowski and Cutting, 1977).",
    ),
    Row(
        *("dots", "scramble", 'shown.then("scramble", seed=3)'),
        "--scramble seed=3",
        "Each dot moves as before, elsewhere: the walker is gone (Cutting, 1981; Bertenthal and "
        "Pinto, 1994), though not his direction (Troje and Westhoff, 2006).",
    ),
    Row(
        *("dots", "scramble_structure", 'shown.then("scramble", seed=3, keep="structure")'),
        "--scramble seed=3,keep=structure",
        "The dots stand where joints do, but have the movements of other joints.",
    ),
    Row(
        *("dots", "limb_dots", 'shown.then("limb_dots", number=8, lifetime_s=0.12, seed=1)'),
        "--limb-dots number=8,lifetime=0.12,seed=1",
        "Eight dots that jump along the limbs every 0.12 s: no dot's path tells of the walk, and "
        "one sees it (Beintema and Lappe, 2002).",
    ),
    Row(
        "dots",
        "blur",
        'make_stimulus(average, duration_s=1.2, rate_hz=25, size_px=(64, 64)).then("blur", '
        "sd_usual_mm=80)",
        "--duration 1.2 --size 64x64 --blur 80",
        "One blob that changes its shape; the sex is told at chance (Barclay, Cutting and "
        "Kozlowski, 1978). Small and one stride long, as blobs make large GIFs.",
    ),
    Row(
        "noise",
        "mask",
        'shown.then("mask", kind="scrambled", number=45, box_mm=[1700, 1700], seed=2)',
        "--mask kind=scrambled,number=45,box=1700/1700,seed=2",
        "The walker among dots that move as its own do (Cutting, Moore and Morrison, 1988; "
        "Bertenthal and Pinto, 1994).",
    ),
    Row(
        "noise",
        "mask_random",
        'shown.then("mask", kind="random", signal_to_noise=0.5, box_mm=[1700, 1700], '
        "lifetime_s=0.24, seed=2)",
        "--mask kind=random,signal_to_noise=0.5,box=1700/1700,lifetime=0.24,seed=2",
        "Two dots of noise for each of the walker's, each 0.24 s at one place.",
    ),
    Row(
        "noise",
        "mask_linear",
        'shown.then("mask", kind="linear", number=40, box_mm=[1700, 1700], speed_mm_s=400, '
        "direction_deg=0, seed=2)",
        "--mask kind=linear,number=40,box=1700/1700,speed=400,direction=0,seed=2",
        "A curtain of dots that drift to the right; left without a direction, each has its own.",
    ),
    Row(
        *("begin", "plain", "shown"),
        "",
        "The average of the built-in population of synthetic people, nothing done to it.",
    ),
    Row(
        *("begin", "view", "make_stimulus(average, azimuth_deg=90, **small)"),
        "--view 90",
        "In profile; 0 is the front (Troje, 2002, compares 0, 30 and 90 degrees).",
    ),
    Row(
        *("begin", "elevation", "make_stimulus(average, elevation_deg=30, **small)"),
        "--elevation 30",
        "From 30 degrees above the horizon.",
    ),
    Row(
        "begin",
        "perspective",
        "make_stimulus(average, azimuth_deg=0, eye_distance_mm=1500, **small)",
        "--view 0 --eye-distance 1500",
        "In perspective, from 1.5 m: what swings towards the observer grows apart.",
    ),
    Row(
        "begin",
        "sized",
        "shown.sized(2, viewing_distance_mm=570, px_per_cm=38)",
        "--height-deg 2 --distance 570 --px-per-cm 38",
        "Two degrees of visual angle high on a screen of 38 pixels a centimetre at 57 cm.",
    ),
    Row(
        *("begin", "sticks", 'make_stimulus(average, style="sticks", **small)'),
        "--style sticks",
        "The dots joined.",
    ),
    Row(
        *(
            "begin",
            "mannequin",
            'make_stimulus(average, style="mannequin", **small | {"duration_s": 1.2})',
        ),
        "--style mannequin --duration 1.2",
        "The same walk on a wooden mannequin, the same for all, woman or man, as in Pražák "
        "and others (2010).",
    ),
    Row(
        "begin",
        "structure",
        'make_stimulus(with_information(people, 3, "structure"), **small)',
        "--from 3 --information structure",
        "Walker 3's own posture with everybody's average movement (Troje, 2002).",
    ),
    Row(
        "begin",
        "dynamics",
        'make_stimulus(with_information(people, 3, "dynamics"), **small)',
        "--from 3 --information dynamics",
        "Everybody's average posture with walker 3's own movement (Troje, 2002).",
    ),
    Row(
        "begin",
        "several",
        "make_stimulus([Figure(woman), Figure(man, position_mm=(0, -900, 0))], azimuth_deg=0, "
        '**small).then("invert", figures=1)',
        None,
        "Two in one scene; a transform acts on the figures named.",
    ),
)
PAPERS = """\
## Papers

- Barclay, Cutting and Kozlowski (1978). Temporal and spatial factors in gait perception that
  influence gender recognition. *Perception & Psychophysics* 23, 145-152.
- Beintema and Lappe (2002). Perception of biological motion without local image motion. *PNAS* 99,
  5661-5663.
- Bertenthal and Pinto (1994). Global processing of biological motions. *Psychological Science* 5,
  221-225.
- Cutting (1978). Generation of synthetic male and female walkers through manipulation of a
  biomechanical invariant. *Perception* 7, 393-405.
- Cutting (1981). Coding theory adapted to gait perception. *Journal of Experimental Psychology:
  Human Perception and Performance* 7, 71-87.
- Cutting, Moore and Morrison (1988). Masking the motions of human gait. *Perception &
  Psychophysics*.
- Johansson (1973). Visual perception of biological motion and a model for its analysis. *Perception
  & Psychophysics* 14, 201-211.
- Kozlowski and Cutting (1977). Recognizing the sex of a walker from a dynamic point-light display.
  *Perception & Psychophysics* 21, 575-580.
- Mather and Murdoch (1994). Gender discrimination in biological motion displays based on dynamic
  cues. *Proceedings of the Royal Society B* 258, 273-279.
- Pavlova and Sokolov (2000). Orientation specificity in biological motion perception. *Perception &
  Psychophysics* 62, 889-899.
- Pražák, McDonnell, Kavan and O'Sullivan (2010). A perception based metric for comparing human
  locomotion.
- Sumi (1984). Upside-down presentation of the Johansson moving light-spot pattern. *Perception*.
- Troje (2002). Decomposing biological motion: a framework for analysis and synthesis of human gait
  patterns. *Journal of Vision* 2 (5), 371-387.
- Troje and Westhoff (2006). The inversion effect in biological motion perception: evidence for a
  "life detector"? *Current Biology* 16, 821-824.
"""


def setting() -> dict[str, Any]:
    """Return the names that the lines use."""
    names: dict[str, Any] = {}
    exec(SETTING, names)
    return names


def made(row: Row, names: dict[str, Any]) -> Stimulus:
    """Return the stimulus of a row, as its line makes it."""
    return eval(row.line, names)


def page() -> str:
    """Return the text of docs/gallery.md."""
    return "\n".join(
        [
            "# Gallery",
            "",
            "Every transform of a [stimulus](stimuli.md) as a moving picture, with the line that "
            "makes it.",
            "[stimulus-format.md](stimulus-format.md) has the formulas. The pictures last two "
            "strides of the average",
            "walker, 2.38 s, and are as fast as the walk. All begin so:",
            "",
            "```python",
            SETTING.rstrip(),
            "```",
            "",
            'Each line gives a stimulus; `ew.write_stimulus(shown, "stim.json")` writes the file,',
            "and `.mp4` or `.gif` in place of `.json` a film. The options do the same, as in",
            "",
            "```sh",
            command("--invert", "invert.gif"),
            "```",
            "",
            "`python docs/draw_gallery.py` makes the pictures and this page.",
            *(part for section in TITLES for part in _section(section)),
            "",
            PAPERS,
        ]
    ).replace("\n\n\n", "\n\n")


def command(options: str, output: str) -> str:
    """Return the command of a row, whose options stand in place of those of all rows."""
    usual = [f"{name} {value}" for name, value in OPTIONS.items() if name not in options.split()]
    return " ".join(["eigenwalker stimulus", *usual, options, "-o", output])


def _section(section: str) -> Iterable[str]:
    yield from ("", f"## {TITLES[section]}", "", "| | | |", "|---|---|---|")
    for row in ROWS:
        if row.section == section:
            yield f"| {_picture(row)} | **{row.name}** | {row.see}<br>{_lines(row)} |"


def _picture(row: Row) -> str:
    return f"![{row.name}](images/gallery/{row.name}.gif)"


def _lines(row: Row) -> str:
    if row.options is None:
        return f"`{row.line}`<br>(in Python only)"
    return f"`{row.line}`<br>`{row.options}`" if row.options else f"`{row.line}`"


def main() -> None:
    """Write the page and the pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    names = setting()
    for row in ROWS:
        write_stimulus(made(row, names), PICTURES / f"{row.name}.gif")
    (DOCS / "gallery.md").write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
