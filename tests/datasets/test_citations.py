"""What to cite: whole BibTeX entries, one for each collection, and the same in CITATION.cff."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import eigenwalker as ew
from eigenwalker.datasets import bibtex
from eigenwalker.datasets.downloads import collections
from eigenwalker.report.words import CITE

NAMES = ["eigenwalker", "bml", "moler", *collections()]
CFF = (Path(__file__).parents[2] / "CITATION.cff").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NAMES)
def test_entries_are_whole_and_about_what_is_asked_for(name: str) -> None:
    text = bibtex(name)
    assert text.count("{") == text.count("}")
    for entry in text.strip().split("\n\n"):
        assert re.match(r"@\w+\{\w+,\n", entry)
        fields = dict(re.findall(r"^  (\w+) = \{(.*)\},?$", entry, re.MULTILINE))
        assert {"author", "title"} <= set(fields)
        assert name in fields["keywords"].split(", ")


@pytest.mark.parametrize("name", collections())
def test_notice_and_bibtex_name_one_source(name: str) -> None:
    years = set(re.findall(r"\((\d{4})\)", collections()[name].citation))
    assert years == set(re.findall(r"year = \{(\d+)\}", bibtex(name)))


def test_the_citation_file_is_that_of_this_version_and_names_the_same_papers() -> None:
    assert re.search(r"^version: (.*)$", CFF, re.MULTILINE)[1] == ew.__version__
    titles = [title.replace("{", "").replace("}", "")
              for title in re.findall(r"title = \{(.*)\}", bibtex())]  # fmt: skip
    assert [title for title in titles if title not in CFF and "booktitle" not in title] == []


def test_the_program_has_a_year_and_reports_cite_papers_as_the_command_does() -> None:
    entries = {entry.partition(",")[0]: entry for entry in bibtex().split("\n\n")}
    assert "year = {2026}" in entries["@software{eigenwalker"]
    place = re.search(r"howpublished = \{(.*)\}", entries["@misc{prazak2010perception"])
    assert place is not None
    assert CITE["prazak2010"].endswith(f"{place[1]}.")


def test_a_data_set_that_is_unknown_is_refused_with_those_that_are() -> None:
    with pytest.raises(ValueError, match=r"'kinnect'; there are \['bandai-namco', "):
        bibtex("kinnect")
