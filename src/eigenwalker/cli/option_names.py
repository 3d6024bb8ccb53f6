"""Messages in the words of the command line: options in place of arguments of Python."""

from __future__ import annotations

import re
import shlex
from typing import Any

from eigenwalker.core.wording import reworded

ARGUMENTS = {
    "accept_licence": "--accept-licence",
    "default_rate_hz": "--rate {value}",
    "default_unit": "--unit {value}",
    "duration_s": "--duration {value}",
    "eye_distance_mm": "--eye-distance {value}",
    "elevation_deg": "--elevation {value}",
    "form": "--form {value}",
    "format": "--captures-as {value}",
    "information": "--information {value}",
    "kind": "--kind {value}",
    "low_pass_hz": "--low-pass {value}",
    "mapping": "--mapping names.toml",
    "n_people": "--crowd {value}",
    "n_clusters": "--clusters {value}",
    "n_components": "--components {value}",
    "n_harmonics": "--harmonics {value}",
    "n_jobs": "--jobs {value}",
    "n_men": "--men {value}",
    "n_strides": "--strides {value}",
    "n_permutations": "--permutations {value}",
    "n_women": "--women {value}",
    "partial": "--partial {value}",
    "subject": "--subject {value}",
    "part": "--part {value}",
    "rate_hz": "--rate {value}",
    "seed": "--seed {value}",
    "sex_effect": "--sex-effect {value}",
    "up": "--up {value}",
    "skeleton": "--skeleton {value}",
    "rest_pose": "--rest-pose {value}",
    "size_px": "--size {value}",
    "trait_from_name": "--trait-from-name {value}",
    "unit": "--unit {value}",
}
"""Options that give arguments of Python, which messages name."""
PLACES = {
    "This is no stimulus: ": "",
    "stimulus.view.view_deg": "--view",
    "stimulus.view.elevation_deg": "--elevation",
    "stimulus.view.eye_distance_mm": "--eye-distance",
    "stimulus.timing.duration_s": "--duration",
    "stimulus.timing.rate_hz": "--rate",
    "stimulus.display.width_px": "--size (width)",
    "stimulus.display.height_px": "--size (height)",
    "stimulus.display.style": "--style",
    "stimulus.display.dot_px": "--dot-px",
    "stimulus.display.viewing_distance_mm": "--distance",
    "stimulus.display.px_per_cm": "--px-per-cm",
}
"""Options that give parts of a stimulus."""
_TRANSFORM = re.compile(r"stimulus\.transforms\[\d+\] \((\w+)\)(?:\.(\w+))?")
_ONE_NUMBER = {"speed": "factor", "start": "phase_deg", "freeze": "time_s"}
"""Transforms whose option is one number, which has this name in files."""
_WALKER = re.compile(r"stimulus\.figures\[\d+\]\.walker\.(\w+)")
_PERSONS = re.compile(r"take population\.with_persons\('(.*?)'\)")
_of_this_command: dict[str, str] = {}


OTHER_NAMES = {"trait_from_name": "--person-from-name {value}"}
"""Options that give the same argument in other commands."""


def use_options_of(command: Any) -> None:
    """Let messages name the options of a command, which is about to run."""
    options = {name for each in command.params for name in each.opts}
    _of_this_command.clear()
    for names in (OTHER_NAMES, ARGUMENTS):
        _of_this_command.update({k: v for k, v in names.items() if v.split()[0] in options})


def _typed(text: str) -> str:
    """Return a text as it is typed, between quotation marks where a shell needs them."""
    return text if shlex.quote(text) == text else repr(text)


def _option_of(found: re.Match[str]) -> str:
    """Return the option of a transform, and which of its parameters a problem is about."""
    option = f"--{found[1].replace('_', '-')}"
    if found[2] is None or _ONE_NUMBER.get(found[1]) == found[2]:
        return option
    return f"{option} {found[2]}"


def in_options(sentence: str) -> str:
    """Return a sentence that names options where it names arguments that the command has."""
    if sentence.startswith(next(iter(PLACES))):  # one made of options, not of a file
        for place, option in PLACES.items():
            sentence = sentence.replace(place, option)
        sentence = _WALKER.sub(r"the walker moved so far has no possible \1", sentence)
        sentence = _TRANSFORM.sub(_option_of, sentence)
    sentence = sentence.replace("take population.without_flags()", "give --with-flagged")
    sentence = _PERSONS.sub(lambda found: f"give --person {shlex.quote(found[1])}", sentence)
    return reworded(sentence, _of_this_command, written=_typed)
