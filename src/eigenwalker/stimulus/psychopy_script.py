"""A PsychoPy script that shows a stimulus, with the positions of its dots beside it."""

from __future__ import annotations

from pathlib import Path

from eigenwalker.stimulus.position_tables import write_npz
from eigenwalker.stimulus.stimulus import Stimulus

SCRIPT = '''"""Shows {name} in PsychoPy; made by {program}. Needs {table} beside this file.

Each refresh shows the frame that is due by the clock, so that a screen of any rate keeps the tempo.
"""

from pathlib import Path

import numpy as np
from psychopy import core, event, visual

frames = np.load(Path(__file__).with_name({table!r}))
xy = frames["px"] - np.array([{width}, {height}]) / 2
xy[..., 1] *= -1  # PsychoPy counts upwards
opacities = frames["visible"].astype(float)

win = visual.Window(
    size=({width}, {height}), units="pix", color={background!r}, colorSpace="hex", fullscr=False
)
dots = visual.ElementArrayStim(
    win,
    units="pix",
    nElements=xy.shape[1],
    elementTex=None,
    elementMask="circle",
    sizes={dot_px!r},
    colors={colour!r},
    colorSpace="hex",
)
clock = core.Clock()
while clock.getTime() < {duration!r} and not event.getKeys():
    frame = min(int(clock.getTime() * {rate!r}), len(xy) - 1)
    dots.xys = np.nan_to_num(xy[frame])
    dots.opacities = opacities[frame]
    dots.draw()
    win.flip()
win.close()
'''


def write_psychopy(stimulus: Stimulus, path: Path) -> None:
    """Write a script, and an ``.npz`` of the same name with where each dot is in each frame."""
    table = path.with_suffix(".npz")
    write_npz(stimulus, table)
    display = stimulus.display
    script = SCRIPT.format(
        name=path.stem,
        program=stimulus.provenance.get("program", "eigenwalker"),
        table=table.name,
        width=display.width_px,
        height=display.height_px,
        background=display.background,
        colour=display.colour,
        dot_px=display.dot_px,
        duration=stimulus.timing.duration_s,
        rate=stimulus.timing.rate_hz,
    )
    path.write_text(script, encoding="utf-8")
