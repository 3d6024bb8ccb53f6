"""The model that the interactive page holds: the walkers of Python, and nothing else."""

from __future__ import annotations

import gzip
import importlib.util
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st

import eigenwalker as ew
from eigenwalker.explorer import interactive_page, page_model
from eigenwalker.explorer.mixing import mixed_vector, mixed_walker, model_layout
from eigenwalker.population.population import FLAG, Population

GOLDEN = Path(__file__).parents[1] / "golden"
MIX = {"sex": 3.0, "weight_kg": -2.0, "age_years": 0.5}


@pytest.fixture(scope="module")
def people() -> Population:
    return ew.load_population()


@pytest.fixture(scope="module")
def model(people: Population) -> dict:
    return page_model(people)


def as_the_page_reads(model: dict) -> dict:
    return json.loads(json.dumps(model, allow_nan=False))


@pytest.mark.parametrize("kind", ["discriminant", "mean_difference"])
@pytest.mark.parametrize("part", ["all", "structure", "dynamics", "p2", "frequency", "phases"])
def test_a_walker_of_the_page_is_that_of_python(people, model, kind, part):
    vector = people.X[7].copy()
    for trait, alpha in MIX.items():
        vector += alpha * ew.trait_axis(people, trait, kind=kind, part=part).step
    state = {"from": 7, "traits": MIX, "kind": kind, "part": part}
    shown = mixed_walker(as_the_page_reads(model), state)
    time = np.linspace(0, 3, 50)
    apart = shown.trajectories(time).values - people.walker(vector).trajectories(time).values
    assert np.abs(apart).max() < 1e-6


def test_a_bias_of_one_is_the_mean_of_a_class(people, model):
    women = people.X[(people.traits["sex"] == "female").to_numpy()].mean(axis=0)
    shown = mixed_vector(model, {"bias": {"trait": "sex", "steps": -1}})
    np.testing.assert_allclose(shown, women, atol=2e-6)


def test_components_are_as_strong_as_wished(people, model):
    shown = mixed_walker(model, {"strengths": [1, 0, -2, 1]})
    average = people.walker(people.average)
    np.testing.assert_allclose(
        shown.p, average.p * np.array([1, 0, -2, 1])[:, None, None], atol=2e-6
    )


def test_eigenwalkers_are_added_in_standard_deviations(people, model):
    space = ew.WalkerSpace().fit(people.X)
    scores = np.zeros(len(space.eigenwalkers_))
    scores[[0, 2]] = np.sqrt(space.explained_variance_[[0, 2]]) * [2, -1]
    shown = mixed_vector(model, {"eigenwalkers": [2, 0, -1]})
    np.testing.assert_allclose(shown, space.inverse_transform(scores[None])[0], atol=2e-6)


def test_the_page_tells_how_far_a_walker_is_as_python_does(people, model):
    vector = people.average + 4 * ew.trait_axis(people, "sex").step
    far = ew.analysis.plausibility(people, vector).position
    standardised = (vector - model["average"]) / np.array(model["scale"])
    distance = np.linalg.norm(standardised) / model["spread"]["rms"]
    nearer = 100 * np.mean(np.array(model["spread"]["distances"]) < distance)
    assert distance == pytest.approx(far.distance, rel=1e-6)
    assert nearer == far.percentile


def test_no_walker_is_nearer_to_the_average_than_itself(people, model):
    distances = np.array(model["spread"]["distances"])
    for row in range(0, len(people), 6):
        standardised = (mixed_vector(model, {"from": row}) - model["average"]) / model["scale"]
        nearer = distances < np.linalg.norm(standardised) / model["spread"]["rms"]
        assert (
            100 * nearer.mean()
            == ew.analysis.plausibility(people, people.X[row]).position.percentile
        )


def test_the_page_tells_where_a_walker_lies_along_a_trait(people, model):
    axis = ew.trait_axis(people, "weight")
    projection = next(t["projection"] for t in model["traits"] if t["name"] == "weight_kg")
    found = projection["offset"] + people.X @ projection["gradient"]
    np.testing.assert_allclose(found, axis.positions(people.X), atol=1e-6)


@given(st.integers(0, 39), st.floats(-6, 6), st.floats(-6, 6))
def test_sliders_add_up(model, start, one, other):
    def at(**traits: float) -> np.ndarray:
        return mixed_vector(model, {"from": start, "traits": traits})

    both = at(sex=one, age_years=other)
    np.testing.assert_allclose(both + at(), at(sex=one) + at(age_years=other), atol=1e-9)


def test_what_the_model_does_not_have_is_refused(model):
    for state, said in (
        ({"traits": {"shoe": 1}}, "no trait 'shoe'"),
        ({"traits": {"sex": 1}, "part": "p9"}, "no axis in the part 'p9'"),
        ({"traits": {"sex": 1}, "kind": "odd"}, "kind='odd'"),
        ({"bias": {"trait": "age_years", "steps": 1}}, "no two classes"),
        ({"from": 40}, "0 to 39"),
        ({"strengths": [1] * 5}, "5 strengths"),
    ):
        with pytest.raises(ValueError, match=said):
            mixed_vector(model, state)


def test_every_trait_of_the_population_that_has_an_axis_is_there(model):
    traits = {trait["name"]: trait for trait in model["traits"]}
    assert list(traits) == ["sex", "age_years", "weight_kg", "height_mm", "happy", "nervous"]
    assert (traits["weight_kg"]["label"], traits["weight_kg"]["unit"]) == ("weight", "kg")
    assert traits["nervous"]["negative"] == "relaxed"


