"""The tables of the main job's report, in words and units."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from eigenwalker.analysis.classification import N_PANELS, Classification, Regression
from eigenwalker.analysis.plausibility import Plausibility
from eigenwalker.core.walker import Walker
from eigenwalker.gait.parameters import gait_parameters
from eigenwalker.population.population import Population
from eigenwalker.report.blocks import Table

_GAIT = {
    "frequency_hz": ("strides a second (Hz)", 1, 2),
    "cadence_steps_min": ("steps a minute", 1, 0),
    "speed_mm_s": ("speed (m/s)", 1e-3, 2),
    "stride_time_s": ("stride, time (s)", 1, 2),
    "stride_length_mm": ("stride, length (mm)", 1, 0),
    "step_length_left_mm": ("left step, length (mm)", 1, 0),
    "step_length_right_mm": ("right step, length (mm)", 1, 0),
    "step_width_mm": ("steps, width (mm)", 1, 0),
    "step_asymmetry": ("step lengths, left beyond right (%)", 100, 1),
    "stance_share_left": ("left foot stands (% of the stride)", 100, 1),
    "stance_share_right": ("right foot stands (% of the stride)", 100, 1),
    "stance_asymmetry": ("standing, left beyond right (%)", 100, 1),
    "double_support_share": ("both feet stand (% of the stride)", 100, 1),
    "pelvis_vertical_range_mm": ("pelvis, vertical range (mm)", 1, 0),
}
"""Words and unit of each gait parameter, what to multiply it with, and decimals. How stride times
vary is not among them: a walker's are all the same."""


def results_table(found: Classification | Regression) -> Table:
    """Return how well a trait is told from each input."""
    out = "persons" if found.contrast.persons is not None else "walkers"
    words = printed_results(found)
    return Table(
        f"Told of {out} left out one at a time",
        [str(column) for column in words],
        words.to_numpy(dtype=object).tolist(),
    )


def printed_results(found: Classification | Regression) -> pd.DataFrame:
    """Return the results as printed: "-" where there is nothing, p with its lower limit."""
    least = 1 / (1 + found.n_permutations)

    def printed_p(p: float) -> str:
        if not found.n_permutations:
            return "-"
        return f"<= {least:.2g}" if p <= least else f"{p:.2g}"

    def cell(value: object) -> str:
        if value is None or value is pd.NA or value != value:
            return "-"
        return f"{value:.3g}" if isinstance(value, float) else str(value)

    table = found.table()
    printed = pd.DataFrame({name: [cell(value) for value in table[name]] for name in table})
    return printed.assign(p=[printed_p(p) for p in table["p"]])


def chance_sentence(found: Classification | Regression) -> str:
    """Return what to hold the errors against: those of always giving the same answer."""
    contrast = found.contrast
    if isinstance(found, Regression):
        return f"Always answering the mean has an RMSE of {contrast.y.std():.3g}."
    sizes = [int((contrast.y < 0).sum()), int((contrast.y > 0).sum())]
    errors = "1 error" if min(sizes) == 1 else f"{min(sizes)} errors"
    sentence = f"Always answering the more frequent class makes {errors}."
    if sizes[0] == sizes[1]:
        return sentence
    return (
        f"{sentence} The classes are of unequal size ({contrast.negative} {sizes[0]}, "
        f"{contrast.positive} {sizes[1]}), and the discriminant has no constant (eq. 11), "
        "which suits classes of equal size."
    )


def multiple_inputs_sentence(found: Classification | Regression) -> str:
    """Return what to mind of so many values of p; empty where there is one."""
    if len(found.results) < 2 or not found.n_permutations:
        return ""
    n_inputs = len(found.results)
    return f"There are {n_inputs} inputs: a p of 0.05 somewhere is to be expected by chance."


def gait_table(walkers: Mapping[str, Walker]) -> Table:
    """Return the gait parameters of walkers, by title, that any of them has."""
    found = [gait_parameters(walker) for walker in walkers.values()]
    rows = []
    for name, (words, factor, decimals) in _GAIT.items():
        cells = [_fixed(factor * each[name], decimals) for each in found]
        if any(cells):
            rows.append([words, *cells])
    return Table("Gait of the walkers shown", ["", *walkers], rows)


def plausibility_table(found: Mapping[str, Plausibility]) -> Table:
    """Return how plausible walkers are, by title."""
    limbs = next(iter(found.values())).limb_change.index
    rows = [
        [
            title,
            _fixed(each.position.distance, 1),
            *(_change(change) for change in each.limb_change),
        ]
        for title, each in found.items()
    ]
    return Table(
        "How plausible they are: distance from the average walker, 1 being usual, and how much "
        "longer or shorter than the average walker's their limbs are",
        ["walker", "distance", *limbs],
        rows,
    )


def missed_table(population: Population, found: Classification, most: int = 10) -> Table | None:
    """Return the walkers that several classifiers miss, named with their class; None if none."""
    missed = found.often_misclassified().head(most)
    if missed.empty:
        return None
    classes = dict(zip(found.contrast.rows, found.contrast.labels, strict=True))
    names = population.names
    rows = [
        [f"{names[row]} ({classes[row]})", int(count)]
        for row, count in zip(missed.index.to_numpy(), missed, strict=True)
    ]
    n_inputs = len(found.results[:N_PANELS])
    return Table(
        "Walkers that several classifiers miss", ["walker", f"missed, of {n_inputs} inputs"], rows
    )


def _fixed(value: float, decimals: int) -> str | None:
    """A number with so many decimals, without a sign where they are all 0."""
    return None if np.isnan(value) else f"{round(float(value), decimals) + 0.0:.{decimals}f}"


def _change(share: float) -> str | None:
    percent = _fixed(100 * share, 0)
    if percent is None:
        return None
    return f"{'' if percent.startswith(('-', '0')) else '+'}{percent} %"
