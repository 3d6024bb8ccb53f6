"""Tables and sentences of the classification report, with units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.analysis.classification import Classification, Regression, results_of_panels
from eigenwalker.analysis.contrast import SEX, Contrast
from eigenwalker.analysis.plausibility import Plausibility
from eigenwalker.analysis.trait_study import TraitStudy
from eigenwalker.core.walker import Walker
from eigenwalker.gait.parameters import gait_parameters
from eigenwalker.report.blocks import Table
from eigenwalker.report.words import TABLES, WORDS
from eigenwalker.study.messages import persons_in_report

_POSSIBLE = {
    "double_support_share": (0, 1),
    "stance_share_left": (0.3, 1),
    "stance_share_right": (0.3, 1),
    "swing_share_left": (0, 0.7),
    "swing_share_right": (0, 0.7),
    "step_length_left_mm": (0, 2000),
    "step_length_right_mm": (0, 2000),
    "stride_length_mm": (0, 4000),
    "step_width_mm": (-300, 800),
    "step_asymmetry": (-1, 1),
    "stance_asymmetry": (-1, 1),
}
"""Between which limits parameters of a walk are."""


def results_table(study: TraitStudy) -> Table:
    """Return how well a trait is predicted from each input."""
    units = "persons" if study.result.contrast.persons is not None else "walkers"
    printed = printed_results(study.result, study.table)
    return Table(
        f"Predicted of {units} left out one at a time",
        [str(column) for column in printed],
        printed.to_numpy(dtype=object).tolist(),
    )


def printed_results(
    result: Classification | Regression, table: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Return the results as printed: "-" where there is nothing, p with its lower limit."""
    table = result.table() if table is None else table
    n_permutations = result.n_permutations
    least = 1 / (1 + n_permutations)

    def printed_p(p: float) -> str:
        if not n_permutations:
            return "-"
        return f"<= {least:.2g}" if p <= least else f"{p:.2g}"

    def cell(value: object) -> str:
        if value is None or value is pd.NA or value != value:
            return "-"
        return f"{value:.3g}" if isinstance(value, float) else str(value)

    printed = pd.DataFrame({name: [cell(value) for value in table[name]] for name in table})
    printed = printed.assign(p=[printed_p(p) for p in table["p"]])
    honest = [name for name in printed if str(name).startswith("nested")]
    rest = [name for name in printed if name not in ("input", "p", *honest)]
    printed = printed[["input", *honest, "p", *rest]]
    return printed.rename(columns={"p": p_heading(result.contrast)})


def p_heading(contrast: Contrast) -> str:
    """Return the heading of p values, which says if they permute within persons."""
    return "p within persons" if contrast.varies_within_persons else "p"


def terms(result: Classification | Regression) -> list[str]:
    """Return what the columns of the results mean."""
    return list(WORDS["terms"]["classes" if isinstance(result, Classification) else "number"])


def size_sentence(result: Classification | Regression) -> str:
    """Return that size alone tells as much as everything, where it does; else nothing."""
    table = result.table().set_index("input")
    error = "nested RMSE" if isinstance(result, Regression) else "nested errors"
    size, whole = "size alone", ("everything, with size", "everything, size divided out")
    known = [name for name in whole if name in table.index]
    if size not in table.index or not known:
        return ""
    least = table.loc[known, error].min()
    if table.loc[size, error] > least:
        return ""
    unit = "" if isinstance(result, Regression) else " walkers"
    return (
        f"Size alone, one number, does as well as everything or better ({error} "
        f"{table.loc[size, error]:.3g}, not {least:.3g}{unit}): what tells them may be how tall "
        "they are, not how they walk."
    )


def permutation_sentence(result: Classification | Regression) -> str:
    """Return what was permuted for p; empty where nothing was."""
    contrast = result.contrast
    if not result.n_permutations:
        return ""
    if not contrast.varies_within_persons:
        who = "walks" if contrast.persons is None else "persons, each with all their walks"
        return f"p permutes {contrast.trait} among {who}."
    values = contrast.values_of_persons()
    return (
        f"p permutes {contrast.trait} within each person, as {(values > 1).sum()} of {len(values)} "
        "persons have several values of it: it asks whether walks of one person are told apart, "
        "not whether people are. Errors leave out whole persons."
    )


def person_sentences(contrast: Contrast, traits: pd.DataFrame) -> list[str]:
    """Return how it is known who walked, or what to do where it is not; nothing of simulations."""
    return [*persons_in_report(traits.iloc[contrast.rows]), *_both_sexes(contrast)]


def _both_sexes(contrast: Contrast) -> list[str]:
    """Return a warning if persons have several values of a trait that people do not change."""
    if not contrast.varies_within_persons or contrast.trait.casefold() not in SEX:
        return []
    values = contrast.values_of_persons()
    return [
        f"{contrast.trait} is not the same for all walks of a person ({values.idxmax()!r} for one):"
        " do numbers of persons begin again in each group?"
    ]


def chance_sentence(result: Classification | Regression) -> str:
    """Return what to hold the errors against: those of always giving the same answer."""
    contrast = result.contrast
    if isinstance(result, Regression):
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


def multiple_inputs_sentence(result: Classification | Regression) -> str:
    """Return a warning about many values of p; empty where there is one."""
    n_inputs = len(result.results)
    if n_inputs < 2 or not result.n_permutations:
        return ""
    return f"There are {n_inputs} inputs: a p of 0.05 somewhere is to be expected by chance."


