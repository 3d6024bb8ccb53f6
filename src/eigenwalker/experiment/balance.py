"""Whether the trials of a session are balanced: walkers, conditions, sides, right answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from eigenwalker.experiment.design import (
    Adjustment,
    AnyBlock,
    Choice,
    Design,
    Detection,
    OddOneOut,
    Rating,
    SameOrDifferent,
    SimilarPair,
)
from eigenwalker.experiment.order import Trial


def imbalances(design: Design, trials: Sequence[Trial]) -> list[str]:
    """Return what is not balanced in the trials of a session."""
    found: list[str] = []
    for number, block in enumerate(design.blocks, 1):
        of_block = [t for t in trials if t["block"] == number and not t.get("catch")]
        found += [f"block {number}: {text}" for text in _of_block(design, block, of_block)]
    return found


def _of_block(design: Design, block: AnyBlock, trials: list[Trial]) -> Iterator[str]:
    counted = [trial for trial in trials if not trial.get("spare")]
    sides: dict[str, list[float]] = {}
    for trial in counted if isinstance(block, Choice | Rating) else ():
        sides.setdefault(trial["condition"], []).append(trial["view_deg"])
    if not all(map(_even, sides.values())):
        yield "one side of the view is shown more often"
    match block:
        case Choice() | Rating():
            yield from _of_single(design, block, counted)
        case SimilarPair():
            if any(len(set(trial["walkers"])) < 4 for trial in trials):
                yield "a walker is twice in a square"
            if not _even(walker for trial in counted for walker in trial["walkers"]):
                yield "some walkers are shown more often"
        case SameOrDifferent() | Detection():
            if not _even(trial["correct"] for trial in counted):
                yield "one answer is right more often"
            if isinstance(block, SameOrDifferent) and any(_wrong_pair(block, t) for t in counted):
                yield "a pair is not as its right answer says"
        case OddOneOut():
            yield from _of_odd(block, counted)
        case Adjustment():
            if not _even(str(trial["walkers"]) for trial in counted):
                yield "some walkers are set more often"


def _of_single(design: Design, block: Choice | Rating, trials: list[Trial]) -> Iterator[str]:
    shown = Counter((str(t["walkers"]), t["condition"], t["instance"]) for t in trials)
    if max(shown.values(), default=0) > 1:
        yield "a walker is shown twice in one condition"
    if not _even(trial["condition"] for trial in trials):
        yield "some conditions are shown more often"
    if block.trials is None and not _even(
        (str(trial["walkers"]), trial["condition"]) for trial in trials
    ):
        yield "some walkers are shown more often"


def _of_odd(block: OddOneOut, trials: list[Trial]) -> Iterator[str]:
    if block.all_differ:
        if any(len(set(trial["walkers"])) < block.figures for trial in trials):
            yield "a walker is twice in a trial"
        return
    if not _even(trial["correct"] for trial in trials):
        yield "the odd one is in one place more often"
    for trial in trials:
        shown = Counter(_figures(trial))
        if len(shown) != 2 or shown[_figures(trial)[trial["correct"]]] != 1:
            yield "not one figure is the odd one"


def _wrong_pair(block: SameOrDifferent, trial: Trial) -> bool:
    one, other = _figures(trial)
    return (one == other) != (trial["correct"] == block.choices[0])


def _figures(trial: Trial) -> list[tuple[int, str]]:
    return [*zip(trial["walkers"], trial["conditions"], strict=True)]


def _even(values: Iterable[Any]) -> bool:
    """Return whether all values are as frequent as the others, or once more."""
    counts = Counter(values).values()
    return not counts or max(counts) - min(counts) <= 1
