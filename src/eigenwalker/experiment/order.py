"""The trials of a session and their order, drawn from a seed: the same on every machine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, count, cycle, islice, product
from typing import Any

import numpy as np

from eigenwalker.experiment.design import (
    Adjustment,
    AnyBlock,
    Choice,
    Condition,
    Design,
    Detection,
    Figures,
    OddOneOut,
    Rating,
    SameOrDifferent,
    SimilarPair,
    n_figures,
    turn,
)
from eigenwalker.stimulus.random_streams import permutation, uniforms

PURPOSE = 1001
"""Names the random streams of experiments; those of stimuli have smaller numbers."""
_WALKERS = 2**32 - 1
"""The stream that draws walkers from the population."""
Classes = Mapping[str, Sequence[str]]
"""For each trait of two classes, the class of each walker of the population."""

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
    design: Design,
    walkers: Sequence[int],
    *,
    group: str,
    place: int,
    session: int = 0,
    classes: Classes | None = None,
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
    classes : mapping of str to sequence of str, optional
        For each trait of two classes, the class of each walker of the population: where the
        choices of a block are such classes, its trials have a right answer.

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
    draws = _Draws(design.seed, (number << 17 | place) << 4 | session)
    view = design.view_deg(design.group(group), session_views(design, place)[session])
    trials: list[Trial] = []
    for block_number, block in enumerate(design.blocks, 1):
        drawn = _Block(design, block, walkers, view, classes or {}, draws).trials()
        shared = {"block": block_number, "task": block.task, "practice": block.practice}
        trials += [{**shared, **trial} for trial in drawn]
    return [{"trial": number, **trial} for number, trial in enumerate(trials, 1)]


def trials_for_page(design: Design, trials: Sequence[Trial]) -> list[Trial]:
    """Return trials without right answers, but where the page needs them to go on."""
    needed = [block.feedback or isinstance(block, Detection) for block in design.blocks]
    return [
        trial
        if needed[trial["block"] - 1]
        else {name: value for name, value in trial.items() if name not in ("correct", "catch")}
        for trial in trials
    ]


def stimulus_name(walker: int | None, condition: str, view_deg: float) -> str:
    """Return the name of a stimulus, which is that of its file without the suffix."""
    who = "average" if walker is None else f"walker-{walker:02d}"
    return f"{who}_{condition}_view{view_deg:+g}"


class _Draws:
    """Random numbers of a session, one after the other; the same on every machine."""

    _LANES = 256

    def __init__(self, seed: int, session: int) -> None:
        self._seed, self._session = seed, session
        self._lives, self._left = count(), iter(())

    def _more(self) -> Iterator[float]:
        """A batch of numbers: four each of many streams, which is quicker than many of one."""
        first = next(self._lives) * self._LANES
        lives = np.arange(first, first + self._LANES)
        return iter(uniforms(PURPOSE, self._seed, self._session, lives, count=4).ravel().tolist())

    def number(self) -> float:
        """Return a number from 0 up to, not with, 1."""
        found = next(self._left, None)
        if found is None:
            self._left = self._more()
            found = next(self._left)
        return found

    def below(self, limit: int) -> int:
        """Return a whole number from 0 up to, not with, the limit."""
        return int(self.number() * limit)

    def shuffled(self, items: Sequence[Any]) -> list[Any]:
        """Return the items in random order (Fisher and Yates)."""
        order = [*items]
        for last in range(len(order) - 1, 0, -1):
            other = self.below(last + 1)
            order[last], order[other] = order[other], order[last]
        return order

    def halves(self, items: Sequence[Any], size: int) -> list[Any]:
        """Return items in random order, each as often as the others, or once more."""
        return self.shuffled([*islice(cycle(self.shuffled(items)), size)])

    def decks(self, items: Sequence[Any]) -> Iterator[Any]:
        """Yield all items in random order, then all in another, without an end."""
        while True:
            yield from self.shuffled(items)


class _Block:
    """Draws the trials of a block."""

    def __init__(
        self,
        design: Design,
        block: AnyBlock,
        walkers: Sequence[int],
        view: float,
        classes: Classes,
        draws: _Draws,
    ) -> None:
        self.design, self.block, self.walkers = design, block, walkers
        self.view, self.classes, self.draws = view, classes, draws

    def trials(self) -> list[Trial]:
        """Return the trials in the order in which they are shown."""
        match self.block:
            case SimilarPair():
                drawn = self._squares(self.block)
            case Detection():
                drawn = self._masked(self.block)
            case Adjustment():
                drawn = self._settings(self.block)
            case OddOneOut() if self.block.all_differ:
                drawn = self._all_different(self.block)
            case SameOrDifferent() | OddOneOut():
                drawn = self._alike_and_not(self.block)
            case Choice() | Rating():
                drawn = self._single_walkers(self.block)
        every = self.block.break_every
        for number, trial in enumerate(drawn, 1):
            if every is not None and number % every == 0 and number < len(drawn):
                trial["break_after"] = True
        return drawn

    def _single(self, walker: int, condition: Condition, view: float) -> Trial:
        """One walker in one condition; of the average, no walker."""
        who = None if condition.walker == "average" else walker
        trial: Trial = {
            "stimuli": [stimulus_name(who, condition.name, view)],
            "walkers": [] if who is None else [who],
            "information": condition.information,
            "condition": condition.name,
            "level": condition.level,
            "view_deg": view,
        }
        right = self._class_of(who) if condition.toward is None else None
        return trial if right is None else {**trial, "correct": right}

    def _class_of(self, walker: int | None) -> str | None:
        """Return which of the block's choices a walker is, where they are classes of a trait."""
        choices = getattr(self.block, "choices", None)
        if walker is None or not choices:
            return None
        for labels in self.classes.values():
            if set(labels) == set(choices):
                return labels[walker]
        return None

    def _single_walkers(self, block: Choice | Rating) -> list[Trial]:
        """Each walker in each version, `instances` times; signs of the view in equal numbers."""
        trials: list[Trial] = []
        for condition in self.design.shown_in(block):
            signs = self._signs(block.instances)
            places = product(range(block.instances), range(len(self.walkers)))
            for (instance, place), sign in zip(places, signs, strict=True):
                trial = self._single(self.walkers[place], condition, sign * self.view + 0.0)
                trials.append({**trial, "instance": instance + 1})
        if block.trials is not None:
            trials = self._some(trials, block.trials)
        for catch in block.catch:
            condition = self.design.condition(catch.condition)
            signs = self.draws.halves(self._both, catch.number)
            for walker, sign in zip(self.draws.decks(self.walkers), signs, strict=False):
                trial = self._single(walker, condition, sign * self.view + 0.0)
                trials.append({**trial, "instance": 1, "catch": True, "correct": catch.right})
        return self.draws.shuffled(trials)

    def _some(self, trials: Sequence[Trial], number: int) -> list[Trial]:
        """Draw trials, of each condition and sign of the view as many as of the others."""
        kinds: dict[Any, list[Trial]] = {}
        for trial in self.draws.shuffled(trials):
            kinds.setdefault((trial["condition"], trial["view_deg"]), []).append(trial)
        in_turn = self.draws.shuffled([*kinds])
        drawn: list[Trial] = []
        while len(drawn) < number and any(kinds.values()):
            drawn += [kinds[kind].pop() for kind in in_turn if kinds[kind]]
        return drawn[:number]

    @property
    def _both(self) -> tuple[int, ...]:
        """Signs of the view that the block shows."""
        both = self.design.picture.both_signs and self.view not in (0, 180, -180)
        return (1, -1) if both else (1,)

    def _signs(self, instances: int) -> list[int]:
        """Signs of the view by instance: alternating within a walker, balanced over walkers."""
        start = self.draws.halves(self._both, len(self.walkers))
        turns = len(self._both) > 1
        return [
            sign * (-1 if turns and instance % 2 else 1)
            for instance in range(instances)
            for sign in start
        ]

    def _masked(self, block: Detection) -> list[Trial]:
        """Half of the trials with a walker; the answers decide which level of it is shown."""
        half = self.draws.halves((True, False), block.trials)
        signs = self.draws.halves(self._both, block.trials)
        trials: list[Trial] = []
        decks = self.draws.decks(self.walkers)
        for walker, is_there, sign in zip(decks, half, signs, strict=False):
            view = sign * self.view + 0.0
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

    def _settings(self, block: Adjustment) -> list[Trial]:
        """Sliders that begin anywhere; the start tells nothing of the answer."""
        who = [None] if block.walker == "average" else self.walkers
        size = block.instances * len(who)
        begins = [self.draws.below(block.steps) for _ in range(size)]
        signs = self.draws.halves(self._both, size)
        names = [block.condition(place).name for place in range(block.steps)]
        drawn = self.draws.shuffled([*product(who, range(block.instances))])
        return [
            {
                "stimuli": [stimulus_name(walker, name, sign * self.view + 0.0) for name in names],
                "walkers": [] if walker is None else [walker],
                "levels": block.levels,
                "begins": begin,
                "information": "full",
                "condition": block.trait,
                "view_deg": sign * self.view + 0.0,
                "instance": instance + 1,
            }
            for (walker, instance), begin, sign in zip(drawn, begins, signs, strict=True)
        ]

    def _figures(
        self, block: SimilarPair | Figures, shown: Sequence[tuple[int, Condition]], sign: int
    ) -> Trial:
        """Several walkers at once, in the places in which they are given."""
        view = sign * self.view + 0.0
        by = getattr(block, "turn_deg", 0.0)
        trial: Trial = {
            "stimuli": [
                stimulus_name(walker, condition.name, turn(view, place * by) + 0.0)
                for place, (walker, condition) in enumerate(shown)
            ],
            "walkers": [walker for walker, _ in shown],
            "conditions": [condition.name for _, condition in shown],
            "information": "/".join(dict.fromkeys(each.information for _, each in shown)),
            "condition": "/".join(dict.fromkeys(each.name for _, each in shown)),
            "view_deg": view,
        }
        if getattr(block, "random_start", False):
            trial["starts"] = [round(self.draws.number(), 6) for _ in shown]
        return trial

    def _squares(self, block: SimilarPair) -> list[Trial]:
        """Four different walkers in random places, all walkers equally often; spares come last."""
        [condition] = self.design.shown_in(block)
        size = block.trials + block.spare_trials
        signs = self.draws.halves(self._both, block.trials)
        signs += self.draws.halves(self._both, block.spare_trials)
        groups = _different(self.draws.decks(self.walkers), 4)
        drawn: list[Trial] = []
        for number, four, sign in zip(range(size), groups, signs, strict=False):
            shown = [(walker, condition) for walker in self.draws.shuffled(four)]
            trial = self._figures(block, shown, sign)
            drawn.append({**trial, "spare": number >= block.trials})
        return drawn

    def _all_different(self, block: OddOneOut) -> list[Trial]:
        conditions = self.design.shown_in(block)
        signs = self.draws.halves(self._both, block.trials)
        groups = _different(self.draws.decks(self.walkers), block.figures)
        shown = self.draws.halves(conditions, block.trials)
        return [
            self._figures(block, [(walker, each) for walker in self.draws.shuffled(some)], sign)
            for some, each, sign in zip(groups, shown, signs, strict=False)
        ]

    def _alike_and_not(self, block: SameOrDifferent | OddOneOut) -> list[Trial]:
        """Walkers alike but for one: another person, or the same person in another condition."""
        conditions = self.design.shown_in(block)
        pairs = [*combinations(conditions, 2)] if block.differ == "conditions" else []
        kinds = [*(pairs or [(each, each) for each in conditions])]
        size = block.trials
        signs = self.draws.halves(self._both, size)
        walkers = _different(self.draws.decks(self.walkers), 2)
        odd = isinstance(block, OddOneOut)
        differ = [True] * size if odd else self.draws.halves((True, False), size)
        of_kind = {True: self.draws.decks(kinds), False: self.draws.decks(kinds)}
        number = n_figures(block)
        places = self.draws.halves(range(number), size) if odd else [0] * size
        trials: list[Trial] = []
        for two, other, sign, place in zip(walkers, differ, signs, places, strict=False):
            one, another = self.draws.shuffled(next(of_kind[other]))
            if block.differ == "conditions":
                usual, unlike = (two[0], one), (two[0], another if other else one)
            else:
                usual, unlike = (two[0], one), (two[1] if other else two[0], one)
            shown = [usual] * number
            shown[place] = unlike
            trial = self._figures(block, shown, sign)
            if isinstance(block, OddOneOut):
                trial["correct"] = place
            else:
                trial["correct"] = block.choices[int(other)]
            trials.append(trial)
        return trials


def _different(items: Iterator[Any], number: int) -> Iterator[list[Any]]:
    """Yield groups of different items, which are taken in turn as far as they differ."""
    waiting: list[Any] = []
    while True:
        group: list[Any] = []
        for place, item in enumerate([*waiting]):
            if len(group) < number and item not in group:
                group.append(item)
                waiting[place] = None
        waiting = [item for item in waiting if item is not None]
        while len(group) < number:
            item = next(items)
            if item in group:
                waiting.append(item)
            else:
                group.append(item)
        yield group
