"""Designs say what is wrong with them; orders are balanced, and the same for a seed."""

from __future__ import annotations

import re
from collections import Counter
from importlib.resources import files
from pathlib import Path

import pytest

from eigenwalker.experiment.balance import imbalances
from eigenwalker.experiment.design import Design
from eigenwalker.experiment.design_file import BadDesign, parse_design
from eigenwalker.experiment.experiment_folder import DESIGNS
from eigenwalker.experiment.manipulations import CARICATURE, MANIPULATIONS, manipulation_design
from eigenwalker.experiment.order import (
    session_trials,
    session_views,
    shown_walkers,
    trials_for_page,
)
from eigenwalker.experiment.walker_faults import walker_faults


def text_of(name: str, seed: int = 1) -> str:
    toml = files("eigenwalker.experiment").joinpath("designs", f"{name}.toml")
    return toml.read_text(encoding="utf-8").replace("{seed}", str(seed))


def design(name: str, seed: int = 1) -> Design:
    return parse_design(text_of(name, seed))


@pytest.mark.parametrize("name", DESIGNS)
def test_the_designs_that_are_ready_to_run_have_no_faults(name: str) -> None:
    assert design(name).name == name


@pytest.mark.parametrize("name", [*MANIPULATIONS, "caricature"])
def test_the_designs_of_manipulations_have_no_faults(name: str) -> None:
    frame = files("eigenwalker.experiment").joinpath("designs", "manipulation.toml").read_text()
    manipulation = MANIPULATIONS.get(name, CARICATURE)
    made = parse_design(manipulation_design(frame, name, manipulation).replace("{seed}", "1"))
    trials = session_trials(made, range(6), group="all", place=0)
    shown = Counter(trial["condition"] for trial in trials)
    assert shown == {each["name"]: 6 for each in manipulation.conditions}


def test_all_faults_are_named_at_once_with_line_and_remedy() -> None:
    text = text_of("troje2002")
    text = text.replace("instances = 2", "instanses = 2").replace("observers = 8", "observers = 0")
    text = text.replace('style = "dots"', 'style = "blobs"').replace("seed = 1", "")
    with pytest.raises(BadDesign) as caught:
        parse_design(text)
    lines = text.splitlines()
    found = {fault.problem: lines[fault.line - 1] for fault in caught.value.faults}
    assert len(found) >= 6
    assert "write 'instances'" in next(p for p, line in found.items() if "instanses" in line)
    assert any("must be 1 or more, not 0" in problem for problem in found)
    assert any("'dots', 'sticks' or 'mannequin'" in problem for problem in found)
    assert any("seed is missing" in problem for problem in found)


@pytest.mark.parametrize(
    ("text", "words"),
    [("seed = = 1", "line 1: this is no TOML"), ("a = 1\n" * 2, "line 2"), ("", "missing")],
)
def test_what_is_no_design_is_refused(text: str, words: str) -> None:
    with pytest.raises(BadDesign, match=words):
        parse_design(text)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("group", ["frontal", "half-profile", "profile"])
def test_troje2002_shows_each_walker_twice_then_each_part_once(group: str, seed: int) -> None:
    made = design("troje2002", seed)
    trials = session_trials(made, range(40), group=group, place=seed)
    first, second = trials[:80], trials[80:]
    assert {trial["information"] for trial in first} == {"full"}
    assert set(Counter(trial["walkers"][0] for trial in first).values()) == {2}
    shown = Counter((trial["walkers"][0], trial["information"]) for trial in second)
    assert len(shown) == len(second) == 80
    view = made.group(group).view_deg
    for information in ("full", "structure", "dynamics"):
        views = Counter(t["view_deg"] for t in trials if t["information"] == information)
        assert views[view] == (views[-view] if view else views.total())  # type: ignore[operator]


def test_signs_alternate_within_a_walker() -> None:
    trials = session_trials(design("troje2002"), range(40), group="profile", place=0)[:80]
    seen = Counter((trial["walkers"][0], trial["view_deg"]) for trial in trials)
    assert set(seen.values()) == {1}


def test_views_of_sessions_are_counterbalanced_over_places() -> None:
    made = design("wdp2002")
    orders = [session_views(made, place) for place in range(6)]
    assert {tuple(sorted(order)) for order in orders} == {(0.0, 30.0, 90.0)}  # type: ignore[type-var]
    for session in range(3):
        assert set(Counter(order[session] for order in orders).values()) == {2}
    assert len({tuple(order) for order in orders}) == 6


