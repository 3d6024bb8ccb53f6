"""Answers that an observer handed over as a file, taken one by one."""

from __future__ import annotations

import json
import re
import sqlite3
from pathlib import Path
from typing import Any

from eigenwalker.experiment import store

FORMAT = "eigenwalker rescue"
MAX_BYTES = 50_000_000
_NAME = re.compile(r"[A-Za-z0-9_-]{16,64}")
_KINDS = ("begun", "answer", "event", "screen", "questions")


def read_rescue_file(path: Path) -> dict[str, Any]:
    """Return the content of a rescue file, checked as far as that goes without the database."""
    if path.stat().st_size > MAX_BYTES:
        raise ValueError(
            f"{path.name} is larger than {MAX_BYTES // 10**6} MB; no page writes that."
        )
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        good = content["format"] == FORMAT and isinstance(content["items"], list)
        good &= isinstance(content["session"], int) and isinstance(content["proof"], str)
    except (ValueError, KeyError, TypeError, RecursionError):
        good, content = False, {}
    if not good:
        raise ValueError(f"{path.name} is no file of answers that the page of an experiment saved.")
    return content


def take_items(db: sqlite3.Connection, content: dict[str, Any]) -> list[str]:
    """Keep the answers of a file, and say of each what became of it."""
    session, proof = content["session"], content["proof"]
    if not store.session_by_proof(db, session, proof):
        raise ValueError("The file is of another experiment, or its observer withdrew.")
    lines: list[str] = []
    for number, saved in enumerate(content["items"], 1):
        item = _item(saved, proof)
        if item is None:
            lines.append(f"{number}. edited or damaged; not taken")
            continue
        before = store.n_confirmed(db, session)
        found = store.add_answers(db, session, [item], "rescue")[0]
        new = store.n_confirmed(db, session) > before
        outcome = "taken" if new else "given already"
        if found.outcome != "confirmed":
            outcome = f"{found.outcome}; kept apart for the lab"
        trial = "" if item["trial"] is None else f" of trial {item['trial']}"
        lines.append(f"{number}. {item['kind']}{trial}: {outcome}")
    return lines


def checksum(text: str) -> str:
    """Return what shows that a text was edited: FNV-1a of 64 bits, as the page computes it.

    Examples
    --------
    >>> checksum("a")
    'af63dc4c8601ec8c'
    """
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return f"{value:016x}"


def _item(saved: Any, proof: str) -> dict[str, Any] | None:
    """Return an item as the page made it; none where it was edited."""
    try:
        if checksum(proof + saved["text"]) != saved["check"]:
            return None
        item = json.loads(saved["text"])
        numbers = (item["trial"], item["attempt"])
        sound = (
            _NAME.fullmatch(item["answer"])
            and item["kind"] in _KINDS
            and all(each is None or type(each) is int for each in numbers)
            and isinstance(item["content"], dict)
        )
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return item if sound else None
