"""The report on a classification: who walked, what tells them apart, and how that looks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.analysis.classification import Classification
from eigenwalker.analysis.direction import Kind
from eigenwalker.analysis.trait_study import TraitStudy
from eigenwalker.report.blocks import Block, Figure, Film, Items, Link, Report, Section, Text
from eigenwalker.report.classification_figures import draw_figures, write_films
from eigenwalker.report.classification_tables import (
    chance_sentence,
    correlations_table,
    flags_table,
    gait_table,
    missed_table,
    multiple_inputs_sentence,
    people_gait_table,
    permutation_sentence,
    person_sentences,
    plausibility_table,
    results_table,
    size_sentence,
    terms,
    traits_table,
)
from eigenwalker.report.html_report import write_report
from eigenwalker.report.result_files import made_with, write_figures, write_json, write_tables
from eigenwalker.report.words import CITE, WORDS


def write_classification_report(
    study: TraitStudy,
    folder: str | Path,
    *,
    example: xr.DataArray | None = None,
    beside: Link | None = None,
) -> Path:
    """Write a report on how well a trait can be told from gait, with films; return its page.

    Parameters
    ----------
    study : TraitStudy
        Of `study_trait`.
    folder : path
        Made where it does not exist; holds ``report.html`` and the films.
    example : DataArray of shape (time, marker, axis), optional
        A walk in place, to show how sines stand for its scores (Troje 2002, figure 3).
    beside : Link, optional
        A page in the same folder for the report to link to.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.analysis.study_trait
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    trait = study.result.contrast.trait
    stem = folder / "".join(letter if letter.isalnum() else "-" for letter in trait)
    films: dict[Kind, list[Film]] = {
        kind: write_films(view.walkers, stem.with_name(f"{stem.name}-{kind.replace('_', '-')}"))
        for kind, view in study.views.items()
    }
    figures = draw_figures(study, example)
    report = Report(
        title=f"{_capital(trait)} from gait",
        lead=_lead(study),
        sections=[
            Section("What tells them apart", _results(study, figures)),
            Section("Who walked", _who(study)),
            Section("How well the model holds", _model(study, figures)),
            Section("What it looks like", _appearance(study, figures, films)),
            Section("Mind", [Items(_cautions(study))]),
            Section("Made with", [made_with(_seed(study), CITE["troje2002"])]),
        ],
        beside=beside,
    )
    write_files(study, figures, folder)
    return write_report(report, folder)


def write_files(study: TraitStudy, figures: dict[str, Figure], folder: Path) -> None:
    """Write results as CSV and JSON, and figures as SVG and PDF, beside the page."""
    result, contrast = study.result, study.result.contrast
    walkers = study.traits.iloc[contrast.rows].reset_index(drop=True)
    nested = pd.DataFrame(
        {each.input.title: each.nested.held_out for each in result.results}
    ).add_prefix("held out, ")
    tables = {"results": study.table, "predictions": walkers.join(nested)}
    write_tables(tables, folder)
    facts = {
        "trait": contrast.trait,
        "negative": contrast.negative,
        "positive": contrast.positive,
        "permutations": result.n_permutations,
        "p_permutes_within_persons": contrast.varies_within_persons,
    }
    write_json(facts | tables, folder / "results.json")
    write_figures({name: each.figure for name, each in figures.items()}, folder / "figures")


def _seed(study: TraitStudy) -> str:
    return f"{study.result.n_permutations} permutations, random state {study.result.random_state}"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:].replace("_", " ")


def _lead(study: TraitStudy) -> str:
    result = study.result
    n_walkers, best = len(result.contrast.rows), study.table.iloc[0]
    if isinstance(result, Classification):
        are = "is" if best["errors"] == 1 else "are"
        n = best["best n"]
        components = "component that does" if n == 1 else f"{n} components that do"
        return (
            f"Left out of everything, {best['nested errors']} of {n_walkers} walkers "
            f"({best['nested %']:.3g} %) are misclassified from all that is known of them: the "
            f"error to expect of new people. With the {components} best on these very walkers "
            f"{best['errors']} {are}: too few, as the number was chosen for them. "
            f"{chance_sentence(result)} {size_sentence(result)}"
        )
    return (
        f"Predicted from everything, {result.contrast.trait} of {n_walkers} walkers left out of "
        f"all that is learnt and chosen correlates with the truth at "
        f"{best['nested correlation']:.2f} (R2 {best['nested R2']:.2f}, RMSE "
        f"{best['nested RMSE']:.3g}): what to expect of new people. With the number of components "
        f"that does best on these walkers it is {best['correlation']:.2f} (R2 {best['R2']:.2f}), "
        f"which is too good. {chance_sentence(result)} {size_sentence(result)}"
    )


