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
    "form": "--form {value}",
    "kind": "--kind {value}",
    "low_pass_hz": "--low-pass {value}",
    "mapping": "--mapping names.toml",
    "n_clusters": "--clusters {value}",
    "n_components": "--components {value}",
    "n_harmonics": "--harmonics {value}",
    "n_men": "--men {value}",
    "n_strides": "--strides {value}",
    "n_permutations": "--permutations {value}",
    "n_women": "--women {value}",
    "partial": "--partial {value}",
    "subject": "--subject {value}",
    "part": "--part {value}",
    "rate_hz": "--rate {value}",
    "up": "--up {value}",
    "skeleton": "--skeleton {value}",
    "rest_pose": "--rest-pose {value}",
    "size_px": "--size {value}",
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
    "stimulus.display.dot_px": "size of dots (px)",
    "stimulus.display.px_per_mm": "size of the walker (px per mm)",
    "stimulus.display.viewing_distance_mm": "--distance",
    "stimulus.display.px_per_cm": "--px-per-cm",
}
"""Options that give parts of a stimulus."""
_TRANSFORM = re.compile(r"stimulus\.transforms\[\d+\] \((\w+)\)\.?")
_PERSONS = re.compile(r"take population\.with_persons\('(.*?)'\)")
_of_this_command: dict[str, str] = {}


def use_options_of(command: Any) -> None:
    """Let messages name the options of a command, which is about to run."""
    options = {name for each in command.params for name in each.opts}
    _of_this_command.clear()
    _of_this_command.update({k: v for k, v in ARGUMENTS.items() if v.split()[0] in options})


def in_options(sentence: str) -> str:
    """Return a sentence that names options where it names arguments that the command has."""
    if sentence.startswith(next(iter(PLACES))):  # one made of options, not of a file
        for place, option in PLACES.items():
            sentence = sentence.replace(place, option)
        sentence = _TRANSFORM.sub(lambda found: f"--{found[1].replace('_', '-')} ", sentence)
    sentence = sentence.replace("take population.without_flags()", "give --with-flagged")
    sentence = _PERSONS.sub(lambda found: f"give --person {shlex.quote(found[1])}", sentence)
    return reworded(sentence, _of_this_command)
