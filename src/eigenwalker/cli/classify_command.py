"""``eigenwalker classify`` and ``eigenwalker demo``: how well a trait can be told from gait."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import (
    KeepSize,
    OpenPage,
    People,
    Person,
    ReportFolder,
    WithFlagged,
    is_published,
    load_people,
    open_in_browser,
    option,
    progress_bar,
    trait_or_usual,
)

if TYPE_CHECKING:
    from eigenwalker.analysis.classification import Classification, Regression
    from eigenwalker.population.population import Population

INDEX = "index.html"
FEWEST_WALKERS = 4
"""Walkers of whom three are left to learn from while one is predicted."""
BUILT_IN_TITLE = "How people walk"


def classify(
    people: People = None,
    trait: Annotated[
        str | None, option("Trait to tell: sex, weight_kg, style, style=feminine:masculine.")
    ] = None,
    output: ReportFolder = None,
    permutations: Annotated[int, option("Random permutations of the trait to compare with.")] = 200,
    keep_size: KeepSize = False,
    person: Person = None,
    with_flagged: WithFlagged = False,
) -> None:
    """Tell a trait from gait: separation, jack-knife, nested jack-knife, permutation test.

    Three classes or more are told apart as a whole: errors, which are taken for which, chance.
    """
    from eigenwalker.analysis.contrast import has_several_classes
    from eigenwalker.analysis.several_classes import SeveralClasses, classify_several
    from eigenwalker.analysis.trait_study import study_trait
    from eigenwalker.report.classification_report import write_classification_report
    from eigenwalker.report.several_classes_report import (
        several_classes_text,
        write_several_classes_report,
    )
    from eigenwalker.study.messages import persons_in_words

    population = load_people(people, with_flagged, person)
    trait = trait or trait_or_usual(population)
    page = None
    with progress_bar("Classifying") as progress:
        if has_several_classes(population, trait):
            result = classify_several(population, trait, progress=progress)
            if output is not None:
                page = write_several_classes_report(result, population, output)
        else:
            result = _classify(population, trait, n_permutations=permutations, progress=progress)
            if output is not None:
                page = write_classification_report(
                    study_trait(population, result, keep_size=keep_size), output
                )
    if isinstance(result, SeveralClasses):
        print(f"{several_classes_text(result)}\n")
        for sentence in persons_in_words(population.traits.iloc[result.rows]):
            print(in_options(sentence))
        if page is not None:
            print(f"Report: {page}")
        return
    classes = result.contrast
    print(f"{classes.trait}: {classes.negative} to {classes.positive}, {len(classes.rows)} walkers")
    _print_result(result, population)
    if page is not None:
        print(f"Report: {page}")


def demo(
    people: People = None,
    output: Annotated[Path, option("Folder to write into.", "-o", "--output")] = Path(
        "eigenwalker-demo"
    ),
    trait: Annotated[str | None, option("Trait to tell; left out, the sex, or the first.")] = None,
    open_page: OpenPage = True,
    keep_size: KeepSize = False,
    with_flagged: WithFlagged = False,
) -> None:
    """Classify a trait, and write a page on which anyone can play with the walkers.

    index.html holds the walkers, report.html beside it what tells the trait from gait; both work
    from the disk, without a network.
    """
    from eigenwalker.analysis.contrast import trait_contrast
    from eigenwalker.analysis.trait_study import study_trait
    from eigenwalker.core.atomic_write import atomic_write
    from eigenwalker.datasets.built_in import built_in_capture
    from eigenwalker.explorer.interactive_page import interactive_page
    from eigenwalker.explorer.model import page_models
    from eigenwalker.report.blocks import Link
    from eigenwalker.report.classification_report import write_classification_report

    population = load_people(people, with_flagged)
    trait = trait or trait_or_usual(population)
    index, report = output / INDEX, ""
    n_walkers = len(trait_contrast(population, trait).rows)
    if n_walkers >= FEWEST_WALKERS:
        with progress_bar("Classifying and filming") as progress:
            result = _classify(population, trait, progress=progress)
            page = write_classification_report(
                study_trait(population, result, keep_size=keep_size),
                output,
                example=built_in_capture() if people is None else None,
                beside=Link("Play with these walkers", INDEX),
            )
        report = page.name
        _print_result(result, population)
        print(f"Report: {page}")
    else:
        output.mkdir(parents=True, exist_ok=True)
        print(f"{n_walkers} walkers are too few to tell {trait} from gait: the page has no report.")
    keep_size = keep_size or is_published(people)
    model = page_models(population, keep_size=keep_size, first=trait, **model_names(people))
    with atomic_write(index) as unfinished:
        unfinished.write_text(interactive_page(model, report=report), encoding="utf-8")
    print(f"Page to play with: {index}")
    if open_page:
        open_in_browser(str(index))


def model_names(people: Path | None) -> dict[str, str]:
    """Return title and source of the model of a population file, or of the built-in one."""
    if people is None:
        return {"title": BUILT_IN_TITLE, "source": ""}
    return {"title": people.stem, "source": people.name}


def _classify(population: Population, trait: str, **settings: Any) -> Classification | Regression:
    """Return how well two classes, or a number, are told."""
    from eigenwalker.analysis.classification import Classification, Regression, classify, regress
    from eigenwalker.analysis.contrast import trait_contrast

    predict = classify if trait_contrast(population, trait).two_classes else regress
    result = predict(population, trait, **settings)
    assert isinstance(result, Classification | Regression)  # several classes are not asked for here
    return result


def _print_result(result: Classification | Regression, population: Population) -> None:
    from eigenwalker.report.classification_tables import (
        chance_sentence,
        multiple_inputs_sentence,
        permutation_sentence,
        person_sentences,
        printed_results,
        size_sentence,
        terms,
    )

    print(printed_results(result).to_string(index=False))
    print(f"\n{chance_sentence(result)}")
    sentences = [*terms(result), size_sentence(result)]
    sentences += [permutation_sentence(result), multiple_inputs_sentence(result)]
    sentences += person_sentences(result.contrast, population.traits)
    for sentence in filter(None, sentences):
        print(in_options(sentence))
