"""Reading a design: all that is wrong with it at once, each with its line and what to do."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from eigenwalker.experiment.design import (
    Adjustment,
    AnyBlock,
    Choice,
    Design,
    Detection,
    OddOneOut,
    Rating,
    SameOrDifferent,
)

MAX_BYTES = 1_000_000
_NO_TOML = {
    "overwrite": "a key is there twice, take one out",
    "twice": "a table that may be there several times is written as [[blocks]]",
    "Invalid value": "texts are in quotes; true and false begin with small letters",
    "after a key": "write name = value",
}
"""What to do, by words of Python's own messages."""
_HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\s-]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"""^\s*["']?([A-Za-z0-9_-]+)["']?\s*=""")
_LINE = re.compile(r"\(at line (\d+)")


@dataclass(frozen=True)
class Fault:
    """What is wrong in a design, where, and what to do."""

    line: int
    problem: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.problem}"


class BadDesign(ValueError):  # noqa: N818 - the name says what it is
    """A design with faults; the message has all of them, one a line.

    `without` is the design without the keys that are wrong, where it is one.
    """

    def __init__(self, source: str, faults: Sequence[Fault], without: Design | None = None) -> None:
        self.without = without
        self.faults = sorted(faults, key=lambda fault: fault.line)
        super().__init__("\n".join(f"{source}, {fault}" for fault in self.faults))


def read_design(path: Path) -> Design:
    """Return the design of a TOML file.

    Parameters
    ----------
    path : Path
        Such as ``folder/design.toml``.

    Returns
    -------
    Design

    Raises
    ------
    ValueError
        If it is no design: all faults, each with its line and what to do.

    See Also
    --------
    session_trials : The trials that a design gives an observer.
    """
    return parse_design(design_text(Path(path)), Path(path).name)


def _without_wrong(content: dict[str, Any], error: ValidationError) -> Design | None:
    """Return the design without the keys that are wrong, to look for what else is."""
    rest = deepcopy(content)
    for each in error.errors():
        *where, key = _path(each["loc"])
        if each["type"] == "missing":
            return None
        table = _at(rest, where)
        if isinstance(table, list):
            return None
        if isinstance(table, dict):
            table.pop(key, None)
    try:
        return Design.model_validate(rest)
    except ValidationError:
        return None


def _at(content: Any, where: Sequence[str | int]) -> Any:
    """Return what is at a place, None where there is nothing."""
    for part in where:
        try:
            content = content[part]
        except (KeyError, IndexError, TypeError):
            return None
    return content


def _path(loc: Sequence[str | int]) -> list[str | int]:
    """Return where an error is, without the task by which pydantic names members of a union."""
    path = [*loc]
    if len(path) > 2 and path[0] == "blocks":
        del path[2]
    return path


def design_text(path: Path) -> str:
    """Return the text of a design file."""
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"{path.name} has more than {MAX_BYTES} bytes, which no design needs.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is not in UTF-8; save it as UTF-8.") from None


