"""What can be known of an experiment before anyone is invited."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from eigenwalker.experiment.balance import imbalances
from eigenwalker.experiment.design import Adjustment, Design, Figures, SimilarPair
from eigenwalker.experiment.experiment_folder import Material
from eigenwalker.experiment.order import Trial, session_trials, session_views, shown_walkers

ANSWER_S = 1.5
"""Assumed time until an answer, where one walker is shown."""
FIGURES_S, SETTING_S = 3.0, 10.0
"""The same, where two or three are compared, and where a slider is set."""
AROUND_MIN = 3.0
"""Assumed time for consent, screen and instructions."""
ORDER = ("seed", "group", "place", "session", "block", "trial", "stimuli", "view_deg", "condition")


def check_experiment(folder: Path, *, n_seeds: int = 1, order: Path | None = None) -> str:
    """Return order, balance and length of an experiment; raise ValueError with all faults.

    All observers' trials are drawn, of the design's seed and the following ones; those of the
    design's seed are written into the file `order`, if one is given.
    """
    material = Material(folder)
    if faults := material.faults():
        raise ValueError("\n".join(faults))
    design = material.design
    n_observers = sum(group.observers for group in design.groups)
    lines = [
        f"{design.name}, seed {design.seed}, version {material.hash()[:12]}",
        f"{_count(len(material.walkers), 'walker')}, "
        f"{_count(len(material.stimulus_names()), 'stimulus', 'stimuli')}, "
        f"{_count(n_observers, 'observer')}, {_count(design.n_sessions, 'session')} each",
    ]
    for group in design.groups:
        for session in range(design.n_sessions):
            lines += _session_lines(
                design, group.name, session, material.trials(group.name, 0, session)
            )
    if design.n_sessions > 1:
        lines.append("views of the sessions, by place in the group:")
        shown = min(max(group.observers for group in design.groups), 2 * design.n_sessions)
        lines += [
            f"  {place + 1}: {', '.join(f'{view:g}' for view in session_views(design, place))}"  # type: ignore[str-format]
            for place in range(shown)
        ]
    lines.append(_balance_line(material, n_seeds))
    if unused := [c.name for c in design.conditions if c not in design.shown]:
        lines.append(f"note: no block shows the conditions {', '.join(unused)}")
    if order is not None:
        lines.append(f"{_write_order(material, order)} trials of all observers: {order}")
    return "\n".join(lines)


def _count(number: int, one: str, many: str | None = None) -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


def _all_sessions(material: Material, seed: int) -> Iterator[tuple[str, int, int, list[Trial]]]:
    """Yield group, place, session and trials of all observers that a seed gives."""
    design = material.design.model_copy(update={"seed": seed})
    walkers = shown_walkers(design, len(material.walker_names))
    for group in design.groups:
        for place in range(group.observers):
            for session in range(design.n_sessions):
                yield (
                    group.name,
                    place,
                    session,
                    session_trials(
                        design,
                        walkers,
                        group=group.name,
                        place=place,
                        session=session,
                        classes=material.people["classes"],
                    ),
                )


def _balance_line(material: Material, n_seeds: int) -> str:
    """Say whether the orders of all observers and seeds are balanced and differ."""
    design = material.design
    wrong: Counter[str] = Counter()
    orders: Counter[int] = Counter()
    for seed in range(design.seed, design.seed + n_seeds):
        for group, _, session, trials in _all_sessions(material, seed % 2**32):
            wrong.update(imbalances(design, trials))
            shown = [name for trial in trials for name in (*trial["stimuli"], trial.get("begins"))]
            orders[hash((group, session, *shown))] += 1
    seeds = "" if n_seeds == 1 else f" of {n_seeds} seeds"
    n_orders = orders.total()
    if wrong:
        lines = [f"  {text} ({_count(number, 'session')})" for text, number in wrong.most_common()]
        return "\n".join([f"balance: not all {n_orders} orders{seeds} are balanced", *lines])
    same = n_orders - len(orders)
    differ = "all differ" if not same else f"{same} are as another"
    return f"balance: all {n_orders} orders{seeds} are balanced, {differ}"


def _write_order(material: Material, path: Path) -> int:
    """Write the trials of all observers as a table, and return how many there are."""
    number = 0
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(ORDER)
        seed = material.design.seed
        for group, place, session, trials in _all_sessions(material, seed):
            for trial in trials:
                number += 1
                values = (trial["block"], trial["trial"], " ".join(trial["stimuli"]))
                shown = (trial["view_deg"], trial["condition"])
                writer.writerow([seed, group, place + 1, session + 1, *values, *shown])
    return number


def _session_lines(design: Design, group: str, session: int, trials: list[Trial]) -> list[str]:
    counted = [trial for trial in trials if not trial.get("spare")]
    of_spare = len(trials) - len(counted)
    spare = f" and {of_spare} to replace those without an answer" if of_spare else ""
    lines = [
        f"group {group}, session {session + 1}: {_count(len(counted), 'trial')}{spare}, "
        f"some {minutes(design, counted):.0f} min"
    ]
    for number in dict.fromkeys(trial["block"] for trial in counted):
        block = [trial for trial in counted if trial["block"] == number]
        shown = Counter((trial["condition"], trial["view_deg"]) for trial in block)
        parts = [f"{count} {what} at {view:g} deg" for (what, view), count in sorted(shown.items())]
        walkers = Counter(walker for trial in block for walker in trial["walkers"])
        practice = " (practice)" if block[0]["practice"] else ""
        caught = sum(bool(trial.get("catch")) for trial in block)
        catch = f", {_count(caught, 'catch trial')}" if caught else ""
        lines.append(f"  block {number}{practice}: {', '.join(parts)}; {_times(walkers)}{catch}")
        first = ", ".join("/".join(map(str, trial["walkers"])) or "average" for trial in block[:8])
        lines.append(f"    begins with walkers {first}")
    return lines


def _times(walkers: Counter[int]) -> str:
    """Say how often walkers are shown."""
    if not walkers:
        return "the average walker"
    low, high = min(walkers.values()), max(walkers.values())
    if low == high:
        return f"each walker {'once' if low == 1 else f'{low} times'}"
    return f"each walker {low} to {high} times"


def minutes(design: Design, trials: Sequence[Trial]) -> float:
    """Return about how long a session takes."""
    seconds = 60 * AROUND_MIN
    for trial in trials:
        block = design.blocks[trial["block"] - 1]
        if isinstance(block, SimilarPair):
            seconds += block.limit_s * 0.6
        else:
            several, setting = isinstance(block, Figures), isinstance(block, Adjustment)
            seconds += SETTING_S if setting else FIGURES_S if several else ANSWER_S
        seconds += design.pace.blank_s + (design.pace.feedback_s if block.feedback else 0)
    return seconds / 60
