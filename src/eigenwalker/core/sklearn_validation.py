"""scikit-learn's validation of arrays, with types and a limit of size."""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

from typing import Any, cast

import numpy as np
from sklearn.utils import validation

from eigenwalker.core.arguments import check_numbers


def validate_data(estimator: Any, X: Any, y: Any = "no_validation", **checks: Any) -> Any:
    """Return what scikit-learn's function of that name does, if squares of it can be summed."""
    _check_size(y, "y")
    with np.errstate(over="ignore"):  # of longer floats: they become infinite
        checked: Any = cast("Any", validation).validate_data(
            estimator, X, y, ensure_all_finite=False, **checks
        )
    arrays: Any = (checked,) if hasattr(checked, "dtype") else checked
    for name, values, given in zip("Xy", arrays, (X, y), strict=False):
        _check_size(values, name, getattr(given, "columns", None))
    return checked


def _check_size(values: Any, name: str, columns: Any = None) -> None:
    """Refuse floating-point numbers that are missing, infinite or too large, by their place."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different length, which scikit-learn refuses
        return
    if array.dtype.kind == "f":
        check_numbers(array, name, least=0, columns=columns)