def parse_design(text: str, source: str = "design.toml") -> Design:
    """Return the design that a text of TOML describes."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _LINE.search(str(error))
        line = int(found[1]) if found else text.count("\n") + 1
        why = str(error).partition(" (at")[0]
        why += next((f"; {remedy}" for words, remedy in _NO_TOML.items() if words in why), "")
        raise BadDesign(source, [Fault(line, f"this is no TOML: {why}")]) from None
    except RecursionError:
        raise BadDesign(source, [Fault(1, "this is nested too deeply")]) from None
    lines = lines_of(text)
    try:
        design = Design.model_validate(content)
    except ValidationError as error:
        faults = [_fault(each, lines) for each in error.errors()]
        rest = _without_wrong(content, error)
        if rest is not None:
            faults += [fault_at(where, problem, lines) for where, problem in _conflicts(rest)]
        raise BadDesign(source, faults, rest) from None
    if faults := [fault_at(where, problem, lines) for where, problem in _conflicts(design)]:
        raise BadDesign(source, faults, design)
    return design


def lines_of(text: str) -> dict[tuple[str | int, ...], int]:
    r"""Return the line of each table and key of a text of TOML.

    Examples
    --------
    >>> lines_of("seed = 1\n[[blocks]]\ntrials = 3\n")[("blocks", 0, "trials")]
    3
    """
    lines: dict[tuple[str | int, ...], int] = {}
    table: tuple[str | int, ...] = ()
    last: dict[tuple[str | int, ...], int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            table = ()
            parts = [part.strip() for part in header[2].split(".")]
            for part in parts[:-1]:
                table = (*table, part)
                table = (*table, last[table]) if table in last else table
            table = (*table, parts[-1])
            if header[1] == "[[":
                last[table] = last.get(table, -1) + 1
                lines.setdefault(table, number)
                table = (*table, last[table])
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            lines.setdefault((*table, key[1]), number)
    return lines


def _line(where: Sequence[str | int], lines: dict[tuple[str | int, ...], int]) -> int:
    """Return the line of the innermost part of a path that the file has a line for."""
    for length in range(len(where), 0, -1):
        if tuple(where[:length]) in lines:
            return lines[tuple(where[:length])]
    return 1


def fault_at(
    where: Sequence[str | int], problem: str, lines: dict[tuple[str | int, ...], int]
) -> Fault:
    """Return a fault with its line."""
    table = [part for part in where if part in _TABLES or isinstance(part, int)]
    of = f"{name_of(table[:2])}: " if len(table) > 1 else ""
    return Fault(_line(where, lines), of + problem)


def _fault(error: Any, lines: dict[tuple[str | int, ...], int]) -> Fault:
    """Return an error of pydantic as a fault: where, what is expected, what to do."""
    where = _path(error["loc"])
    name = name_of(where)
    match error["type"]:
        case "extra_forbidden":
            known = _known_words(error["loc"])
            near = get_close_matches(str(where[-1]), known, n=1)
            remedy = f"write {near[0]!r}" if near else f"known here are {', '.join(known)}"
            problem = f"{name} is an unknown word; {remedy}"
        case "missing":
            example = _EXAMPLES.get(str(where[-1]))
            problem = f"{name} is missing; add {example or 'it'}"
        case "union_tag_not_found":
            known = ", ".join(tasks())
            problem = f'{name} lacks its task; add task = "choice", or one of {known}'
        case "union_tag_invalid":
            given = error["input"].get("task")
            problem = f"{name}: the task {given!r} is unknown; choose from {', '.join(tasks())}"
        case "value_error":
            table = f"[{name}]" if name in Design.model_fields else name
            problem = f"{table}: {str(error['msg']).removeprefix('Value error, ')}"
        case "less_than_equal" if where == ["version"]:
            problem = f"version {error['input']} is of a newer program; write version = 1"
        case _:
            given = error["input"]
            shown = f", not {given!r}" if isinstance(given, int | float | str) else ""
            problem = f"{name} {_expected(error, str(where[-1]) if where else '')}{shown}"
    return Fault(_line(where, lines), problem)


_EXAMPLES = {
    "format": 'format = "eigenwalker experiment"',
    "version": "version = 1",
    "name": 'name = "mine"',
    "seed": "seed = 1",
    "languages": 'languages = ["en"]',
    "groups": 'a table [[groups]] with name = "all" and observers = 12',
    "blocks": 'a table [[blocks]] with task = "choice"',
    "observers": "observers = 12",
    "choices": 'choices = ["female", "male"]',
    "trait": 'trait = "sex"',
    "number": "number = 4",
    "condition": "the name of a condition",
    "right": 'right = ["male"]',
}
_BOUNDS = {
    "greater_than_equal": ("ge", "{} or more"),
    "greater_than": ("gt", "more than {}"),
    "less_than_equal": ("le", "{} or less"),
    "less_than": ("lt", "less than {}"),
    "too_short": ("min_length", "a list of {} or more entries"),
    "too_long": ("max_length", "a list of no more than {} entries"),
    "string_too_short": ("min_length", "a text of {} letters or more"),
    "string_too_long": ("max_length", "a text of {} letters or fewer"),
}
_KINDS = {
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "finite_number": "a number, and neither infinite nor nan",
    "bool_type": "true or false",
    "string_type": 'a text in quotes, as "text"',
    "list_type": "a list in brackets",
    "dict_type": "a table, as { name = 1 }",
    "model_attributes_type": "a table",
    "model_type": "a table",
    "string_pattern_mismatch": "a name of letters, digits, - and _ that begins with a letter",
}
_PATTERNS = {
    "languages": "a code of two or three letters, as en",
    "return_url": "an address that begins with https://",
}


def _expected(error: Any, key: str) -> str:
    """Return what a value must be, in the words of a design file."""
    kind, context = error["type"], error.get("ctx", {})
    if kind in _BOUNDS:
        name, words = _BOUNDS[kind]
        return "must be " + words.format(context[name])
    if kind == "literal_error":
        return f"must be {context['expected']}"
    if kind == "string_pattern_mismatch":
        where = next((str(part) for part in error["loc"] if str(part) in _PATTERNS), None)
        return f"must be {_PATTERNS[where] if where else _KINDS[kind]}"
    if kind in ("list_type", "model_type", "model_attributes_type") and key in Design.model_fields:
        brackets = "[[{}]]" if kind == "list_type" and key != "languages" else "[{}]"
        how = brackets.format(key)
        return 'must be a list, as ["en"]' if key == "languages" else f"must be written as {how}"
    if kind in _KINDS:
        return f"must be {_KINDS[kind]}"
    return str(error["msg"]).removeprefix("Value error, ").removeprefix("Input ")


_TABLES = ("groups", "blocks", "conditions", "questions", "catch")


def name_of(where: Sequence[str | int]) -> str:
    """Return where something is, in words: the key, of which table.

    Examples
    --------
    >>> name_of(["blocks", 0, "trials"])
    'trials of [[blocks]] 1'
    """
    words: list[str] = []
    for part, following in zip(where, [*where[1:], None], strict=True):
        if isinstance(part, int):
            continue
        if isinstance(following, int):
            table = part in _TABLES and where.index(part) in (0, 2)
            number = following + 1
            words.append(f"[[{part}]] {number}" if table else f"entry {number} of {part}")
        else:
            words.append(part if following is None else f"[{part}]")
    return " of ".join(reversed(words)) or "the design"


def tasks() -> dict[str, type[BaseModel]]:
    """Return the models of blocks by their tasks."""
    members = get_args(get_args(AnyBlock)[0])
    return {get_args(each.model_fields["task"].annotation)[0]: each for each in members}


def _known_words(where: Sequence[str | int]) -> list[str]:
    model: Any = Design
    for part in where[:-1]:
        if isinstance(part, int):
            continue
        if part in tasks():
            model = tasks()[str(part)]
        elif part in model.model_fields:
            kind = model.model_fields[part].annotation
            model = next((each for each in (kind, *get_args(kind)) if _is_model(each)), model)
    return [*model.model_fields]


def _is_model(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, BaseModel)


def _conflicts(design: Design) -> list[tuple[tuple[str | int, ...], str]]:
    """Return what is wrong between parts that are right each by itself."""
    return [
        *_same_names(design),
        *_conflicts_of_conditions(design),
        *_conflicts_of_views(design),
        *(
            ((*("blocks", number), *where), problem)
            for number, block in enumerate(design.blocks)
            for where, problem in _conflicts_of_block(design, block)
        ),
    ]


Conflict = tuple[tuple[str | int, ...], str]


def _same_names(design: Design) -> Iterator[Conflict]:
    for table in ("groups", "questions", "conditions"):
        names = [each.name for each in getattr(design, table)]
        for number, name in enumerate(names):
            if name in names[:number]:
                where = (table, number, "name")
                yield where, f"two {table} are called {name!r}; rename one"
    if len(set(design.languages)) < len(design.languages):
        yield ("languages",), "a language is there twice; name each once"


def _conflicts_of_conditions(design: Design) -> Iterator[Conflict]:
    for number, condition in enumerate(design.conditions):
        where = ("conditions", number)
        if condition.name in ("full", "structure", "dynamics"):
            yield (*where, "name"), f"a condition cannot be called {condition.name!r}; rename it"
        if condition.alpha and condition.trait is None:
            yield (*where, "alpha"), 'alpha needs a trait to move along; add trait = "sex"'
        if condition.toward is not None and condition.trait is None:
            yield (*where, "toward"), 'toward needs a trait to move along; add trait = "sex"'


def _conflicts_of_views(design: Design) -> Iterator[Conflict]:
    views = design.sessions.views_deg
    where = ("sessions", "views_deg")
    if len(set(views)) < len(views):
        yield where, "a view is there twice; name each once"
    if views and any(group.view_deg is not None for group in design.groups):
        yield where, "groups and sessions both have views; keep one"
    if views and design.picture.both_signs and any(-view in views for view in views if view):
        yield where, "both_signs shows both sides already; keep one sign of each view"


def _conflicts_of_block(design: Design, block: AnyBlock) -> Iterator[Conflict]:
    known = [each.name for each in design.conditions]
    named = [("conditions", name) for name in getattr(block, "conditions", [])]
    named += [("catch", each.condition) for each in getattr(block, "catch", [])]
    for word, name in named:
        if name not in known:
            problem = f"there is no condition {name!r}; known are {', '.join(known) or 'none'}"
            yield (word,), problem
    for word in ("conditions", "information", "mask_dots"):
        values = getattr(block, word, [])
        if len(set(values)) < len(values):
            yield (word,), f"{word} has an entry twice; name each once"
    if "conditions" in block.model_fields_set and "information" in block.model_fields_set:
        yield ("information",), "conditions replace the information; keep one of the two"
    if len(set(getattr(block, "choices", ("one", "other")))) < 2:
        yield ("choices",), "the two choices are the same; rename one"
    match block:
        case Rating():
            yield from _conflicts_of_rating(design, block)
        case Choice():
            yield from _wrong_catches(block, block.choices)
        case Detection():
            yield from _conflicts_of_detection(block)
        case Adjustment() if block.lowest >= block.highest:
            yield ("lowest",), f"lowest is {block.lowest:g}; write less than {block.highest:g}"
        case SameOrDifferent() | OddOneOut():
            yield from _conflicts_of_figures(block)
    if block.feedback and not can_be_right(block):
        yield ("feedback",), f"no answer of {block.task} is right or wrong; take feedback out"


def can_be_right(block: AnyBlock) -> bool:
    """Return whether a block may have right answers."""
    if isinstance(block, OddOneOut):
        return not block.all_differ
    return isinstance(block, Choice | Detection | SameOrDifferent)


def _conflicts_of_rating(design: Design, block: Rating) -> Iterator[Conflict]:
    if block.scale is None:
        lacking = [group.name for group in design.groups if group.scale is None]
        if lacking:
            yield (), f"there is no scale for {', '.join(map(repr, lacking))}; add one to the group"
    yield from _wrong_catches(block, [str(step + 1) for step in range(block.steps)])


def _wrong_catches(block: Choice | Rating, answers: Sequence[str]) -> Iterator[Conflict]:
    for number, catch in enumerate(block.catch):
        for right in catch.right:
            if right not in answers:
                problem = f"{right!r} is no answer of this block; choose from {', '.join(answers)}"
                yield ("catch", number, "right"), problem


def _conflicts_of_detection(block: Detection) -> Iterator[Conflict]:
    if block.start >= len(block.mask_dots):
        problem = f"start is {block.start}, but levels go from 0 to {len(block.mask_dots) - 1}"
        yield ("start",), problem
    if block.mask_dots != sorted(block.mask_dots):
        yield ("mask_dots",), "mask_dots must go from the easiest level, the fewest dots, upwards"
    if block.trials % 2:
        yield ("trials",), _even(block.trials, "with a walker")


def _conflicts_of_figures(block: SameOrDifferent | OddOneOut) -> Iterator[Conflict]:
    n_conditions = len(block.conditions or block.information)
    if isinstance(block, SameOrDifferent) and block.trials % 2:
        yield ("trials",), _even(block.trials, "the same")
    if isinstance(block, OddOneOut) and not block.all_differ and block.trials % block.figures:
        problem = (
            f"trials is {block.trials}, so that the odd one is not as often in each place; "
            f"write a multiple of {block.figures}"
        )
        yield ("trials",), problem
    if block.differ == "conditions" and n_conditions < 2:
        yield ("differ",), "conditions that differ are two or more; name them as conditions"
    if isinstance(block, OddOneOut) and block.all_differ and block.differ == "conditions":
        yield ("all_differ",), 'all people differ, so write differ = "walkers"'


def _even(trials: int, what: str) -> str:
    return f"trials is {trials}, so that no half of them is {what}; write an even number"
