"""Reading a design: all that is wrong with it at once, each with its line and what to do."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from eigenwalker.experiment.design import AnyBlock, Design, Detection, Rating

MAX_BYTES = 1_000_000
_HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\s-]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"^\s*([A-Za-z0-9_-]+)\s*=")
_LINE = re.compile(r"\(at line (\d+)")


@dataclass(frozen=True)
class Fault:
    """What is wrong in a design, where, and what to do."""

    line: int
    problem: str

    def __str__(self) -> str:
        return f"line {self.line}: {self.problem}"


class BadDesign(ValueError):  # noqa: N818 - the name says what it is
    """A design with faults; the message has all of them, one a line."""

    def __init__(self, source: str, faults: Sequence[Fault]) -> None:
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
    path = Path(path)
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise ValueError(f"{path.name} has more than {MAX_BYTES} bytes, which no design needs.")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path.name} is not in UTF-8; save it as UTF-8.") from None
    return parse_design(text, path.name)


def parse_design(text: str, source: str = "design.toml") -> Design:
    """Return the design that a text of TOML describes."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _LINE.search(str(error))
        line = int(found[1]) if found else text.count("\n") + 1
        why = str(error).partition(" (at")[0]
        raise BadDesign(source, [Fault(line, f"this is no TOML: {why}")]) from None
    except RecursionError:
        raise BadDesign(source, [Fault(1, "this is nested too deeply")]) from None
    lines = lines_of(text)
    try:
        design = Design.model_validate(content)
    except ValidationError as error:
        faults = [_fault(each, lines) for each in error.errors()]
        raise BadDesign(source, faults) from None
    if faults := [Fault(_line(where, lines), problem) for where, problem in _conflicts(design)]:
        raise BadDesign(source, faults)
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
    count: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if header := _HEADER.match(line):
            table = tuple(part.strip() for part in header[2].split("."))
            if header[1] == "[[":
                name = header[2].strip()
                count[name] = count.get(name, -1) + 1
                table = (*table, count[name])
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


def _fault(error: Any, lines: dict[tuple[str | int, ...], int]) -> Fault:
    """Return an error of pydantic as a fault: where, what is expected, what to do."""
    where = [*error["loc"]]
    if len(where) > 2 and where[0] == "blocks":
        del where[2]  # the task, by which pydantic names the member of the union
    name = ".".join(str(part) for part in where) or "the design"
    match error["type"]:
        case "extra_forbidden":
            known = _known_words(error["loc"])
            near = get_close_matches(str(where[-1]), known, n=1)
            remedy = f"write {near[0]!r}" if near else f"known here are {', '.join(known)}"
            problem = f"{name} is an unknown word; {remedy}"
        case "missing":
            problem = f"{name} is missing; add it"
        case "union_tag_not_found":
            problem = f"{name} lacks its task; add task = {' or '.join(map(repr, tasks()))}"
        case "union_tag_invalid":
            given = error["input"].get("task")
            problem = f"{name}: the task {given!r} is unknown; choose from {', '.join(tasks())}"
        case _:
            expected = error["msg"].removeprefix("Value error, ").removeprefix("Input ")
            given = error["input"]
            shown = f", not {given!r}" if isinstance(given, int | float | str) else ""
            problem = f"{name} {expected}{shown}"
    return Fault(_line(where, lines), problem)


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
    wrong: list[tuple[tuple[str | int, ...], str]] = []
    names = [group.name for group in design.groups]
    for number, name in enumerate(names):
        if name in names[:number]:
            wrong.append(
                (("groups", number, "name"), f"two groups are called {name!r}; rename one")
            )
    for number, block in enumerate(design.blocks):
        if isinstance(block, Rating) and block.scale is None:
            wrong += [
                (("groups", place), f"the group {group.name!r} lacks the scale to rate on; add one")
                for place, group in enumerate(design.groups)
                if group.scale is None
            ]
        if getattr(block, "choices", None) and len(set(block.choices)) < 2:  # type: ignore[attr-defined]
            wrong.append((("blocks", number, "choices"), "the two choices are the same"))
    known = [each.name for each in design.conditions]
    for number, name in enumerate(known):
        if name in known[:number] or name in ("full", "structure", "dynamics"):
            where = ("conditions", number, "name")
            wrong.append((where, f"a condition cannot be called {name!r}, which is in use"))
    for number, block in enumerate(design.blocks):
        for name in getattr(block, "conditions", []):
            if name not in known:
                problem = f"there is no condition {name!r}; known are {', '.join(known) or 'none'}"
                wrong.append((("blocks", number, "conditions"), problem))
    for number, block in enumerate(design.blocks):
        if isinstance(block, Detection) and block.start >= len(block.mask_dots):
            problem = f"start is {block.start}, but levels go from 0 to {len(block.mask_dots) - 1}"
            wrong.append((("blocks", number, "start"), problem))
    views = design.sessions.views_deg
    if len(set(views)) < len(views):
        wrong.append((("sessions", "views_deg"), "a view is there twice; name each once"))
    if views and any(group.view_deg is not None for group in design.groups):
        wrong.append((("sessions", "views_deg"), "groups and sessions both have views; keep one"))
    return wrong