def gait_table(walkers: Mapping[str, Walker]) -> Table:
    """Return the gait parameters of walkers, by title, that any of them has."""
    parameters = [gait_parameters(walker) for walker in walkers.values()]
    rows = []
    for name, (title, factor, decimals) in WORDS["gait"].items():
        cells = [_fixed(factor * _possible(name, each[name]), decimals) for each in parameters]
        if any(cells):
            rows.append([title, *cells])
    caption = "Gait of the synthetic walkers shown; a dash where a walk could not have such a value"
    return Table(caption, ["", *walkers], rows)


def people_gait_table(study: TraitStudy) -> Table:
    """Return gait parameters of the people themselves: mean and SD, by class where there are."""
    contrast = study.result.contrast
    parameters = pd.DataFrame([gait_parameters(walker) for walker in study.contrast_walkers])
    groups = {f"all {len(parameters)}": np.ones(len(parameters), dtype=bool)}
    if contrast.two_classes:
        groups = {
            f"{name} ({int(members.sum())})": members
            for name, members in (
                (contrast.negative, contrast.y < 0),
                (contrast.positive, contrast.y > 0),
            )
        }
    rows = []
    for name, (title, factor, decimals) in WORDS["gait"].items():
        values = factor * parameters[name].map(lambda value, name=name: _possible(name, value))
        cells = [_mean_and_sd(values[members].dropna(), decimals) for members in groups.values()]
        if any(cells):
            rows.append([title, *cells])
    toes = any("left_toe" in walker.markers for walker in study.contrast_walkers)
    bias = WORDS["bias"]["toes" if toes else "ankles"]
    return Table(TABLES["people"].format(bias=bias), ["", *groups], rows)


def _mean_and_sd(values: pd.Series, decimals: int) -> str | None:
    if values.empty:
        return None
    mean = _fixed(float(values.mean()), decimals)
    return f"{mean} (SD {values.std():.{decimals}f})" if len(values) > 1 else mean


def _possible(name: str, value: float) -> float:
    """Return a parameter, NaN where no walk could have such a value."""
    low, high = _POSSIBLE.get(name, (-np.inf, np.inf))
    return value if low < value < high else float("nan")


def plausibility_table(walkers: Mapping[str, Plausibility]) -> Table:
    """Return how plausible walkers are, by title."""
    limbs = next(iter(walkers.values())).limb_change.index
    rows = [
        [title, _fixed(each.position.distance, 1), *map(_change, each.limb_change)]
        for title, each in walkers.items()
    ]
    return Table(
        TABLES["plausibility"],
        ["walker", "distance", *limbs],
        rows,
    )


def missed_table(study: TraitStudy, most: int = 10) -> Table | None:
    """Return the walkers that several classifiers misclassify, with their class; None if none."""
    if study.missed is None or study.missed.empty:
        return None
    counts, contrast = study.missed.head(most), study.result.contrast
    classes = dict(zip(contrast.rows, contrast.labels, strict=True))
    rows = [
        [f"{study.names[row]} ({classes[row]})", int(count)]
        for row, count in zip(counts.index.to_numpy(), counts, strict=True)
    ]
    results: Any = study.result.results  # of classes, whose walkers are the ones that are missed
    n_inputs = len(results_of_panels(results))
    return Table(
        "Walkers that several classifiers miss", ["walker", f"missed, of {n_inputs} inputs"], rows
    )


def traits_table(traits: pd.DataFrame) -> Table | None:
    """Return what is known of the traits of a population; None if nothing is."""
    rows = []
    for name, values in traits.drop(columns=["flag", "file"], errors="ignore").items():
        known = values[values.notna() & (values.astype(str) != "")]
        if known.empty:
            continue
        if pd.api.types.is_numeric_dtype(known):
            summary = f"{known.mean():.4g} (SD {known.std():.2g})"
        else:
            counts = known.astype(str).value_counts()
            summary = ", ".join(f"{value} {count}" for value, count in counts.head(8).items())
            summary += ", ..." if len(counts) > 8 else ""
        rows.append([str(name), summary, len(known)])
    return Table("Traits", ["trait", "values", "known of"], rows) if rows else None


def flags_table(names: Sequence[str], flags: pd.Series) -> Table | None:
    """Return the flagged walkers and why they are flagged; None if none is."""
    rows = [[name, flag] for name, flag in zip(names, flags, strict=True) if flag]
    return (
        Table("Flagged, and left out of all that follows", ["walk", "why"], rows) if rows else None
    )


def correlations_table(correlations: pd.DataFrame) -> Table:
    """Return how alike the postures of walkers are."""
    return Table(
        "How alike postures are: mean correlation over all pairs of walkers",
        ["posture", *correlations.columns],
        [[name, *map(float, row)] for name, *row in correlations.itertuples()],
    )


def _fixed(value: float, decimals: int) -> str | None:
    """Return a number with so many decimals, without a sign where they are all 0."""
    return None if np.isnan(value) else f"{round(float(value), decimals) + 0.0:.{decimals}f}"


def _change(share: float) -> str | None:
    percent = _fixed(100 * share, 0)
    if percent is None:
        return None
    return f"{'' if percent.startswith(('-', '0')) else '+'}{percent} %"
