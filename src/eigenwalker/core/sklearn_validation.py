"""scikit-learn's validation of arrays, with types and a limit of size."""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

from typing import Any, cast

import numpy as np
from sklearn.utils import validation

from eigenwalker.core.arguments import check_numbers


def validate_data(estimator: Any, X: Any, y: Any = "no_validation", **checks: Any) -> Any:
    """Return what scikit-learn's function of that name does, if squares of it can be summed."""
    with np.errstate(over="ignore"):  # of longer floats: they become infinite
        checked: Any = cast("Any", validation).validate_data(estimator, X, y, **checks)
    arrays: Any = (checked,) if hasattr(checked, "dtype") else checked
    for name, values in zip("Xy", arrays, strict=False):
        if values.dtype.kind == "f":
            check_numbers(values, name, least=0)
    return checked
