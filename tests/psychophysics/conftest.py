"""Results of R for simulated studies, where they lie beside the clone."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def r_results(captures: Path) -> Path:
    folder = captures.parent / "notes" / "r-results"
    if not folder.is_dir():
        pytest.skip(f"no results of R in {folder}")
    return folder
