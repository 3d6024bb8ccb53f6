"""The lines of docs/metric.md run from the first to the last."""

from __future__ import annotations

import re
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from eigenwalker.io.write import write_mocap
from eigenwalker.simulation.walk import simulate_walk

PAGE = Path(__file__).parents[2] / "docs" / "metric.md"
NAMES = ("anna", "ben", "cleo", "dora", "emil", "fritz")


@pytest.fixture(scope="module")
def lab(tmp_path_factory) -> Path:
    """Captures of six people, and answers of observers who look at how high elbows are held."""
    place = tmp_path_factory.mktemp("lab")
    (place / "captures").mkdir()
    for seed, name in enumerate(NAMES):
        walk = simulate_walk(seed=seed, duration_s=4.0, rate_hz=50, markers="skin")
        write_mocap(walk, place / "captures" / f"{name}.c3d")
    rng = np.random.default_rng(0)
    seen = {name: float(rng.normal()) for name in NAMES}
    rows = []
    for trial in range(240):
        four = rng.permutation(NAMES)[:4].tolist()
        pairs = list(combinations(four, 2))
        felt = [abs(seen[a] - seen[b]) + 0.3 * rng.gumbel() for a, b in pairs]
        rows.append([f"observer {trial % 6}", *four, *pairs[int(np.argmin(felt))]])
    columns = ["observer", *"abcd", "chosen_1", "chosen_2"]
    pd.DataFrame(rows, columns=columns).to_csv(place / "answers.csv", index=False)
    return place


def test_lines_of_the_page_run_one_after_the_other(lab, monkeypatch):
    monkeypatch.chdir(lab)
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    assert len(blocks) == 7
    assert names["metric"].predict(names["X"]).shape == (15,)
    assert (names["metric"].weights_ >= 0).all()
    assert names["comparison"].shares.sum() == pytest.approx(1)
