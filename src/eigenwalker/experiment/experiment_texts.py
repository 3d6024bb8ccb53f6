"""The texts of an experiment: one Markdown file a language, with a section for each text."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
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


def template(design: Design, names: Sequence[str]) -> str:
    """Return the English texts of a design, to be edited and translated.

    The texts of its tasks follow each other; words of the design that have no text yet stand for
    themselves.
    """
    common = _TEXTS.joinpath("common.en.md").read_text(encoding="utf-8")
    first, *others = [
        _TEXTS.joinpath(f"{name}.en.md").read_text(encoding="utf-8")
        for name in dict.fromkeys(names)
    ]
    text = first + "\n" + common
    known = sections_of(text)
    of_others = {name: body for other in others for name, body in sections_of(other).items()}
    keys = _keys([key for block in design.blocks for key in getattr(block, "choices", [])], known)
    for name in missing_texts(design, Texts("en", known)):
        text += f"\n# {name}\n{of_others.get(name) or keys.get(name) or _plain(name)}\n"
    return text


def _keys(choices: Sequence[str], known: Mapping[str, str]) -> dict[str, str]:
    """Return a key and a button for each choice: its first letter that is free."""
    found: dict[str, str] = {}
    taken = {known[f"key_{name}"].lower() for name in choices if f"key_{name}" in known}
    for name in dict.fromkeys(choices):
        letters = [each for each in (*name.lower(), *"123456789") if each.isalnum()]
        if f"key_{name}" not in known:
            key = next(each for each in letters if each not in taken)
            taken.add(key)
            words = _plain(f"button_{name}")
            found |= {f"key_{name}": key, f"button_{name}": f"{words} ({key.upper()})"}
    return found


def _plain(name: str) -> str:
    """Return the words of a name, without the kind of text that it begins with."""
    return name.partition("_")[2].replace("_", " ") or name


def wrong_texts(design: Design, texts: Texts) -> list[str]:
    """Return what is wrong with texts that are there: keys of which one means two answers."""
    wrong: list[str] = []
    for block in design.blocks:
        choices = getattr(block, "choices", [])
        keys = [texts.sections.get(f"key_{name}", "").lower() for name in choices]
        if len(keys) == 2 and keys[0] and keys[0] == keys[1]:
            names = " and ".join(f"'# key_{name}'" for name in choices)
            wrong.append(f"{names} are the same key {keys[0]!r}; change one")
    if texts.sections.get("direction", "ltr") not in ("ltr", "rtl"):
        wrong.append("'# direction' must be ltr or rtl")
    return [*dict.fromkeys(wrong)]


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
