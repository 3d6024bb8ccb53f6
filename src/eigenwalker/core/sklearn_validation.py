"""scikit-learn's validation of arrays, with types."""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from sklearn.utils import validation

validate_data: Callable[..., Any] = cast("Any", validation).validate_data
"""Its default values make type checkers take X for a str."""
