"""The stimuli of a design: each walker in each condition, from each view."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np

from eigenwalker.analysis.contrast import Contrast
from eigenwalker.analysis.trait_axis import TraitAxis, trait_axis
from eigenwalker.core.walker import Walker
from eigenwalker.experiment.design import POSITIVE, Condition, Design
from eigenwalker.experiment.order import stimulus_name
from eigenwalker.population.population import Population
from eigenwalker.stimulus.make import make_stimulus, with_information
from eigenwalker.stimulus.stimulus import Stimulus


class ConditionStimuli:
    """Makes the stimuli of a design, size-normalised and of one height in degrees."""

    def __init__(self, design: Design, population: Population) -> None:
        self._design, self._population = design, population

    def of(self, number: int | None) -> Iterator[tuple[str, Stimulus]]:
        """Yield names and stimuli of a walker; of the average, where there is no number."""
        wanted = "average" if number is None else "own"
        for condition in self._design.shown:
            if condition.walker != wanted:
                continue
            walker = with_information(
                self._population, self._moved(number, condition), condition.information
            )
            for view in self._design.views_deg:
                yield (
                    stimulus_name(number, condition.name, view),
                    self._made(walker, condition, view),
                )

    def _made(self, walker: Walker, condition: Condition, view: float) -> Stimulus:
        picture = self._design.picture
        made = make_stimulus(
            walker,
            azimuth_deg=view,
            duration_s=condition.duration_s or picture.duration_s,
            style=condition.style or picture.style,
            size_px=(picture.size_px, picture.size_px),
            provenance=self._population.provenance,
        )
        made = self._sized(made)
        for step in condition.transforms:
            parameters = {name: value for name, value in step.items() if name != "name"}
            made = made.then(str(step.get("name")), **parameters)
        return made

    def _sized(self, made: Stimulus) -> Stimulus:
        """Return the walker at its height in degrees, in a picture without unused margins."""
        screen = self._design.screen
        return made.sized(
            self._design.picture.height_deg,
            viewing_distance_mm=screen.viewing_distance_mm,
            px_per_cm=screen.px_per_cm,
        )

    def _moved(self, number: int | None, condition: Condition) -> int | np.ndarray:
        """Return a walker moved along a trait: toward a pole, or the extreme of its own class."""
        if condition.trait is None or condition.alpha == 0:
            return self._population.average if number is None else number
        axis = self._axes[condition.trait]
        start = self._population.average if number is None else self._population.X[number]
        return start + condition.alpha * sign_of(axis.contrast, condition, number) * axis.step

    @cached_property
    def _axes(self) -> dict[str, TraitAxis]:
        traits = {each.trait for each in self._design.shown if each.trait is not None}
        return {name: trait_axis(self._population, name) for name in traits}


def sign_of(contrast: Contrast, condition: Condition, number: int | None) -> float:
    """Return the way along a trait: 1 toward its positive pole, -1 toward the other."""
    poles = {contrast.positive: 1.0, POSITIVE: 1.0, contrast.negative: -1.0}
    if condition.toward is not None:
        if condition.toward not in poles:
            raise ValueError(
                f"condition {condition.name!r}: the poles of {condition.trait} are "
                f"{contrast.negative!r} and {contrast.positive!r}, not {condition.toward!r}."
            )
        return poles[condition.toward]
    if number is None or not contrast.two_classes:
        raise ValueError(
            f"condition {condition.name!r} lacks the pole that it moves toward; add "
            f'toward = "{contrast.positive}" or "{contrast.negative}".'
        )
    found = contrast.y[contrast.rows == number]
    if not len(found):
        raise ValueError(
            f"condition {condition.name!r}: walker {number + 1} has no class of "
            f'{condition.trait}; add toward = "{contrast.positive}", or leave that walker out.'
        )
    return float(found[0])
