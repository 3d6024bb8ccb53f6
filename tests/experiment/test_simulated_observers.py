"""What simulated observers are like is found again in the export of their answers."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm, spearmanr

from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.experiment_folder import ANSWERS
from eigenwalker.experiment.export import export_experiment
from eigenwalker.experiment.service import Service

Tables = tuple[pd.DataFrame, dict[tuple[str, str], float]]


@pytest.fixture
def simulated(small: Callable[..., Path], tmp_path: Path) -> Callable[..., Tables]:
    """Maker of the answers of simulated observers, and of their truth by name and whom it is of."""

    def make(design: str, number: int, **model: float) -> Tables:
        folder = small(design)
        with AnswerWriter(folder / ANSWERS) as writer:
            Service(folder, writer).simulate(number, seed=1, model={"missed": 0.0, **model})
        export_experiment(folder, tmp_path / "data")
        path = min((tmp_path / "data").glob("data/*_data.csv"))  # others are study-..._description
        with (folder / "simulated_truth.csv").open(encoding="utf-8") as file:
            rows = csv.DictReader(file)
            truth = {(row["name"], row["of"]): float(row["value"]) for row in rows}
        return pd.read_csv(path), truth

    return make


def test_errors_of_choices_are_those_of_the_sensitivity_to_each_view(
    simulated: Callable[..., Tables],
) -> None:
    answers, truth = simulated("troje2002", 24, sensitivity_sd=0.0, bias_sd=0.0, lapse=0.0)
    along = answers.walker.map(lambda name: truth["female/male", name])
    turned = np.abs(np.sin(np.radians(answers.view_deg)))
    left = answers.information.map({"full": 1.0, "structure": 0.6, "dynamics": 0.9})
    is_male = answers.right_answer == "male"
    signal = np.where(is_male, along, -along) * 1.5 * (1 - 0.5 * turned) * left / 2
    expected = norm.cdf(signal)
    for _, of_view in answers.groupby(answers.view_deg.abs()):
        wanted = expected[of_view.index]
        error = np.sqrt(np.sum(wanted * (1 - wanted))) / len(wanted)
        assert abs(of_view.correct.mean() - wanted.mean()) < 4 * error


def test_mean_ratings_lie_along_the_axis_that_raters_see(
    simulated: Callable[..., Tables],
) -> None:
    answers, truth = simulated("wdp2002", 24)
    for scale, group in (("mood", "happy-sad"), ("calm", "nervous-relaxed")):
        means = answers[answers.group == group].groupby("walker").rating.mean()
        along = [truth[scale, str(name)] for name in means.index]
        assert np.corrcoef(means, along)[0, 1] > 0.95


@pytest.mark.parametrize(("sensitivity", "low", "high"), [(8.0, 0.8, 1.0), (0.02, 0.25, 0.42)])
def test_the_odd_one_is_found_by_who_sees_well(
    simulated: Callable[..., Tables], sensitivity: float, low: float, high: float
) -> None:
    answers, _ = simulated("odd_one_out", 12, sensitivity=sensitivity)
    assert low < answers.correct.mean() < high


def test_settings_lie_where_the_bias_puts_them(simulated: Callable[..., Tables]) -> None:
    answers, truth = simulated("adjustment", 12, bias_sd=1.0, lapse=0.0)
    means = answers.groupby("observer").setting.mean()
    at_30_deg = 0.75  # of the sensitivity from the front
    wanted = [
        -2 * truth["bias", str(n)] / (at_30_deg * truth["sensitivity", str(n)]) for n in means.index
    ]
    assert spearmanr(means, wanted).statistic > 0.9
    assert np.abs(means - wanted).max() < 1.0


def test_staircases_end_at_more_dots_for_who_sees_better(
    simulated: Callable[..., Tables],
) -> None:
    answers, truth = simulated("detection", 12, sensitivity_sd=0.8, bias_sd=0.0, lapse=0.0)
    late = answers[answers.trial > 20]
    levels = np.log(late.level).groupby(late.observer).mean()
    better = [truth["sensitivity", str(n)] for n in levels.index]
    assert spearmanr(levels, better).statistic > 0.8
