"""The texts of an experiment: one Markdown file a language, with a section for each text."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from pathlib import Path

from eigenwalker.experiment.design import (
    Adjustment,
    Choice,
    Design,
    Detection,
    OddOneOut,
    Rating,
    SameOrDifferent,
    SimilarPair,
)

PAGES = (
    *("consent", "instructions", "break", "pause", "welcome_back", "debriefing", "warning"),
    "blind_spot",
)
"""Texts that are pages: paragraphs, lists, emphasis. All others are plain."""
_SECTION = re.compile(r"(?m)^# +([A-Za-z0-9_-]+) *$")
_TEXTS = files("eigenwalker.experiment").joinpath("texts")


@dataclass(frozen=True)
class Texts:
    """The texts of one language by their names."""

    language: str
    sections: dict[str, str]

    def __getitem__(self, name: str) -> str:
        return self.sections[name]

    @property
    def consent_hash(self) -> str:
        """Hash of exactly what an observer consents to."""
        return hashlib.sha256(self["consent"].encode()).hexdigest()

    @cached_property
    def for_page(self) -> dict[str, str]:
        """The texts as the page shows them: pages as HTML without any script."""
        markdown = _markdown()
        return {
            name: markdown.render(text) if name in PAGES else text
            for name, text in self.sections.items()
        }


def _markdown():
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark", {"html": False}).disable(["image", "html_block", "html_inline"])


def sections_of(text: str) -> dict[str, str]:
    r"""Return the sections of a text by their headings.

    Examples
    --------
    >>> sections_of("# begin\nBegin\n\n# stop\nStop\n")
    {'begin': 'Begin', 'stop': 'Stop'}
    """
    parts = _SECTION.split(text.replace("\r\n", "\n"))
    return {name: body.strip() for name, body in zip(parts[1::2], parts[2::2], strict=True)}


def read_texts(folder: Path, language: str) -> Texts:
    """Return the texts of a language; what the file lacks is taken from the built-in English."""
    path = Path(folder) / f"{language}.md"
    own = sections_of(path.read_text(encoding="utf-8-sig"))
    common = sections_of(_TEXTS.joinpath("common.en.md").read_text(encoding="utf-8"))
    return Texts(language, {**common, **own} if language == "en" else own)


def template(name: str) -> str:
    """Return the English texts of a design, to be edited and translated."""
    own = _TEXTS.joinpath(f"{name}.en.md").read_text(encoding="utf-8")
    return own + "\n" + _TEXTS.joinpath("common.en.md").read_text(encoding="utf-8")


def missing_texts(design: Design, texts: Texts) -> list[str]:
    """Return the names of texts that a design needs and a language lacks."""
    common = sections_of(_TEXTS.joinpath("common.en.md").read_text(encoding="utf-8"))
    needed = ["title", "consent", "instructions", "debriefing"]
    needed += [name for name in common if not name.startswith(tuple(_SOMETIMES))]
    for block in design.blocks:
        if block.feedback:
            needed += [name for name in common if name.startswith("feedback_")]
        if isinstance(block, Choice | Detection | SameOrDifferent):
            needed += [f"{part}_{name}" for name in block.choices for part in ("key", "button")]
        elif isinstance(block, Rating):
            scales = {block.scale or group.scale for group in design.groups}
            needed += [f"{scale}_{end}" for scale in sorted(map(str, scales)) for end in _ENDS]
        elif isinstance(block, SimilarPair):
            needed += ["figure", "pair_chosen"]
        elif isinstance(block, OddOneOut):
            needed += ["figure"]
        elif isinstance(block, Adjustment):
            needed += [name for name in common if name.startswith("slider_")]
    for question in design.questions:
        needed.append(f"question_{question.name}")
        needed += [f"option_{option}" for option in question.options]
    return [name for name in dict.fromkeys(needed) if not texts.sections.get(name)]


_ENDS = ("first", "last")
_SOMETIMES = ("feedback_", "slider_")
"""Beginnings of common texts that only some designs show."""
