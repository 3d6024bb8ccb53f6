"""Which walks are near to each other."""

from __future__ import annotations

import numpy as np
import pandas as pd

from eigenwalker.metric import label_table


def test_walks_of_a_person_are_not_each_others_nearest() -> None:
    place = np.array([0.0, 0.1, 1.0, 1.1, 2.0, 2.1])
    names = list("abcdef")
    table = pd.DataFrame(np.abs(place[:, None] - place), names, names)
    labels = dict(zip(names, ["slow", "slow", "fast", "fast", "slow", "slow"], strict=True))
    persons = dict(zip(names, ["1", "1", "2", "2", "3", "3"], strict=True))
    assert label_table(table, labels)["nearest"].tolist() == [1, 1]
    apart = label_table(table, labels, persons=persons)
    assert apart["nearest"].tolist() == [0, 0]
    assert apart.loc["slow", "within"] == 2
    assert apart.loc["slow", "by_chance"] == 0.5
    assert np.isnan(apart.loc["fast", "within"])