def _who(study: TraitStudy) -> list[Block]:
    flags, average = study.traits["flag"], study.average
    n_numbers = study.X.shape[1]
    blocks: list[Block] = [
        Text(
            f"{len(study.names)} walkers with {len(average.markers)} points each, "
            f"{(flags != '').sum()} of them flagged; {n_numbers} numbers describe a walk."
        )
    ]
    provenance = [f"{key}: {v}" for key, v in study.provenance.items() if key != "recipe"]
    if provenance:
        blocks.append(Items(provenance))
    tables = (
        traits_table(study.traits),
        people_gait_table(study),
        flags_table(study.names, flags),
    )
    return blocks + [table for table in tables if table]


def _model(study: TraitStudy, figures: dict[str, Figure]) -> list[Block]:
    blocks: list[Block] = []
    if "variance" in figures:
        fits = [walker.fit for walker in study.walkers if walker.fit is not None]
        share = np.mean([fit.variance_share[:4].sum() for fit in fits])
        r2, fourier_r2 = np.mean([(fit.r2, fit.fourier_r2) for fit in fits], axis=0)
        sentence = (
            f"Four principal components hold {100 * share:.1f} % of the variance of a walk (mean "
            f"over walkers); as sines they explain {100 * r2:.1f} %, two Fourier harmonics "
            f"{100 * fourier_r2:.1f} %."
        )
        blocks += [Text(sentence), figures["variance"]]
    if "scores" in figures:
        blocks.append(figures["scores"])
    if study.correlations is not None:
        blocks.append(correlations_table(study.correlations))
    return [*blocks, figures["joints"], figures["eigenpostures"]]


def _results(study: TraitStudy, figures: dict[str, Figure]) -> list[Block]:
    result = study.result
    blocks: list[Block] = [results_table(study)]
    sentences = (
        size_sentence(result),
        permutation_sentence(result),
        multiple_inputs_sentence(result),
    )
    blocks.append(Items(terms(result)))
    blocks += [Text(sentence) for sentence in sentences if sentence]
    if not isinstance(result, Classification):
        return [*blocks, figures["regression curves"]]
    missed = missed_table(study)
    return [*blocks, figures["class curves"], *([missed] if missed else [])]


def _appearance(
    study: TraitStudy, figures: dict[str, Figure], films: dict[Kind, list[Film]]
) -> list[Block]:
    size = WORDS["views"]["size_kept" if study.keep_size else "size_out"]
    blocks: list[Block] = [Text(size)]
    for kind, view in study.views.items():
        tables = [gait_table(view.walkers), plausibility_table(view.plausibility)]
        blocks += [Text(WORDS["views"][kind]), *films[kind], figures[kind], *tables]
    if "classes" in figures:
        blocks.append(figures["classes"])
    return [*blocks, figures["space"]]


def _cautions(study: TraitStudy) -> list[str]:
    contrast, provenance = study.result.contrast, study.provenance
    cautions = []
    if "simulated" in provenance:
        cautions.append(
            f"{_capital(provenance['simulated'])}. Differences between the walkers were "
            "put in, from published figures; they are no evidence about people."
        )
    if "style" in contrast.trait.lower():
        cautions.append(
            "These are styles that few people acted, not traits of the walkers: errors say how "
            "well the acts can be told apart, not how well people can."
        )
    cautions += person_sentences(contrast, study.traits)
    return [
        *cautions,
        "The best number of components is picked on the curve that is reported, as in the paper; "
        "nested errors are free of that choice.",
        "Size (eq. 12) and correspondence of eigenpostures use no labels and are fixed once; "
        "standardisation, components and their order are found again without each walker left out.",
    ]
