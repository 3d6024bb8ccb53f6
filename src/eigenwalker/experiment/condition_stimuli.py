"""The stimuli of a design: each walker in each condition, from each view."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

import numpy as np

from eigenwalker.analysis.trait_axis import trait_axis
from eigenwalker.experiment.design import Condition, Design
from eigenwalker.experiment.order import stimulus_name
from eigenwalker.population.population import Population
from eigenwalker.stimulus.make import make_stimulus, with_information
from eigenwalker.stimulus.stimulus import Stimulus


class ConditionStimuli:
    """Makes the stimuli of a design, size-normalised and of one height in degrees."""

    def __init__(self, design: Design, population: Population) -> None:
        self._design, self._population = design, population

    def of(self, number: int) -> Iterator[tuple[str, Stimulus]]:
        """Yield names and stimuli of a walker."""
        for condition in self._design.shown:
            walker = with_information(
                self._population, self._moved(number, condition), condition.information
            )
            for view in self._design.views_deg:
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
                yield stimulus_name(number, condition.name, view), made

    def _sized(self, made: Stimulus) -> Stimulus:
        """Return the walker at its height in degrees, in a picture without unused margins."""
        screen = self._design.screen
        return made.sized(
            self._design.picture.height_deg,
            viewing_distance_mm=screen.viewing_distance_mm,
            px_per_cm=screen.px_per_cm,
        )

    def _moved(self, number: int, condition: Condition) -> int | np.ndarray:
        """Return a walker, moved toward the extreme of its own class of a trait."""
        if condition.trait is None or condition.alpha == 0:
            return number
        axis, toward = self._axes[condition.trait]
        return self._population.X[number] + condition.alpha * toward[number] * axis

    @cached_property
    def _axes(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """The step of each trait, and for each walker the sign of its class along it."""
        traits = {each.trait for each in self._design.shown if each.trait is not None}
        found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        for name in traits:
            labels = self._population.traits[name].astype(str).to_numpy()
            positive = sorted(set(labels))[-1]  # as axes of two classes have it
            axis = trait_axis(self._population, name)
            found[name] = (axis.step, np.where(labels == positive, 1.0, -1.0))
        return found
