"""A folder with the jsPsych plugin and a page that plays stimuli: a first experiment to edit."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from eigenwalker._version import __version__
from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.stimulus.html_page import MANNEQUIN, built
from eigenwalker.stimulus.stimulus import Stimulus

PAGE, STIMULI, PLUGIN = "index.html", "stimuli.js", "plugin-walker.js"
COPIED = (PLUGIN, MANNEQUIN, "jspsych.js", "jspsych.css", "licences.txt")
"""Built from ``frontend/`` when the package is."""


def write_plugin(
    stimuli: Mapping[str, Stimulus], folder: str | os.PathLike[str], *, force: bool = False
) -> list[str]:
    """Write the jsPsych plugin, jsPsych, stimuli by name, and a page that plays them.

    The page works from the disk and from any server, without a network. A page that was edited is
    left as it is; the rest is written anew.

    Parameters
    ----------
    stimuli : mapping of str to Stimulus
        By the names that the data will have.
    folder : path
        Made if it is not there.
    force : bool
        Whether to replace an edited page, and files of other programs.

    Returns
    -------
    list of str
        Names of the files that were left as they are.

    Raises
    ------
    FileExistsError
        If files with these names are there that this function did not make.
    """
    if not stimuli:
        raise ValueError("There is no stimulus to show; give one or more.")
    folder = Path(folder)
    texts = {name: built(name) for name in COPIED}
    texts[STIMULI] = stimuli_script(stimuli)
    page = files("eigenwalker.stimulus").joinpath("plugin_page.html").read_text("utf-8")
    texts[PAGE] = page.replace("@PROGRAM@", f"eigenwalker {__version__}")
    there = [name for name in texts if (folder / name).exists()]
    if there and PLUGIN not in there and not force:
        raise FileExistsError(
            f"{folder} has files {there} that no plugin folder has; choose another folder, or use "
            "--force to replace them."
        )
    keep = []
    if PAGE in there and not force and _edited(folder / PAGE, texts[PAGE]):
        keep.append(PAGE)
    folder.mkdir(parents=True, exist_ok=True)
    for name in texts.keys() - set(keep):
        with atomic_write(folder / name) as unfinished:
            unfinished.write_text(texts[name], encoding="utf-8")
    return keep


def stimuli_script(stimuli: Mapping[str, Stimulus]) -> str:
    """Return stimuli as a script: pages opened from the disk may not read other files."""
    items = ",\n".join(
        f'{{"name": {json.dumps(name)}, "stimulus": {stimulus.to_json().strip()}}}'
        for name, stimulus in stimuli.items()
    )
    about = "// Stimulus files by name, written by eigenwalker plugin.\n"
    script = f"{about}const STIMULI = [\n{items}\n];\n"
    if any(stimulus.display.style == "mannequin" for stimulus in stimuli.values()):
        script += (
            "// The module that draws mannequins, which pages from the disk cannot load either.\n"
            'document.head.append(Object.assign(document.createElement("script"), '
            '{ id: "mannequin", type: "text/plain", '
            f"textContent: {json.dumps(built(MANNEQUIN))} }}));\n"
        )
    return script


def _edited(path: Path, text: str) -> bool:
    """Whether a page is another than the one that was written, but for the program's version."""

    def without_program(page: str) -> str:
        return "\n".join(line for line in page.splitlines() if 'name="generator"' not in line)

    return without_program(path.read_text("utf-8", "replace")) != without_program(text)