def test_squares_have_four_different_walkers_each_as_often_in_places_by_chance() -> None:
    made = design("prazak2010")
    walkers = shown_walkers(made, 40)
    assert len(set(walkers)) == 21
    places: Counter[tuple[int, int]] = Counter()
    for place in range(8):
        trials = session_trials(made, walkers, group="all", place=place)
        counted = [trial for trial in trials if not trial["spare"]]
        assert len(counted) == 63
        assert all(len(set(trial["walkers"])) == 4 for trial in trials)
        shown = Counter(walker for trial in counted for walker in trial["walkers"])
        assert set(shown.values()) == {12}
        places.update((w, i) for trial in trials for i, w in enumerate(trial["walkers"]))
    assert len(places) == 21 * 4
    assert max(places.values()) < 3 * min(places.values())


def test_an_order_depends_on_seed_group_place_and_session_alone() -> None:
    made = design("troje2002")

    def order(made: Design = made, group: str = "frontal", place: int = 0) -> list[int]:
        return [t["walkers"][0] for t in session_trials(made, range(40), group=group, place=place)]

    assert order() == order()
    assert order()[:12] == [38, 5, 19, 17, 35, 8, 22, 25, 36, 14, 10, 4]  # on every machine
    others = [order(design("troje2002", 2)), order(group="profile"), order(place=1)]
    assert all(other != order() for other in others)


def test_more_walkers_than_there_are_is_refused() -> None:
    with pytest.raises(ValueError, match="write 10 or less"):
        shown_walkers(design("prazak2010"), 10)


def test_pairs_are_the_same_in_half_of_the_trials_and_all_walkers_are_shown() -> None:
    made = design("same_different")
    trials = session_trials(made, range(40), group="all", place=0)
    practice, main = trials[:8], trials[8:]
    assert all(trial["practice"] for trial in practice)
    for some in (practice, main):
        right = Counter(trial["correct"] for trial in some)
        assert right["same"] == right["different"] == len(some) / 2
    for trial in main:
        assert (len(set(trial["walkers"])) == 1) == (trial["correct"] == "same")
        assert trial["stimuli"][1].endswith("view+60")
    assert [trial["trial"] for trial in main if trial.get("break_after")] == [48]
    page = trials_for_page(made, trials)
    assert [trial["trial"] for trial in page if "correct" in trial] == [*range(1, 9)]


@pytest.mark.parametrize("figures", [3, 4])
def test_one_of_the_figures_is_the_odd_one_in_places_in_turn(figures: int) -> None:
    made = parse_design(text_of("odd_one_out").replace("figures = 3", f"figures = {figures}"))
    trials = session_trials(made, range(40), group="all", place=0)
    for trial in trials:
        shown = Counter(trial["walkers"])
        assert sorted(shown.values()) == [1, figures - 1]
        assert shown[trial["walkers"][trial["correct"]]] == 1
    assert set(Counter(trial["correct"] for trial in trials).values()) == {60 / figures}


def test_one_person_differs_in_conditions() -> None:
    conditions = "".join(
        f'[[conditions]]\nname = "{name}"\ntrait = "sex"\nalpha = {alpha}\n'
        for name, alpha in (("plain", 0.0), ("strong", 3.0))
    )
    text = text_of("odd_one_out") + conditions
    made = parse_design(
        text.replace('"walkers" ', '"conditions" ').replace(
            "all_differ = false", 'conditions = ["plain", "strong"]'
        )
    )
    trials = session_trials(made, range(40), group="all", place=0)
    for trial in trials:
        assert len(set(trial["walkers"])) == 1
        assert sorted(Counter(trial["conditions"]).values()) == [1, 2]
        assert trial["condition"] in ("plain/strong", "strong/plain")


def test_sliders_begin_anywhere_and_step_from_the_lowest_to_the_highest_weight() -> None:
    made = design("adjustment")
    trials = session_trials(made, range(40), group="all", place=0)
    assert len(trials) == 20
    assert trials[0]["levels"][:2] == [-6.0, -5.5]
    assert trials[0]["levels"][-1] == 6.0
    assert len(trials[0]["stimuli"]) == 25
    assert len({trial["begins"] for trial in trials}) > 5


def test_catch_trials_are_among_the_others_and_have_a_right_answer() -> None:
    text = text_of("troje2002").replace("instances = 2", "instances = 1\ntrials = 10", 1)
    text += '[[conditions]]\nname = "man"\nwalker = "average"\ntrait = "sex"\nalpha = 6.0\n'
    text += 'toward = "male"\n'
    catch = '[[blocks.catch]]\ncondition = "man"\nright = ["male"]\nnumber = 2\n\n[[blocks]]'
    made = parse_design(catch.join(text.rsplit("[[blocks]]", 1)))
    classes = {"sex": ["female", "male"] * 20}
    trials = session_trials(made, range(40), group="profile", place=0, classes=classes)[:12]
    caught = [trial for trial in trials if trial.get("catch")]
    assert [(trial["walkers"], trial["correct"]) for trial in caught] == [([], ["male"])] * 2
    assert sorted(trial["view_deg"] for trial in caught) == [-90.0, 90.0]
    others = [trial for trial in trials if not trial.get("catch")]
    assert Counter(trial["view_deg"] for trial in others) == {90.0: 5, -90.0: 5}
    assert all(t["correct"] == classes["sex"][t["walkers"][0]] for t in others)


