"""Every mark in the code can be looked up."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
MARK = re.compile(r"\b[JWMAP]\d{1,2}\b")


def test_each_mark_that_is_cited_is_explained() -> None:
    explained = set(re.findall(r"(?m)^\| ([JWMAP]\d+) \|", (ROOT / "docs/marks.md").read_text()))
    cited = {
        mark
        for source in (ROOT / "src").rglob("*.py")
        for brackets in re.findall(r"\([^()]*\)", source.read_text("utf-8"))
        for mark in MARK.findall(brackets)
    }
    assert cited
    assert cited <= explained
