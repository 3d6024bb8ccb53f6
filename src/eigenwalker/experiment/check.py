"""What can be known of an experiment before anyone is invited."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from eigenwalker.experiment.design import Design, SimilarPair
from eigenwalker.experiment.experiment_folder import Material
from eigenwalker.experiment.order import Trial, session_trials, session_views

ANSWER_S = 1.5
"""Assumed time until an answer, where the stimulus ends with it."""


def check_experiment(folder: Path) -> str:
    """Return order, balance and length of an experiment; raise ValueError with all faults."""
    material = Material(folder)
    if faults := material.faults():
        raise ValueError("\n".join(faults))
    design = material.design
    lines = [
        f"{design.name}, seed {design.seed}, version {material.hash()[:12]}",
        f"{len(material.walkers)} walkers, {len(material.stimulus_names())} stimuli, "
        f"{sum(group.observers for group in design.groups)} observers, "
        f"{design.n_sessions} {'session' if design.n_sessions == 1 else 'sessions'} each",
    ]
    for group in design.groups:
        for session in range(design.n_sessions):
            trials = session_trials(
                design, material.walkers, group=group.name, place=0, session=session
            )
            lines += _session_lines(design, group.name, session, trials)
    if design.n_sessions > 1:
        lines.append("views of the sessions, by place in the group:")
        lines += [
            f"  {place + 1}: {', '.join(f'{view:g}' for view in session_views(design, place))}"  # type: ignore[str-format]
            for place in range(max(group.observers for group in design.groups))
        ]
    return "\n".join(lines)


def _session_lines(design: Design, group: str, session: int, trials: list[Trial]) -> list[str]:
    counted = [trial for trial in trials if not trial.get("spare")]
    lines = [
        f"group {group}, session {session + 1}: {len(counted)} trials, "
        f"some {minutes(design, counted):.0f} min"
    ]
    for number in dict.fromkeys(trial["block"] for trial in counted):
        block = [trial for trial in counted if trial["block"] == number]
        shown = Counter((trial["condition"], trial["view_deg"]) for trial in block)
        parts = [f"{count} {what} at {view:g} deg" for (what, view), count in sorted(shown.items())]
        walkers = Counter(walker for trial in block for walker in trial["walkers"])
        low, high = min(walkers.values()), max(walkers.values())
        times = f"{low}" if low == high else f"{low} to {high}"
        lines.append(f"  block {number}: {', '.join(parts)}; each walker {times} times")
        first = ", ".join("/".join(map(str, trial["walkers"])) for trial in block[:8])
        lines.append(f"    begins with walkers {first}")
    return lines


def minutes(design: Design, trials: list[Trial]) -> float:
    """Return about how long trials take."""
    seconds = 0.0
    for trial in trials:
        block = design.blocks[trial["block"] - 1]
        shown = block.limit_s * 0.6 if isinstance(block, SimilarPair) else ANSWER_S
        seconds += shown + design.pace.blank_s
    return seconds / 60
