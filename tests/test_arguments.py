"""Every public function of every room refuses wrong arrays, walks and walkers in words of its own.

Functions are discovered from the rooms' lists of names, and what an argument has to be from its
annotation: a new function is tested too, or fails for want of a call that works.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import re
import traceback
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.figure import Figure

import eigenwalker as ew

ROOT = Path(ew.__file__).parent
ROOMS = sorted(stub.parent.name for stub in ROOT.glob("*/__init__.pyi"))
FUNCTIONS = {
    f"{room}.{name}": function
    for room in ROOMS
    for name in importlib.import_module(f"eigenwalker.{room}").__all__
    if inspect.isfunction(function := getattr(importlib.import_module(f"eigenwalker.{room}"), name))
}

METHODS = {
    "core.Walker": ew.Walker,
    "core.Walker.trajectories": ew.Walker.trajectories,
    "metric.Loop.trajectories": ew.metric.Loop.trajectories,
    "population.Population": ew.Population,
    "population.Population.walker": ew.Population.walker,
    "population.Population.vector": ew.Population.vector,
    "population.Population.hybrid": ew.Population.hybrid,
    "population.Population.add": ew.Population.add,
    "psychophysics.Trials": ew.psychophysics.Trials,
    "simulation.PlantedEffect": ew.simulation.PlantedEffect,
    "stimulus.Stimulus.play": ew.Stimulus.play,
}
"""Classes that are made of arrays, and methods that take some."""
PUBLIC = {**FUNCTIONS, **METHODS}


@cache
def walk():
    return ew.simulate_walk(seed=1, duration_s=4, rate_hz=60)


@cache
def walkers():
    return [
        ew.decompose_pca(ew.simulate_walk(seed=seed, duration_s=4, rate_hz=60)) for seed in range(3)
    ]


@cache
def people():
    return ew.load_population()


@cache
def space():
    return ew.WalkerSpace(n_components=3).fit(people().X)


@cache
def discriminant():
    return ew.DiscriminantClassifier(n_components=2).fit(people().X, people().traits.sex)


def numbers(*shape):
    return np.random.default_rng(0).uniform(1, 2, shape)


Y = np.where(np.arange(12) % 2, 1.0, -1.0)
STRIDE = np.linspace(0, 0.9, 10)
PAIRS = [(a, b) for i, a in enumerate("abcde") for b in "abcde"[i + 1 :]]
DISTANCES = np.abs(np.subtract.outer(numbers(5), numbers(5)))
TABLE = pd.DataFrame(DISTANCES, index=list("abcde"), columns=list("abcde"))
ANSWERS = pd.DataFrame(
    [["Eva", *"abcd", *pair] for pair in ("ab", "ac", "bd", "cd")]
    + [["Ida", *"abce", *pair] for pair in ("ab", "ae", "ce")],
    columns=["observer", *"abcd", "chosen_1", "chosen_2"],
)
JUDGED = pd.DataFrame(
    [(who, w, info) for who in range(6) for w in range(4) for info in ("full", "structure")],
    columns=["observer", "walker", "info"],
)
JUDGED = JUDGED.assign(
    view=JUDGED["observer"] % 2 * 90,
    sex=np.where(JUDGED["walker"] % 2, "male", "female"),
    answer=np.random.default_rng(0).choice(["female", "male"], len(JUDGED)),
    number=np.random.default_rng(1).normal(size=len(JUDGED)),
    one=np.random.default_rng(2).integers(0, 2, len(JUDGED)),
)
DESIGN = {"dv": "number", "between": "view", "within": "info", "subject": "observer"}
RESPONSES = {"table": JUDGED, "response": "answer", "truth": "sex", "observer": "observer"}
ITEMS = {**RESPONSES, "walker": "walker", "within": "info"}
SHOWN = np.full((4, 10), 10.0)
CHOSEN = np.tile(np.arange(10.0), (4, 1))


@cache
def trials():
    return ew.psychophysics.read_trials(ANSWERS)


@cache
def clips():
    return {name: ew.metric.prepare(walk() * scale) for name, scale in (("a", 1), ("b", 1.01))}


@cache
def prepared():
    return clips()["a"]


def of_x_and_y():
    return {"X": numbers(12, 3), "y": Y}


def of_two_clips():
    return {"a": prepared(), "b": clips()["b"]}


def of_clips():
    return {"clips": clips()}


OF_FILES = {
    "report.write_pairs_report",
    "report.write_classification_report",
    "simulation.write_captures",
    "study.capture_table",
    "study.fit_folder",
    "study.parameter_table",
    "study.predict_captures",
    "study.summarise",
}
"""Take folders, or what other functions made of them."""

CALLS = {
    "core.Walker": lambda: {
        name: getattr(walkers()[0], name)
        for name in ("markers", "p0", "p", "harmonics", "phases", "frequency_hz")
    },
    "core.Walker.trajectories": lambda: {"self": walkers()[0], "time": STRIDE},
    "metric.Loop.trajectories": lambda: {"self": ew.metric.loop(walk()), "time": STRIDE},
    "population.Population": lambda: {
        "walkers": walkers(),
        "traits": pd.DataFrame({"age_years": [20, 30, 40]}),
    },
    "population.Population.walker": lambda: {"self": people(), "vector": people().X[0]},
    "population.Population.vector": lambda: {"self": people(), "walker": people().walkers[0]},
    "population.Population.hybrid": lambda: {
        "self": people(),
        "structure": people().X[0],
        "dynamics": people().X[1],
    },
    "population.Population.add": lambda: {
        "self": people(),
        "walkers": list(people().walkers[:2]),
        "traits": people().traits[:2],
    },
    "psychophysics.Trials": lambda: {
        name: getattr(trials(), name)
        for name in ("pairs", "observers", "observer", "shown", "chosen")
    },
    "simulation.PlantedEffect": lambda: {
        "structure": numbers(15, 3),
        "movement": numbers(4, 15, 3),
    },
    "stimulus.Stimulus.play": lambda: {"self": ew.make_stimulus(walkers()[0]), "time": STRIDE},
    "analysis.classify": lambda: {"population": people(), "trait": "sex", "n_permutations": 0},
    "analysis.classify_several": lambda: {"population": people(), "trait": "sex"},
    "analysis.trait_model": lambda: {"population": people(), "trait": "sex"},
    "analysis.direction": lambda: {"space": space(), "discriminant": discriminant()},
    "analysis.jackknife_curves": of_x_and_y,
    "analysis.nested_leave_one_out": of_x_and_y,
    "analysis.permutation_test": lambda: {**of_x_and_y(), "n_permutations": 3},
    "analysis.plausibility": lambda: {"population": people(), "vector": people().X[0]},
    "analysis.position_in_space": lambda: {
        "space": space(),
        "vector": people().X[0],
        "walkers": people().X,
    },
    "analysis.regress": lambda: {"population": people(), "trait": "age_years"},
    "analysis.regression_curves": lambda: {"X": numbers(12, 3), "y": numbers(12)},
    "analysis.study_trait": lambda: {"population": people(), "result": None},
    "analysis.trait_axis": lambda: {"population": people(), "trait": "sex"},
    "analysis.trait_contrast": lambda: {"population": people(), "trait": "sex"},
    "core.fourier_coefficients": lambda: {"walker": walkers()[0], "n_harmonics": 2},
    "core.harmonic_basis": lambda: {"cycles": numbers(20), "n_harmonics": 2},
    "core.label_trajectories": lambda: {
        "values": numbers(5, 2, 3),
        "markers": ["head", "pelvis"],
        "rate_hz": 100,
    },
    "core.share_explained": lambda: {"movement": numbers(20, 3), "cycles": np.arange(20) / 10},
    "core.shift_origin": lambda: {"coefficients": numbers(4, 2, 3), "angle": 0.5},
    "decomposition.decompose_fourier": lambda: {"walk": walk()},
    "decomposition.decompose_pca": lambda: {"walk": walk()},
    "decomposition.eigenpostures_of": lambda: {
        "postures": walk().values.reshape(len(walk()), -1),
        "rate_hz": 60.0,
    },
    "explorer.page_model": lambda: {"population": people()},
    "explorer.show": lambda: {"population": people()},
    "gait.frequency_of_scores": lambda: {
        "scores": walk().values.reshape(len(walk()), -1)[:, :4],
        "rate_hz": 60.0,
    },
    "gait.fundamental_frequency": lambda: {"trajectories": walk()},
    "gait.gait_events": lambda: {"trajectories": walk()},
    "gait.gait_parameters": lambda: {"walk": walk()},
    "gait.ground_speed": lambda: {"walker": walkers()[0]},
    "gait.in_place": lambda: {"trajectories": walk()},
    "gait.stance_speed": lambda: {"walk": walk()},
    "gait.walker_measures": lambda: {"walker": walkers()[0]},
    "io.constant_bones": lambda: {"walk": walk()},
    "io.from_pyomeca": lambda: {"markers": ew.io.to_pyomeca(walk())},
    "io.to_movement": lambda: {"trajectories": walk()},
    "io.to_pyomeca": lambda: {"trajectories": walk()},
    "io.walker_from_mm": lambda: {"matrix": ew.io.walker_to_mm(walkers()[0])},
    "io.walker_from_table": lambda: {
        "table": ew.io.walker_to_table(walkers()[0]),
        "frequency_hz": 1.0,
    },
    "io.walker_to_mm": lambda: {"walker": walkers()[0]},
    "io.walker_to_table": lambda: {"walker": walkers()[0]},
    "io.write_mocap": lambda: {"trajectories": walk(), "path": "{folder}/walk.csv"},
    "markers.repair_labels": lambda: {"trajectories": walk()},
    "markers.virtual_markers": lambda: {"trajectories": walk()},
    "metric.angle_between": lambda: {"a": numbers(3, 4), "b": numbers(3, 4)},
    "metric.clip_components": of_two_clips,
    "metric.clip_distance": of_two_clips,
    "metric.collinear_groups": lambda: {"table": TABLE},
    "metric.compare_walks": of_two_clips,
    "metric.distances_by_metric": of_clips,
    "metric.find_transitions": lambda: {"a": walk()[:40], "b": walk()[:40]},
    "metric.group_table": of_clips,
    "metric.joint_quaternions": lambda: {"clip": prepared()},
    "metric.label_table": lambda: {"table": TABLE, "labels": dict.fromkeys("abc", "x")},
    "metric.loop": lambda: {"clip": walk()},
    "metric.missing_groups": lambda: {"table": TABLE},
    "metric.motion_map": lambda: {"a": walk()[:20], "b": walk()[:20]},
    "metric.motion_maps": lambda: {
        "a": walk()[:20],
        "b": walk()[:20],
        "groups": {"head": ["head"]},
    },
    "metric.nearest_walks": lambda: {"query": prepared(), "walks": clips()},
    "metric.pair_components": of_clips,
    "metric.pair_distances": of_clips,
    "metric.pair_table": of_clips,
    "metric.prepare": lambda: {"clip": walk()},
    "metric.prepare_walk": lambda: {"capture": walk()},
    "metric.register": lambda: {"a": walk()[:40], "b": walk()[:40]},
    "metric.register_by_spline": lambda: {"a": walk()[:40], "b": walk()[:40]},
    "metric.register_walks": of_two_clips,
    "metric.step_distances": of_two_clips,
    "metric.retarget": lambda: {"walk": walk()},
    "metric.shaped": lambda: {"metric": ew.metric.FrameMetric(), "distances": numbers(3)},
    "plotting.draw_body": lambda: {
        "axes": Figure().subplots(),
        "seen": numbers(15, 2),
        "markers": ew.JOINTS.markers,
    },
    "plotting.figure_eigenpostures": lambda: {"walker": walkers()[0]},
    "plotting.figure_joints": lambda: {"walker": walkers()[0]},
    "plotting.figure_parameters": lambda: {"values": {"m": numbers(4)}},
    "plotting.figure_scores": lambda: {"walk": walk(), "walker": walkers()[1]},
    "plotting.figure_space": lambda: {
        "space": space(),
        "X": people().X,
        "trait": people().traits.age_years,
        "step": people().X[0],
        "trait_name": "age",
    },
    "plotting.figure_two_walks": lambda: {
        "first": numbers(10, 15, 3),
        "second": numbers(10, 15, 3),
        "markers": ew.JOINTS.markers,
        "n_moments": 1,
    },
    "plotting.figure_variance": lambda: {"walkers": walkers()},
    "plotting.figure_walkers": lambda: {"walkers": dict(zip("abc", walkers(), strict=True))},
    "plotting.picture_of_strides": lambda: {
        "values": numbers(10, 10),
        "times_a": STRIDE,
        "times_b": STRIDE,
        "path": np.stack([STRIDE, STRIDE], 1),
        "title": "map",
    },
    "plotting.project": lambda: {"positions": numbers(15, 3)},
    "plotting.write_film": lambda: {
        "walks": walkers()[0],
        "path": "{folder}/walk.gif",
        "duration_s": 0.1,
        "size_px": 32,
    },
    "population.correspond": lambda: {"walkers": walkers()},
    "population.correspond_to": lambda: {
        "walker": walkers()[0],
        "reference": people().correspondence.reference,
    },
    "population.match_sign_and_order": lambda: {"walkers": walkers()},
    "population.posture_correlations": lambda: {"postures": numbers(3, 4, 15, 3)},
    "psychophysics.agreement": lambda: {
        "table": JUDGED,
        "rating": "number",
        "walker": "walker",
        "observer": "observer",
    },
    "psychophysics.bootstrap_choices": lambda: {
        "X": numbers(10, 2),
        "trials": trials(),
        "n_samples": 3,
    },
    "psychophysics.bootstrap_weights": lambda: {
        "X": numbers(10, 2),
        "chosen": CHOSEN,
        "shown": SHOWN,
        "n_samples": 3,
    },
    "psychophysics.cluster_memberships": lambda: {"table": DISTANCES, "clusters": [0, 0, 1, 1, 0]},
    "psychophysics.clusters_of_walks": lambda: {"table": DISTANCES},
    "psychophysics.compare_by_choices": lambda: {"tables": {"m": numbers(10)}, "trials": trials()},
    "psychophysics.compare_metrics": lambda: {
        "tables": {"m": numbers(10)},
        "y": numbers(10),
        "pairs": PAIRS,
    },
    "psychophysics.condition_means": lambda: {"table": JUDGED, **DESIGN},
    "psychophysics.confidence_correlations": lambda: {
        **ITEMS,
        "confidence": pd.DataFrame({"size": [1.0, 3, 2, 4]}),
    },
    "psychophysics.count_pairs": lambda: {"answers": ANSWERS},
    "psychophysics.crossed_logistic": lambda: {
        "table": JUDGED,
        "response": "one",
        "fixed": "info",
        "observer": "observer",
        "walker": "walker",
    },
    "psychophysics.difference_table": lambda: {"answers": ANSWERS},
    "psychophysics.error_rates": lambda: {**RESPONSES, "within": "info"},
    "psychophysics.expected_differences": lambda: {"distances": numbers(10), "trials": trials()},
    "psychophysics.fit_choice_model": lambda: {"answers": ANSWERS},
    "psychophysics.fit_choices": lambda: {
        "X": numbers(10, 2),
        "trials": trials(),
        "counts": np.ones(7),
    },
    "psychophysics.fit_from_random_starts": lambda: {
        "X": numbers(10, 2),
        "y": numbers(10),
        "n_starts": 2,
    },
    "psychophysics.fit_to_answers": lambda: {"walks": clips(), "answers": ANSWERS},
    "psychophysics.goodness": lambda: {"observed": numbers(5), "predicted": numbers(5)},
    "psychophysics.left_out_differences": lambda: {"X": numbers(10, 2), "trials": trials()},
    "psychophysics.map_of_walks": lambda: {"table": DISTANCES},
    "psychophysics.mixed_anova": lambda: {"table": JUDGED, **DESIGN},
    "psychophysics.non_negative_fit": lambda: {
        "X": numbers(10, 2),
        "y": numbers(10),
        "sample_weight": np.ones(10),
    },
    "psychophysics.order_of_walks": lambda: {"table": DISTANCES},
    "psychophysics.paired_t": lambda: {
        "table": JUDGED,
        "dv": "number",
        "within": "info",
        "subject": "observer",
        "first": "full",
        "second": "structure",
    },
    "psychophysics.psychometric": lambda: {
        "table": JUDGED,
        "level": "number",
        "response": "one",
        "observer": "observer",
    },
    "psychophysics.rank_correlation": lambda: {"x": numbers(6), "y": numbers(6)[::-1]},
    "psychophysics.read_trials": lambda: {"answers": ANSWERS},
    "psychophysics.save_weights": lambda: {
        "weights": pd.DataFrame({"weight": [1.0]}, index=["head"]),
        "path": "{folder}/weights.csv",
        "metric": "kovar",
    },
    "psychophysics.scheffe": lambda: {"table": JUDGED, **DESIGN},
    "psychophysics.search_shape": lambda: {
        "columns": lambda n: numbers(10, 2) ** n,
        "y": numbers(10),
        "bounds": (0.1, 2),
        "n_grid": 3,
    },
    "psychophysics.sensitivity": lambda: RESPONSES,
    "psychophysics.split_half": lambda: {"chosen": CHOSEN, "shown": SHOWN, "n_splits": 3},
    "psychophysics.triangle_inequalities": lambda: {"table": DISTANCES},
    "psychophysics.walker_errors": lambda: ITEMS,
    "quality.assess": lambda: {"trajectories": walk()},
    "simulation.add_effect": lambda: {
        "walk": walk(),
        "effect": ew.simulation.random_effect("structure", size_mm=10),
        "amount": 1.0,
    },
    "simulation.true_direction": lambda: {"population": people(), "trait": "sex", "n_people": 10},
    "simulation.true_events": lambda: {"walk": walk()},
    "simulation.truth_of": lambda: {"population": people()},
    "stimulus.make_stimulus": lambda: {"figures": walkers()[0]},
    "stimulus.with_information": lambda: {
        "population": people(),
        "walker": people().X[0],
        "information": "structure",
    },
    "study.process_capture": lambda: {"path_or_capture": walk()},
    "study.walks_of_population": lambda: {"population": people().select(range(2))},
}

MAY_BE_EMPTY = {
    "metric.missing_groups: none",
    "psychophysics.goodness: none",
    "population.Population.add: none",
}
"""No rows tell something too, or change nothing."""
ARRAYS = re.compile(r"ArrayLike|ndarray|DataArray|\bClips?\b|\bWalker\b|\bPopulation\b|DataFrame")
LABELS = ("groups", "trait")
"""Arguments that may be words."""


def with_one(values, number):
    array = np.array(values, dtype=np.longdouble if number == "long" else type(number))
    array.flat[0] = np.longdouble("1e4000") if number == "long" else number
    return array


def wrong_numbers(values):
    array = np.asarray(values, dtype=float)
    return {
        "complex": array + 1j,
        "infinite": with_one(array, np.inf),
        "1e150": with_one(array, 1e150),
        "a long double of 1e4000": with_one(array, "long"),
        "objects": np.array([object()] * 3),
        "rows of different length": [[1.0], [1.0, 2.0]],
        "none": array[:0],
        "a path": "walk.c3d",
    }


def wrong_trajectories(values):
    walk = values if isinstance(values, xr.DataArray) else ew.metric.prepare(values).clip
    twice = [*walk.marker.values[:-1], walk.marker.values[0]]
    return {
        "a list": walk.values.tolist()[:2],
        "a path": "walk.c3d",
        "a Path": Path("walk.c3d"),
        "nothing": None,
        "complex": walk + 1j,
        "infinite": walk.copy(data=with_one(walk.values, np.inf)),
        "1e150": walk.copy(data=with_one(walk.values, 1e150)),
        "objects": walk.copy(data=np.full(walk.shape, object(), dtype=object)),
        "names twice": walk.assign_coords(marker=twice),
        "no frames": walk[:0],
        "no markers": walk[:, :0],
    }


def wrong_walkers(values):
    several = list(values.values()) if isinstance(values, dict) else values
    if isinstance(several, list):
        mapped = (
            (lambda each: dict(zip("abc", each, strict=False)))
            if isinstance(values, dict)
            else list
        )
        return {
            "none": mapped([]),
            "one of them a path": mapped([several[0], "walk.c3d"]),
            "one of them trajectories": mapped([several[0], walk()]),
        }
    return {"a path": "walk.c3d", "a list": [1, 2], "nothing": None}


def wrong_clips(values):
    return {
        "none": {},
        "one of them a path": {"a": values["a"], "b": "walk.c3d"},
        "one of them complex": {"a": values["a"], "b": walk() + 1j},
        "a path": "walk.c3d",
        "nothing": None,
    }


def wrong_others(_values):
    return {"a path": "walk.c3d", "a list": [1, 2], "nothing": None}


def wrong_tables(values):
    return {**wrong_others(values), "none": values.iloc[:0]}


def wrong_values(annotation, name, value):
    """Return wrong values for an argument by what they are, from its annotation and a right one."""
    if "DataFrame" in annotation:
        return wrong_tables(value)
    if "Clips" in annotation or "Mapping[str, Clip]" in annotation:
        return wrong_clips(value)
    if "Mapping[str, ArrayLike]" in annotation:
        return {key: {"m": wrong} for key, wrong in wrong_numbers(value["m"]).items()} | {
            "none": {}
        }
    if isinstance(value, xr.DataArray) and "marker" not in value.dims:
        return wrong_others(value)
    if isinstance(value, xr.DataArray) or "Clip" in annotation:
        return wrong_trajectories(value)
    if "Walker" in annotation and "ndarray" not in annotation:
        return wrong_walkers(value)
    if "Population" in annotation:
        return wrong_others(value)
    found = wrong_numbers(value)
    if name in LABELS:
        return {key: found[key] for key in ("rows of different length", "none")}
    return found


def arrays_of(name):
    """Return the annotations of the arguments that take arrays, walks, walkers or tables."""
    parameters = inspect.signature(PUBLIC[name]).parameters.values()
    return {
        p.name: p.annotation
        for p in parameters
        if isinstance(p.annotation, str)
        and ARRAYS.search(p.annotation)
        and "Callable" not in p.annotation
    }


@cache
def raises_of(path):
    nodes = ast.walk(ast.parse(Path(path).read_text(encoding="utf-8")))
    return [(n.lineno, n.end_lineno) for n in nodes if isinstance(n, ast.Raise)]


def problem_of(function, arguments, folder):
    """Return what is wrong with how a function takes wrong arguments; nothing if it refuses."""
    arguments = {
        key: value.format(folder=folder) if isinstance(value, str) else value
        for key, value in arguments.items()
    }
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", UserWarning)
            function(**arguments)
    except (ValueError, TypeError) as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        ours = Path(last.filename).is_relative_to(ROOT)
        if ours and any(a <= last.lineno <= b for a, b in raises_of(last.filename)):
            return ""
        where = f"{Path(last.filename).name}:{last.lineno}"
        return f"ends in words of others: {type(error).__name__} at {where}: {str(error)[:80]}"
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(last.filename).name}:{last.lineno}"
        return f"ends in {type(error).__name__} at {where}: {str(error)[:80]}"
    return "is taken"


@pytest.mark.parametrize(
    "name", [name for name in PUBLIC if name not in OF_FILES and arrays_of(name)]
)
def test_functions_refuse_what_is_no_array_or_walk_in_words_of_their_own(name, tmp_path):
    assert name in CALLS, f"add a call of {name} that works to CALLS"
    function, right = PUBLIC[name], CALLS[name]()
    problems = {}
    for key, annotation in arrays_of(name).items():
        if right.get(key) is None:
            continue
        for what, wrong in wrong_values(annotation, key, right[key]).items():
            if (wrong is None and "None" in annotation) or f"{name}: {what}" in MAY_BE_EMPTY:
                continue
            if problem := problem_of(function, right | {key: wrong}, tmp_path):
                problems[f"{key}: {what}"] = problem
    assert not problems, "\n".join(f"{key}: {problem}" for key, problem in problems.items())


@pytest.mark.parametrize("name", [n for n in PUBLIC if n not in OF_FILES and arrays_of(n)])
def test_real_numbers_of_any_kind_are_taken(name, tmp_path):
    function, right = PUBLIC[name], CALLS[name]()
    for key, annotation in arrays_of(name).items():
        value = right.get(key)
        if not re.search("ArrayLike|ndarray", annotation) or not isinstance(value, np.ndarray):
            continue
        for kind in (np.float16, np.longdouble, object):
            exact = value.astype(np.float16).astype(float) if value.dtype == float else value
            if "table" in key:
                exact = np.round(value, 2)
            arguments = right | {key: exact.astype(kind)}
            problem = problem_of(function, arguments, tmp_path)
            assert problem == "is taken", f"{key} of {np.dtype(kind)}: {problem or 'is refused'}"


@pytest.mark.parametrize(
    "estimator",
    [ew.WalkerSpace, ew.DiscriminantRegressor, ew.PerceptualMetric, ew.DiscriminantClassifier],
)
@pytest.mark.parametrize("number", [1e150, "long", -np.inf, np.nan])
def test_estimators_say_which_number_cannot_be_used(estimator, number):
    good = numbers(12, 3)
    wrong = with_one(good[::-1], number)[::-1]
    place = r"must be real numbers.* in row 11, column "
    with pytest.raises(ValueError, match=place + "0"):
        estimator().fit(wrong, Y)
    with pytest.raises(ValueError, match=place + "'x'"):
        estimator().fit(pd.DataFrame(wrong, columns=list("xyz")), Y)
    fitted = estimator().fit(good, Y)
    with pytest.raises(ValueError, match=place + "0"):
        getattr(fitted, "predict" if hasattr(fitted, "predict") else "transform")(wrong)
    if isinstance(fitted, ew.WalkerSpace):
        scores = with_one(fitted.transform(good), number)
        with pytest.raises(ValueError, match=r"^K must be real numbers.* in row 0, column 0"):
            fitted.inverse_transform(scores)
    else:
        with pytest.raises(ValueError, match=r"^y must be real numbers.* at index 0|rows 0"):
            fitted.fit(good, with_one(Y, number))


@pytest.mark.parametrize("number", [np.inf, 1e150])
def test_maps_with_infinite_cells_are_not_drawn(number):
    picture = ew.plotting.MapPicture(with_one(numbers(10, 10), number), STRIDE, STRIDE, "map")
    with pytest.raises(ValueError, match="values must be real numbers"):
        ew.plotting.figure_maps([picture])