def documented_designs() -> list[str]:
    """The examples of the documentation, each completed by the least that a design says."""
    page = (Path(__file__).parents[2] / "docs" / "experiments.md").read_text(encoding="utf-8")
    least, *others = re.findall(r"```toml\n(.*?)```", page, flags=re.DOTALL)
    head, block = least.split("[[blocks]]")
    designs = [least]
    for other in others:
        blocks = "" if "[[blocks]]" in other else f"[[blocks]]{block}"
        designs.append(f"{head}{blocks}\n{other}")
    return designs


@pytest.mark.parametrize("text", documented_designs())
def test_the_examples_of_the_documentation_have_no_faults(text: str) -> None:
    made = parse_design(text)
    assert not walker_faults(made, PEOPLE)
    for session in range(made.n_sessions):
        trials = session_trials(made, range(40), group="all", place=0, session=session)
        assert not imbalances(made, trials)


PEOPLE = {
    "walkers": [f"walker {number}" for number in range(40)],
    "classes": {"sex": ["female", "male"] * 20},
    "traits": {"sex": ["female", "male"], "weight_kg": ["light", "heavy"]},
}


FAULTS = [
    ("troje2002", "[pace]", "[paces]", "paces is an unknown word; write 'pace'"),
    ("troje2002", "blank_s = 3.0", 'blank_s = "3"', "blank_s of [pace] must be a number, not '3'"),
    ("troje2002", "instances = 2", "instances = 2.5", "must be a whole number, not 2.5"),
    ("troje2002", "[[blocks]]", "[blocks]", "is written as [[blocks]]"),
    ("troje2002", "[pace]", "[[pace]]", "pace must be written as [pace]"),
    ("troje2002", "version = 1", "version = 2", "write version = 1"),
    ("troje2002", 'task = "choice"', 'task = "chioce"', "choose from choice, rating"),
    ("troje2002", "# number = 40", "number = 41", "write 40 or less"),
    ("troje2002", "instances = 2", "trials = 50", "there are 40 trials of 40 walkers"),
    ("troje2002", "instances = 1", "trials = 31", "write a multiple of 2"),
    ("wdp2002", "steps = 6", "steps = 6\nfeedback = true", "take feedback out"),
    ("wdp2002", "least_hours = 0.0", "least_hours = 800.0", "must be below most_hours"),
    ("prazak2010", "number = 21", "number = 3", "4 different walkers at once; there are 3"),
    ("detection", "trials = 60", "trials = 61", "write an even number"),
    ("detection", "[5, 10, 20, 40, 80]", "[80, 5]", "from the easiest level"),
    ("odd_one_out", "trials = 60", "trials = 61", "write a multiple of 3"),
    ("adjustment", 'trait = "sex"', 'trait = "charm"', "no trait 'charm'; known are sex"),
    ("adjustment", "lowest = -6.0", "lowest = 7.0", "write less than 6"),
]


@pytest.mark.parametrize(("name", "before", "after", "words"), FAULTS)
def test_a_fault_is_named_with_what_to_do(name: str, before: str, after: str, words: str) -> None:
    text = text_of(name)
    assert before in text
    try:
        conflicts = walker_faults(parse_design(text.replace(before, after)), PEOPLE)
        problems = [problem for _, problem in conflicts]
    except BadDesign as error:
        problems = [str(error)]
    assert any(words in problem for problem in problems), problems


def test_ranges_and_conflicts_are_found_in_one_reading() -> None:
    text = text_of("detection").replace("start = 0", "start = 9").replace("_s = 1.0", "_s = -1.0")
    with pytest.raises(BadDesign) as caught:
        parse_design(text)
    assert [fault.line for fault in caught.value.faults] == [
        text.splitlines().index(line) + 1 for line in ("start = 9", "blank_s = -1.0")
    ]


@pytest.mark.parametrize("name", DESIGNS)
def test_orders_of_a_hundred_seeds_are_balanced_and_differ(name: str) -> None:
    made = design(name)
    walkers = shown_walkers(made, 40)
    orders: set[str] = set()
    for seed in range(100):
        drawn = made.model_copy(update={"seed": seed})
        trials = session_trials(drawn, walkers, group=made.groups[0].name, place=0)
        assert not imbalances(drawn, trials)
        orders.add(str(trials))
    assert len(orders) == 100
