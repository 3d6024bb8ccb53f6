"""Designs say what is wrong with them; orders are balanced, and the same for a seed."""

from __future__ import annotations

from collections import Counter
from importlib.resources import files

import pytest

from eigenwalker.experiment.design import Design
from eigenwalker.experiment.design_file import BadDesign, parse_design
from eigenwalker.experiment.experiment_folder import DESIGNS
from eigenwalker.experiment.manipulations import CARICATURE, MANIPULATIONS, manipulation_design
from eigenwalker.experiment.order import session_trials, session_views, shown_walkers


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
    assert any("greater than or equal to 1, not 0" in problem for problem in found)
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


def test_squares_have_four_different_walkers_in_places_by_chance() -> None:
    made = design("prazak2010")
    walkers = shown_walkers(made, 40)
    assert len(set(walkers)) == 21
    places: Counter[tuple[int, int]] = Counter()
    for place in range(8):
        trials = session_trials(made, walkers, group="all", place=place)
        assert sum(not trial["spare"] for trial in trials) == 63
        assert all(len(set(trial["walkers"])) == 4 for trial in trials)
        places.update((w, i) for trial in trials for i, w in enumerate(trial["walkers"]))
    assert len(places) == 21 * 4
    assert max(places.values()) < 3 * min(places.values())


def test_an_order_depends_on_seed_group_place_and_session_alone() -> None:
    made = design("troje2002")

    def order(made: Design = made, group: str = "frontal", place: int = 0) -> list[int]:
        return [t["walkers"][0] for t in session_trials(made, range(40), group=group, place=place)]

    assert order() == order()
    assert order()[:12] == [26, 37, 25, 30, 9, 0, 1, 7, 10, 29, 22, 11]  # on every machine
    others = [order(design("troje2002", 2)), order(group="profile"), order(place=1)]
    assert all(other != order() for other in others)


def test_more_walkers_than_there_are_is_refused() -> None:
    with pytest.raises(ValueError, match="write 10 or less"):
        shown_walkers(design("prazak2010"), 10)
