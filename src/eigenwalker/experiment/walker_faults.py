"""What a design asks of walkers that these walkers cannot give."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from eigenwalker.experiment.design import (
    POSITIVE,
    Adjustment,
    AnyBlock,
    Choice,
    Condition,
    Design,
    OddOneOut,
    Rating,
    SimilarPair,
)

Conflict = tuple[tuple[str | int, ...], str]
People = Mapping[str, Any]
"""``walkers``: their names; ``classes``: of traits with two; ``traits``: their two poles."""


def walker_faults(design: Design, people: People) -> list[Conflict]:
    """Return where the design asks for what there is not, and what to do."""
    return [
        *_wrong_number(design, len(people["walkers"])),
        *(
            (("conditions", number, *where), problem)
            for number, condition in enumerate(design.conditions)
            for where, problem in _wrong_condition(condition, people)
        ),
        *(
            (("blocks", number, *where), problem)
            for number, block in enumerate(design.blocks)
            for where, problem in _wrong_block(design, block, people)
        ),
    ]


def _wrong_number(design: Design, n_walkers: int) -> Iterator[Conflict]:
    wanted = design.walkers.number
    if wanted is not None and wanted > n_walkers:
        problem = f"the population has {n_walkers} walkers, not {wanted}; write {n_walkers} or less"
        yield ("walkers", "number"), problem


def _wrong_condition(condition: Condition, people: People) -> Iterator[Conflict]:
    if condition.trait is not None:
        yield from _wrong_trait(condition.trait, people)
    poles = people.get("traits", {}).get(condition.trait, [])
    toward = condition.toward
    if toward is not None and toward != POSITIVE and poles and toward not in poles:
        yield ("toward",), f"{toward!r} is no pole of {condition.trait}; write {_or(poles)}"
    needs_pole = condition.walker == "average" or condition.trait not in people["classes"]
    if condition.trait and condition.alpha and toward is None and needs_pole and poles:
        words = " or ".join(f'"{pole}"' for pole in poles)
        yield ("alpha",), f"it lacks the pole to move toward; add toward = {words}"
    if condition.transforms and (problem := wrong_transform(condition.transforms)):
        yield ("transforms",), problem


def _or(words: Sequence[str]) -> str:
    return " or ".join(map(repr, words))


def _wrong_trait(trait: str, people: People) -> Iterator[Conflict]:
    known = people.get("traits")
    if known is not None and trait not in known and "=" not in trait:
        problem = f"the walkers have no trait {trait!r}; known are {', '.join(known) or 'none'}"
        yield ("trait",), problem


def wrong_transform(transforms: Sequence[Mapping[str, Any]]) -> str | None:
    """Return what is wrong with the transforms of a condition, tried on a walker."""
    import numpy as np

    from eigenwalker.core.skeleton import JOINTS
    from eigenwalker.core.walker import Walker
    from eigenwalker.stimulus.make import make_stimulus

    names = JOINTS.markers
    places = np.random.default_rng(0).normal(0, 100, (5, len(names), 3))
    harmonics, phases = np.array([1, 1, 2, 2]), np.array([0, np.pi / 2, 0, np.pi / 2])
    made = make_stimulus(Walker(names, places[0], places[1:], harmonics, phases, 1.0))
    for step in transforms:
        given = {name: value for name, value in step.items() if name != "name"}
        try:
            made = made.then(str(step.get("name")), **given)
        except (ValueError, TypeError) as error:
            return f"{step.get('name')}: " + " ".join(str(error).split())
    return None


def _wrong_block(design: Design, block: AnyBlock, people: People) -> Iterator[Conflict]:
    n_walkers = min(design.walkers.number or len(people["walkers"]), len(people["walkers"]))
    needed = 4 if isinstance(block, SimilarPair) else 2 if hasattr(block, "differ") else 1
    if isinstance(block, OddOneOut) and block.all_differ:
        needed = block.figures
    if n_walkers < needed:
        yield (), f"it shows {needed} different walkers at once; there are {n_walkers}"
    if isinstance(block, Choice | Rating) and block.trials is not None:
        conditions = block.conditions or block.information
        there = n_walkers * len(conditions) * block.instances
        if block.trials > there:
            yield (
                ("trials",),
                (
                    f"there are {there} trials of {n_walkers} walkers, not {block.trials}; "
                    f"write {there} or less, or more instances"
                ),
            )
        if block.trials % len(conditions):
            yield (
                ("trials",),
                (
                    f"{block.trials} trials cannot be as many of each of {len(conditions)} "
                    f"conditions; write a multiple of {len(conditions)}"
                ),
            )
    if isinstance(block, Choice) and block.feedback:
        classes = [set(labels) for labels in people["classes"].values()]
        if set(block.choices) not in classes:
            words = " or ".join("/".join(sorted(each)) for each in classes) or "of none"
            yield (
                ("feedback",),
                (
                    f"the choices are no classes of the walkers ({words}), so that no answer is "
                    "right; take feedback out"
                ),
            )
    if isinstance(block, Adjustment):
        yield from _wrong_trait(block.trait, people)
