"""The trials of a session and their order, drawn from a seed: the same on every machine."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count, product
from typing import Any

import numpy as np

from eigenwalker.experiment.design import Design, Detection, SimilarPair
from eigenwalker.stimulus.random_streams import permutation, uniforms

PURPOSE = 1001
"""Names the random streams of experiments; those of stimuli have smaller numbers."""
_DRAWS = 4096
"""Streams for each session."""
_WALKERS = 2**32 - 1
"""The stream that draws walkers from the population."""

Trial = dict[str, Any]


def shown_walkers(design: Design, n_walkers: int) -> list[int]:
    """Return the numbers of the walkers that an experiment shows, in ascending order."""
    wanted = design.walkers.number or n_walkers
    if wanted > n_walkers:
        raise ValueError(
            f"walkers.number is {wanted}, but the population has {n_walkers} walkers; "
            f"write {n_walkers} or less."
        )
    drawn = permutation(PURPOSE, design.seed, _WALKERS, size=n_walkers)
    return sorted(drawn[:wanted].tolist())


def session_views(design: Design, place: int) -> list[float | None]:
    """Return the views of an observer's sessions: rows of a Latin square, then their mirrors."""
    views = design.sessions.views_deg
    if not views:
        return [None]
    n = len(views)
    row = [views[(place + shift) % n] for shift in range(n)]
    return [*row] if place // n % 2 == 0 else [*reversed(row)]


def session_trials(
    design: Design, walkers: Sequence[int], *, group: str, place: int, session: int = 0
) -> list[Trial]:
    """Return the trials of one session in the order in which they are shown.

    Parameters
    ----------
    design : Design
    walkers : sequence of int
        Numbers of the walkers that are shown.
    group : str
        The observer's group.
    place : int
        The observer's place in the group, from 0.
    session : int
        Which of the observer's sessions, from 0.

    Returns
    -------
    list of dict
        ``trial`` (from 1), ``block``, ``task``, the names of the stimuli and what they show.

    See Also
    --------
    read_design : The design of a file.

    References
    ----------
    Troje (2002), Methods, experiment; Troje (2002, WDP); Prazak et al. (2010), section 4.
    """
    number = [each.name for each in design.groups].index(group)
    first = ((number * 100_003 + place) * 31 + session) * _DRAWS
    streams = count(first)
    view = design.view_deg(design.group(group), session_views(design, place)[session])
    trials: list[Trial] = []
    for block_number, block in enumerate(design.blocks, 1):
        if isinstance(block, SimilarPair):
            drawn = _squares(design, block, walkers, view, streams)
        elif isinstance(block, Detection):
            drawn = _masked(design, block, walkers, view, streams)
        else:
            drawn = _single_walkers(design, block, walkers, view, streams)
        shared = {"block": block_number, "task": block.task, "practice": block.practice}
        trials += [{**shared, **trial} for trial in drawn]
    return [{"trial": number, **trial} for number, trial in enumerate(trials, 1)]


def stimulus_name(walker: int, condition: str, view_deg: float) -> str:
    """Return the name of a stimulus, which is that of its file without the suffix."""
    return f"walker-{walker:02d}_{condition}_view{view_deg:+g}"


def _shuffled(design: Design, streams: count[int], items: Sequence[Any]) -> list[Any]:
    order = permutation(PURPOSE, design.seed, next(streams) % 2**32, size=len(items))
    return [items[place] for place in order.tolist()]


def _single_walkers(
    design: Design, block: Any, walkers: Sequence[int], view: float, streams: count[int]
) -> list[Trial]:
    """Each walker in each version, `instances` times; signs of the view in equal numbers."""
    trials: list[Trial] = []
    for condition in design.shown_in(block):
        signs = _signs(design, walkers, block.instances, view, streams)
        for (instance, place), sign in zip(
            product(range(block.instances), range(len(walkers))), signs, strict=True
        ):
            seen = sign * view + 0.0
            trials.append(
                {
                    "stimuli": [stimulus_name(walkers[place], condition.name, seen)],
                    "walkers": [walkers[place]],
                    "information": condition.information,
                    "condition": condition.name,
                    "level": condition.level,
                    "view_deg": seen,
                    "instance": instance + 1,
                }
            )
    return _shuffled(design, streams, trials)


def _signs(
    design: Design, walkers: Sequence[int], instances: int, view: float, streams: count[int]
) -> list[int]:
    """Signs of the view, instance by instance: alternating within a walker, balanced over them."""
    if not design.picture.both_signs or view in (0, 180, -180):
        return [1] * (instances * len(walkers))
    half = [1, -1] * ((len(walkers) + 1) // 2)
    start = _shuffled(design, streams, half[: len(walkers)])
    return [sign * (-1) ** instance for instance in range(instances) for sign in start]


def _masked(
    design: Design, block: Detection, walkers: Sequence[int], view: float, streams: count[int]
) -> list[Trial]:
    """Half of the trials with a walker; the answers decide which of a trial's levels is shown."""
    shown: list[int] = []
    while len(shown) < block.trials:
        shown += _shuffled(design, streams, walkers)
    half = [True, False] * ((block.trials + 1) // 2)
    present = _shuffled(design, streams, half[: block.trials])
    trials: list[Trial] = []
    for walker, is_there in zip(shown, present, strict=False):
        seen = [block.condition(dots, is_there, 0).name for dots in block.mask_dots]
        trials.append(
            {
                "stimuli": [stimulus_name(walker, name, view) for name in seen],
                "walkers": [walker],
                "levels": block.mask_dots,
                "correct": block.choices[0] if is_there else block.choices[1],
                "information": "full",
                "condition": "present" if is_there else "absent",
                "view_deg": view,
            }
        )
    return trials


def _squares(
    design: Design, block: SimilarPair, walkers: Sequence[int], view: float, streams: count[int]
) -> list[Trial]:
    """Four different walkers in random places, a trial; spare trials come last."""
    if len(walkers) < 4:
        raise ValueError(f"A square shows four walkers; the design has {len(walkers)}.")
    trials: list[Trial] = []
    for number in range(block.trials + block.spare_trials):
        drawn = uniforms(PURPOSE, design.seed, next(streams) % 2**32, count=len(walkers))
        four = [walkers[place] for place in np.argsort(drawn, kind="stable")[:4].tolist()]
        trials.append(
            {
                "stimuli": [stimulus_name(walker, "full", view) for walker in four],
                "walkers": four,
                "information": "full",
                "condition": "full",
                "view_deg": view,
                "spare": number >= block.trials,
            }
        )
    return trials
