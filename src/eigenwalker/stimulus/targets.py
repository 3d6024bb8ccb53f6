"""What kinds of files cannot show of a stimulus: refused, or named in a warning."""

from __future__ import annotations

import warnings
from pathlib import Path

from eigenwalker.stimulus.stimulus import Stimulus

TABLES, ANIMATIONS = (".csv", ".npz", ".mat"), (".bvh", ".glb")
STYLES = ("sticks", "mannequin", "blur")
LEFT_OUT = {
    **dict.fromkeys(TABLES, (STYLES, "it holds where dots are, not how they are drawn")),
    **dict.fromkeys(
        ANIMATIONS,
        (
            (*STYLES, "hidden dots", "masks", "further figures"),
            "it holds the skeleton of the first figure",
        ),
    ),
}
"""Features that a kind of file leaves out, and why; that is said where a stimulus has them."""
REFUSED = {".py": STYLES}
"""Features with which a kind of file would show something else."""


def features_of(stimulus: Stimulus) -> list[str]:
    """Return what a stimulus has beyond the dots of one figure."""
    names = {step["name"] for step in stimulus.transforms}
    found = {
        "sticks": stimulus.display.style == "sticks",
        "mannequin": stimulus.display.style == "mannequin",
        "blur": "blur" in names,
        "hidden dots": "occlude" in names,
        "masks": "mask" in names,
        "further figures": len(stimulus.figures) > 1,
    }
    return [feature for feature, there in found.items() if there]


def check_target(stimulus: Stimulus, path: Path) -> None:
    """Refuse a file that would show something else than the stimulus; warn of what it leaves out.

    Raises ValueError.
    """
    suffix, features = path.suffix.lower(), features_of(stimulus)
    if lost := [each for each in features if each in REFUSED.get(suffix, ())]:
        raise ValueError(
            f"{path.name}: PsychoPy scripts draw dots; this stimulus has {' and '.join(lost)}. "
            "Write a film (.mp4), which PsychoPy's MovieStim plays, or show it as dots."
        )
    left_out, why = LEFT_OUT.get(suffix, ((), ""))
    if lost := [each for each in features if each in left_out]:
        warnings.warn(f"{path.name} leaves out {', '.join(lost)}: {why}.", stacklevel=3)
