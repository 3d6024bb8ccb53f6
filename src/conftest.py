"""Names that docstring examples take as given."""

from __future__ import annotations

import numpy as np
import pytest

import eigenwalker as ew


@pytest.fixture(autouse=True)
def _names_for_examples(doctest_namespace: dict[str, object]) -> None:
    doctest_namespace.update(np=np, ew=ew)
