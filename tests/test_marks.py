"""Codes that point at places in the papers: only in tests and docs/marks.md, and all explained."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
CODE = re.compile(r"\b[JWMAP]\d{1,2}\b")


def codes_in(folder: str) -> dict[str, set[str]]:
    """Codes in brackets, with the files that cite them."""
    cited: dict[str, set[str]] = {}
    for source in (ROOT / folder).rglob("*.py"):
        for brackets in re.findall(r"\([^()]*\)", source.read_text("utf-8")):
            for code in CODE.findall(brackets):
                cited.setdefault(code, set()).add(source.name)
    return cited


def test_each_code_that_tests_cite_is_explained() -> None:
    explained = set(re.findall(r"(?m)^\| ([JWMAP]\d+) \|", (ROOT / "docs/marks.md").read_text()))
    cited = codes_in("tests")
    assert cited
    assert set(cited) <= explained


def test_the_source_cites_papers_and_equations_instead_of_codes() -> None:
    assert not codes_in("src")
