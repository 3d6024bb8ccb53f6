"""Sentences about captures: verdicts, repairs, what was left out, and what a folder holds."""

from __future__ import annotations

import re
import shlex
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import MILLIMETRES, sampling_rate
from eigenwalker.io.errors import printable
from eigenwalker.io.up_axis_and_unit import PERSON_MM, UNITS
from eigenwalker.markers.label_repair import Repair
from eigenwalker.population.persons import (
    PERSON,
    columns_like_persons,
    person_column,
    persons_of,
)
from eigenwalker.quality import quality as limit
from eigenwalker.quality.quality import FLICKER_SHARE, Quality
from eigenwalker.study.body_warnings import WIDE_HIPS, RetargetingWarnings
from eigenwalker.study.process_capture import CaptureResult

if TYPE_CHECKING:
    from eigenwalker.analysis.trait_model import TraitModel

Fact = str | float | int | bool | None | list[str]


@cache
def _words() -> dict[str, dict[str, Any]]:
    text = files("eigenwalker.study").joinpath("messages.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def reasons(quality: Quality) -> list[str]:
    """Return a sentence for each finding that speaks against a capture.

    Parameters
    ----------
    quality : Quality
        As `assess` returns it, or ``process_capture(...).quality``.

    Returns
    -------
    list of str
        Empty for the verdict "use".

    See Also
    --------
    eigenwalker.quality.assess

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1)
    >>> reasons(ew.assess(walk.copy(data=walk.values * [1, -1, -1])))[0]
    'The head is not above the feet: the wrong axis points up.'
    """
    values = _values(quality)
    return [_words()["findings"][finding].format(**values) for finding in quality.findings]


def flag_of(quality: Quality) -> str:
    """Return all that speaks against a capture in one line, empty for the verdict "use"."""
    return " ".join(reasons(quality))


def capture_remark(flag: str, warnings: RetargetingWarnings | None = None) -> str:
    """Return what is wrong with a capture, and with its walk on the mannequin, in one line."""
    body = []
    if warnings and warnings.legs_cross:
        body.append("its legs cross on the mannequin, as they did not in the capture")
    if warnings and warnings.hip_ratio > WIDE_HIPS:
        body.append(
            f"its hips are {warnings.hip_ratio:.1f} times as wide beside its shoulders as joints "
            "are, so they are points on the skin"
        )
    remarks = [f"it is flagged: {flag.rstrip('.')}"] if flag else []
    return "; ".join([*remarks, ", and ".join(body)] if body else remarks)


def capture_lines(result: CaptureResult) -> list[str]:
    """Return what to know about a capture in addition to its walker, in sentences."""
    quality, walker = result.quality, result.walker
    explained = walker.fit.fourier_r2 if walker.fit else float("nan")
    lines = [
        f"{quality.n_strides} strides in {quality.duration_s:.0f} s at {walker.frequency_hz:.2f} "
        f"Hz; the sines of this walker hold {100 * explained:.0f} % of its movement."
    ]
    if flag := flag_of(quality):
        lines.append(flag)
    if quality.rebuilt:
        lines.append(f"Rebuilt: {rebuilt_in_words(quality)}.")
    if quality.unit_guessed:
        lines.append(f"The file names no unit; {quality.unit} was guessed from the height.")
    return lines


def assumed_rate_in_words(capture: xr.DataArray) -> str:
    """Return the rate that a capture is assumed to have, and why; empty where it names one."""
    if not capture.attrs.get("rate_assumed"):
        return ""
    return f"{sampling_rate(capture):.6g} Hz, {capture.attrs['rate_reason']}"


def rebuilt_in_words(quality: Quality) -> str:
    """Return what stands for markers that were never seen, in one line."""
    return "; ".join(
        _words()["rebuilt"][each.kind].format(each, *map(" and ".join, each[2:]))
        for each in quality.rebuilt
    )


def repair_in_words(repair: Repair) -> str:
    """Return the markers and the frames of a repair."""
    markers = f"{repair.marker} and {repair.partner}" if repair.partner else repair.marker
    if repair.first_frame == repair.last_frame:
        return f"{markers}, frame {repair.first_frame}"
    return f"{markers}, frames {repair.first_frame} to {repair.last_frame}"


def traits_in_words(traits: pd.DataFrame) -> list[str]:
    """Return of what kind each trait is, its classes or range, and how many values are missing."""
    return [
        _trait_in_words(str(name), traits[name])
        for name in traits
        if name not in ("file", "flag", PERSON)
    ]


def _trait_in_words(name: str, values: pd.Series) -> str:
    known = values[values.notna() & (values.astype(str) != "")]
    missing = f"; {len(values) - len(known)} missing" if len(known) < len(values) else ""
    if not len(known):
        return f"{name}: no values{missing}"
    if known.dtype.kind in "iuf":
        ends = f"{known.min():g}" if known.nunique() == 1 else f"{known.min():g} to {known.max():g}"
        return f"{name}: numbers, {ends}, {len(known)} values{missing}"
    counts = known.astype(str).value_counts()
    if len(counts) == len(known) > 2:
        return f"{name}: text, each another, {len(known)} values{missing}"
    shown = ", ".join(f"{value} {count}" for value, count in counts.head(8).items())
    more = f" and {len(counts) - 8} more" if len(counts) > 8 else ""
    return f"{name}: classes, {shown}{more}, {len(known)} values{missing}"


def parameter_codebook() -> dict[str, tuple[str, str, str]]:
    """Return of each column of a table of gait parameters its kind, unit and meaning."""
    return {name: tuple(about) for name, about in _words()["codebook"].items()}


def persons_in_words(traits: pd.DataFrame) -> list[str]:
    """Return who walked, by a table of traits, or what to do where that is not known.

    Nothing of walkers that were not captured.
    """
    column, persons = person_column(traits), persons_of(traits)
    if column is not None and persons is not None and (persons != "").any():
        return [_persons_of_column(column, persons)]
    if "file" not in traits:
        return []
    if column is not None:
        return ["Each walk counts as of another person."]
    sentences = [
        "No trait is known to say who walked, so each walk counts as of another person: if "
        "a person walked more than once, errors on new people will be higher."
    ]
    if like := columns_like_persons(traits):
        names = ", ".join(map(repr, like))
        way = f"take population.with_persons({like[0]!r})"
        sentences.append(f"The values of {names} repeat as persons do. If they are, {way}.")
    return sentences


def persons_in_report(traits: pd.DataFrame) -> list[str]:
    """Return what `persons_in_words` does, for readers of whom it is not known what they ran."""
    take = re.compile(r"take (population\.with_persons\('(.*?)'\))")
    return [
        take.sub(
            lambda found: f"give --person {shlex.quote(found[2])} ({found[1]} in Python)", each
        )
        for each in persons_in_words(traits)
    ]


def error_to_expect(model: TraitModel) -> str:
    """Return the error to expect of new people, in a sentence, with that of guessing."""
    from eigenwalker.analysis.several_classes import SeveralClasses

    found, n = model.validation, len(model.rows)
    whose = "" if model.population.persons is None else ", with all walks of their person"
    how = f"Of {n} walkers left out{whose}, of every choice"
    if isinstance(found, SeveralClasses):
        return (
            f"{how}, {found.errors} ({100 * found.error:.1f} %) are taken for another of the "
            f"{len(found.classes)} classes; guessing misses {100 * found.error_of_guessing:.0f} %."
        )
    if model.is_number:
        return (
            f"{how}, the error of {model.trait} is {found.rmse:.3g} (RMSE; R2 {found.r2:.2f}); "
            f"always answering the mean has {found.y.std():.3g}."
        )
    guess = min((found.y > 0).mean(), (found.y < 0).mean())
    return (
        f"{how}, {found.errors} ({100 * model.error:.1f} %) are misclassified; always answering "
        f"the more frequent class misses {100 * guess:.1f} %."
    )


def _persons_of_column(column: str, persons: np.ndarray) -> str:
    named = persons[persons != ""]
    n_persons = len(set(named))
    source = "" if column == PERSON else f", as the trait {column!r} says"
    unknown = len(persons) - len(named)
    rest = f"; of {unknown} nobody knows whose they are" if unknown else ""
    if n_persons == len(named):
        return f"Each walk is of another person{source}{rest}."
    sentence = (
        f"{len(named)} walks are of {n_persons} persons{source}{rest}. All walks of a person "
    )
    sentence += "are left out together."
    if column != PERSON:
        sentence += " If it says something else, take population.with_persons('none')."
    return sentence


def _length(millimetres: float) -> str:
    if millimetres >= 1e5:
        return f"{millimetres / 1e6:.3g} km"
    return f"{millimetres:.3g} mm" if millimetres < 1000 else f"{millimetres / 1000:.3g} m"


def _beside(value: float, *limits: float, digits: int) -> str:
    """Return a number with so many digits that it does not look like a limit which it is beyond."""
    texts = [f"{value:.{places}f}" for places in range(digits, 9)]
    return next((text for text in texts if float(text) not in limits), texts[-1])


def _other_unit(size_mm: float, unit: str) -> str:
    """Return how to read a body of this size, if there is a unit that makes a person of it."""
    units = UNITS | MILLIMETRES
    sizes = {name: max(size_mm, 1e-9) * units[name] / units.get(unit, 1.0) for name in units}
    nearest = min(sizes, key=lambda name: abs(np.log(sizes[name] / PERSON_MM)))
    if limit.HEIGHTS_MM[0] <= sizes[nearest] <= limit.HEIGHTS_MM[1]:
        return f"Read it with unit={nearest!r}."
    return "No unit makes a person of it: look at how it was exported."


def _values(quality: Quality) -> dict[str, object]:
    """Return what the sentences on findings name."""
    variation = quality.bone_length_variation
    form = _words()["wrong_joints"]
    wrong = [
        form[each.kind].format(*each.points, value=each.value) for each in quality.wrong_joints
    ]
    rigid = quality.rigid_variation
    limb = max(variation, key=lambda limb: variation[limb], default=("", ""))
    swaps = [repair_in_words(repair) for repair in quality.repairs if repair.kind == "swap"]
    jumping = dict.fromkeys(repair.marker for repair in quality.repairs if repair.kind == "jump")
    often = [name for name, share in quality.removed_share.items() if share > FLICKER_SHARE]
    return {
        "q": quality,
        "limit": limit,
        "height": _length(quality.height_mm),
        "size": _length(quality.size_mm),
        "way_out": _other_unit(quality.size_mm, quality.unit or "mm"),
        "slope": np.degrees(np.arctan(abs(quality.standing_slope))),
        "roll": abs(quality.roll_deg),
        "speed": quality.speed_mm_s / 1000,
        "backwards": -quality.speed_mm_s / 1000,
        "wrong_points": "Joints are not where those of people are"
        if all({*each.points} <= {*JOINTS.markers} for each in quality.wrong_joints)
        else "Labels are wrong",
        "wrong": "; ".join(wrong[:3]) + (f" and {len(wrong) - 3} more" if len(wrong) > 3 else ""),
        "wrong_unit": f"the unit {quality.unit or 'of length'} is wrong",
        "rises": "rises" if quality.climb > 0 else "falls",
        "rise": abs(quality.climb_mm),
        "elastic": rigid,
        "n_elastic": sum(share > rigid for share in variation.values()),
        "n_limbs": len(variation),
        "worst": f"{limb[0]} to {limb[1]}, "
        f"{_beside(100 * variation.get(limb, 0), 100 * rigid, digits=1)}%",
        "r2": _beside(quality.r2, limit.STEADY_R2, digits=2),
        "pace": _words()["pace"][
            "fast" if quality.frequency_hz > limit.FREQUENCIES_HZ[1] else "slow"
        ],
        "frequency": _beside(quality.frequency_hz, *limit.FREQUENCIES_HZ, digits=2),
        "repeated": ", ".join(quality.repeated),
        "swaps": "; ".join(swaps[:3]) + (f" and {len(swaps) - 3} more" if len(swaps) > 3 else ""),
        "often": ", ".join(often),
        "jumping": ", ".join(jumping),
    }


def summary_in_words(files: pd.DataFrame) -> dict[str, str]:
    """Return medians, ranges and counts of the captures of a study."""
    read = files[files["status"] != "refused"]
    lines = {}
    for column, values in summarise(files).iterrows():
        name, form = _words()["summary"][str(column)]
        median, least, most = map(float, values)
        lines[name] = _range(median, least, most, form)
    for column, name in (("jumps", "jumps"), ("left_right_swaps", "left-right swaps")):
        if column in read:
            n_captures = (read[column] > 0).sum()
            lines[name] = (
                f"{read[column].sum():.0f} in {n_captures} captures" if n_captures else "none"
            )
    if "rebuilt" in read and (rebuilt := (read["rebuilt"].fillna("") != "").sum()):
        lines["rebuilt markers"] = f"in {rebuilt} captures"
    if "unwound_deg" in read and (turning := (read["unwound_deg"] > 0).sum()):
        lines["turning walks unwound"] = str(turning)
    for column, name in (("marker_set", "marker set"), ("verdict", "verdict")):
        if column in read:
            counts = read[column].value_counts()
            lines[name] = ", ".join(f"{value} {count}" for value, count in counts.items())
    return lines


def summarise(files: pd.DataFrame) -> pd.DataFrame:
    """Return medians and ranges of the captures of a study.

    Parameters
    ----------
    files : DataFrame
        ``Study.files``: one row a capture.

    Returns
    -------
    DataFrame
        One row a measure, such as ``frequency_hz``; columns ``median``, ``least``, ``most``.
        Refused captures are left out.

    See Also
    --------
    fit_folder : Makes what it sums up.

    Examples
    --------
    >>> files = pd.DataFrame({"rate_hz": [100, 100, 120], "status": "used"})
    >>> summarise(files)
             median  least   most
    rate_hz   100.0  100.0  120.0
    """
    read = files[files["status"] != "refused"]
    columns = [name for name in _words()["summary"] if name in read and read[name].notna().any()]
    table = read[columns].agg(["median", "min", "max"]).T
    return table.rename(columns={"min": "least", "max": "most"})


def _range(median: float, least: float, most: float, form: str) -> str:
    low, high = (form.format(value).split(" ")[0] for value in (least, most))
    return form.format(median) + ("" if low == high else f" ({low} to {high})")


def inspection_in_words(facts: Mapping[str, object]) -> dict[str, str | list[str]]:
    """Return what `file_facts` finds, in words and with units."""
    facts = {
        name: plain_fact(value, "{:.1%}" if name == "bone_length_variation" else "{:.3g}")
        for name, value in facts.items()
    }
    if facts.get("kind") != "capture":
        return {
            name: _written(value, "{:.4g}" if isinstance(value, float) else "{}")
            for name, value in facts.items()
        }
    inspection = _words()["inspection"]
    written = {
        name: _written(facts[name], form) for name, (_, form) in inspection.items() if name in facts
    }
    if "n_strides" in facts:
        written["n_strides"] = _strides(facts)
    if "marker_set" in facts:
        written["marker_set"] = _marker_set(facts)
    if facts.get("rate_reason"):
        written["rate_hz"] += f", {facts['rate_reason']}"
    if facts.get("unit_guessed"):
        written["unit"] = f"{written.get('unit', 'unknown')}, guessed from the height of the body"
    return {inspection[name][0]: value for name, value in written.items()}


def plain_fact(value: object, number: str = "{:.3g}") -> Fact:
    """Return a value in types of JSON: NaN as None, each number of a mapping as a phrase."""
    if isinstance(value, Mapping):
        names = [key if isinstance(key, str) else " to ".join(key) for key in value]
        entries = zip(names, map(number.format, value.values()), strict=True)
        value = [f"{name}: {n}" for name, n in entries]
    if isinstance(value, list | tuple):
        return [printable(str(each)) for each in value]
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return value if value is None or isinstance(value, bool | int) else printable(str(value))


def _written(value: object, form: str) -> str | list[str]:
    if isinstance(value, list) or not form:
        return [str(entry) for entry in value] if isinstance(value, list) and value else "none"
    return "unknown" if value is None else form.format(value)


def _strides(facts: Mapping[str, object]) -> str:
    """Return how many strides were taken, and from where."""
    line = f"{facts['n_strides']}, {facts['steady_share']:.0%} of the time spent walking"
    if not facts["n_strides"] or facts["straight_passes"] == 1:
        return line
    if facts["straight_passes"] == 0:
        return f"{line}; the heading turned by {facts['unwound_deg']:.0f} degrees and was unwound"
    return f"{line}; from one of {facts['straight_passes']} straight passes"


def _marker_set(facts: Mapping[str, object]) -> str:
    """Return the marker set that was recognised, and how sure that is."""
    if facts["marker_set"] is None:
        return "unknown"
    share, next_best = facts.get("marker_set_share"), facts.get("marker_set_runner_up")
    line = str(facts["marker_set"])
    if line.endswith("own mapping"):
        return line
    if isinstance(share, float):
        line += f", {share:.0%} of its points found"
    return line + (f" (next is {next_best})" if next_best else "")
