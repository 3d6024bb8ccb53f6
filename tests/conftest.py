"""What several test modules share: where real captures are, and names for doctests."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

_BESIDE = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def captures() -> Path:
    """Folder of real captures, which are licensed to test with but not to ship."""
    folder = Path(os.environ.get("EIGENWALKER_DATA", _BESIDE))
    if not folder.is_dir():
        pytest.skip(f"no real captures in {folder}; name their folder in EIGENWALKER_DATA")
    return folder
