"""Names of modules and public names use the words of the glossary, and no private vocabulary."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import pytest

import eigenwalker as ew

PACKAGE = Path(ew.__file__).parent
ROOT = Path(__file__).parents[1]
PUBLIC_ROOMS = [path.parent.name for path in PACKAGE.glob("*/__init__.pyi")]
GONE = {
    *("foretold", "foretells", "wish", "wishes", "granted", "wood", "varnish", "troupe", "cast"),
    *("attempt", "attempts", "mend", "mends", "mended", "mending", "told", "said", "asked", "kept"),
    *("amiss", "came", "act", "strange", "strangeness", "workshop", "journal"),
}


def words(name: str) -> list[str]:
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)]


def glossary() -> set[str]:
    text = (ROOT / "docs" / "conventions.md").read_text(encoding="utf-8")
    section = text[text.index("## Words") :]
    terms = re.findall(r"(?m)^\| ([^|]+) \|", section)
    plain = section[section.index("### Plain words") :]
    return {word for part in (*terms, plain) for word in re.findall(r"[a-z]+", part.lower())}


def names() -> list[str]:
    modules = {path.stem for path in PACKAGE.rglob("*.py") if not path.stem.startswith("__")}
    public = {
        name
        for room in PUBLIC_ROOMS
        for name in importlib.import_module(f"eigenwalker.{room}").__all__
    }
    return sorted(modules | public | {path.parent.name for path in PACKAGE.glob("*/__init__.py")})


def test_modules_and_public_names_use_the_words_of_the_glossary() -> None:
    known = glossary()
    unknown = {
        name: missing
        for name in names()
        if (missing := [w for w in words(name) if w not in known and w.rstrip("s") not in known])
    }
    assert not unknown, "a new word goes into docs/conventions.md first"


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: path.stem)
def test_no_identifier_has_a_word_of_the_old_vocabulary(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    used = {path.stem}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            used.add(node.name)
        elif isinstance(node, ast.arg):
            used.add(node.arg)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            used.add(node.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            used.add(node.attr)
    assert not {name for name in used if GONE & set(words(name))}