def test_poles_that_are_numbers_are_as_short_as_those_of_the_walkers(people):
    two = page_model(people.select([0, 30]), traits=["weight_kg"])
    poles = [two["traits"][0][end] for end in ("negative", "positive")]
    assert poles == [str(walker["traits"]["weight_kg"]) for walker in two["walkers"]]
    assert max(map(len, poles)) <= 7
    named = replace(people.select([0, 30]), traits=pd.DataFrame({"group": ["01", "02"]}))
    assert page_model(named)["traits"][0]["negative"] == "01"


def test_flagged_walkers_are_left_out(people):
    flags = ["limps" if row in (2, 30) else "" for row in range(len(people))]
    kept = page_model(replace(people, traits=people.traits.assign(**{FLAG: flags})))
    rows = [walker["row"] for walker in kept["walkers"]]
    assert len(rows) == kept["n_walkers"] == kept["cloud"]["n"] == 38
    assert kept["n_flagged"] == 2
    assert not {2, 30} & set(rows)


def test_traits_that_cannot_be_axes_are_left_out_quietly(people):
    n = len(people)
    odd = pd.DataFrame(
        {
            "same": ["x"] * n,
            "many": [f"v{row % 5}" for row in range(n)],
            "missing": [np.nan] * n,
            "right": [row % 2 == 0 for row in range(n)],
            "file": [f"<b>{row}</b>" for row in range(n)],
        }
    )
    made = as_the_page_reads(page_model(replace(people, traits=odd)))
    assert [trait["name"] for trait in made["traits"]] == ["right"]
    assert made["walkers"][3]["name"] == "<b>3</b>"
    assert made["walkers"][0]["traits"]["missing"] is None


def test_a_population_of_two_without_traits_has_a_page(people):
    bare = replace(people.select([0, 30]), traits=pd.DataFrame(index=range(2)))
    made = as_the_page_reads(page_model(bare))
    assert (made["traits"], made["n_walkers"], len(made["eigenwalkers"])) == ([], 2, 1)
    np.testing.assert_allclose(made["spread"]["distances"], [2**-0.5] * 2, atol=1e-4)


def test_a_population_of_one_has_a_page(people):
    made = as_the_page_reads(page_model(people.select([5])))
    assert made["eigenwalkers"] == []
    np.testing.assert_allclose(mixed_vector(made, {}), people.X[5], atol=1e-6)


def two_markers(n: int) -> Population:
    """Walkers of two markers in the Fourier form."""
    rng = np.random.default_rng(3)
    ahead = np.array([[[30.0, 0, 10], [-30, 0, -10]], [[0, 5, 0], [0, 5, 0]]])
    walkers = [
        ew.Walker(
            ["one", "other"],
            rng.normal(size=(2, 3)),
            ahead + rng.normal(size=(2, 2, 3)),
            [1, 1],
            [0, np.pi / 2],
            1.0,
            form="fourier",
        )
        for _ in range(n)
    ]
    return Population(walkers, pd.DataFrame({"weight": range(n)}))


def test_other_markers_in_the_fourier_form_have_a_page():
    made = page_model(two_markers(6))
    assert made["segments"] == []
    assert made["fixed_phases"] == [0.0, np.pi / 2]
    assert "phases" not in made["layout"]
    assert mixed_walker(made, {"traits": {"weight": 1}}).form == "fourier"


def test_a_large_population_is_thinned():
    made = page_model(two_markers(2500).without_flags())
    assert (made["n_walkers"], len(made["walkers"])) == (2500, 100)
    assert 400 < made["cloud"]["n"] <= 500
    assert [point for point in made["cloud"]["walker"] if point >= 0] == list(range(100))


def golden() -> dict:
    return json.loads((GOLDEN / "model.json").read_text(encoding="utf-8"))


def test_what_python_computes_is_what_the_golden_file_says():
    path = GOLDEN / "write_model.py"
    spec = importlib.util.spec_from_file_location("write_model", path)
    assert spec is not None
    assert spec.loader is not None
    writer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(writer)
    kept = golden()
    for case in kept["cases"]:
        found = writer.computed(kept["model"], case["state"])
        assert found.keys() == case.keys() - {"state"}
        for name, wanted in case.items():
            if name in ("measures", "positions"):
                assert found[name] == pytest.approx(wanted, abs=1e-6)
            elif name != "state":
                np.testing.assert_allclose(found[name], wanted, rtol=0, atol=1e-6)


def test_golden_vectors_are_features_of_the_golden_model():
    kept = golden()
    layout = model_layout(kept["model"])
    for name, (start, stop) in kept["model"]["layout"].items():
        assert layout.columns(name).tolist() == list(range(start, stop))
    assert all(len(case["vector"]) == len(layout) for case in kept["cases"])


def test_the_page_is_small_and_loads_nothing(model):
    page = interactive_page(model, report="report.html")
    assert len(gzip.compress(page.encode())) < 300_000
    assert "default-src 'none'" in page
    assert "connect-src 'none'" in page
    assert '<link rel="icon" href="data:,"' in page


def test_a_page_with_a_server_may_ask_it_and_nobody_else(model):
    page = interactive_page(model, server=True)
    assert "connect-src 'self'" in page
    assert '<meta name="eigenwalker-server"' in page


def test_no_text_of_a_population_ends_its_script(people, model):
    names = people.traits.assign(file="</script><script>alert(1)</script><!--")
    hostile = page_model(replace(people, traits=names), traits=["sex"])
    assert interactive_page(hostile).count("</script>") == interactive_page(model).count(
        "</script>"
    )


def test_pages_that_were_not_built_say_how_to_build_them(monkeypatch, model):
    module = sys.modules["eigenwalker.explorer.interactive_page"]
    monkeypatch.setattr(module, "PAGE", "nowhere.html")
    with pytest.raises(FileNotFoundError, match="npm run build"):
        interactive_page(model)
