"""What is known of walkers: one row for each, one column a trait."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import LARGEST, check_kind


def check_traits(given: Any) -> pd.DataFrame:
    """Return a table of traits, if no number in it is one that statistics cannot be made of."""
    check_kind(given, (pd.DataFrame, Mapping), "a table of traits, one row a walker")
    traits = pd.DataFrame(given).reset_index(drop=True)
    for name in traits.select_dtypes("number"):
        wrong = np.flatnonzero(traits[name].abs() > LARGEST)
        if wrong.size:
            row = int(wrong[0])
            raise ValueError(
                f"The trait {str(name)!r} of row {row + 1} is {traits[name].iloc[row]:g}; give "
                f"numbers up to {LARGEST:g} in size, and leave empty what is not known."
            )
    return traits
