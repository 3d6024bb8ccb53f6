"""One row for each time a trial was shown, from what pages reported."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from eigenwalker.experiment.design import Design

Row = dict[str, Any]
TIMING = (
    "first_frame_ms",
    "frames_shown",
    "frames_planned",
    "frames_dropped",
    "frame_interval_ms",
    "frame_interval_min_ms",
    "frame_interval_max_ms",
    "shown_ms",
    "page_hidden",
    "focus_lost",
)
"""What pages measure in each trial, as they report it."""


def session_rows(
    session: Mapping[str, Any],
    answers: Sequence[Row],
    design: Design,
    names: Sequence[str],
) -> Iterator[Row]:
    """Yield the rows of a session, trial by trial, in the order in which they were begun."""
    shared = {
        "observer": session["observer"],
        "session": session["number"],
        "group": session["group"],
        "test": int(session["observer_kind"] == "test"),
        "simulated": int(session["observer_kind"] == "simulated"),
        "session_outcome": session["outcome"] or "left",
    }
    trials = {trial["trial"]: trial for trial in json.loads(session["trials"])}
    for number, shown in sorted(_showings(answers).items()):
        trial = trials[number]
        unanswered = 0
        for number_shown, (begun, answer) in enumerate(shown, 1):
            row = _row(trial, begun, answer, design, names)
            row |= shared
            row["attempt"], row["repeated"] = number_shown, int(unanswered > 0)
            yield row
            unanswered += row["outcome"] == "none"


def _showings(answers: Sequence[Row]) -> dict[int, list[tuple[Row | None, Row | None]]]:
    """Return for each trial its showings: what was reported at the beginning and at the end.

    Two machines may have shown a trial under one number of attempt; both are kept.
    """
    found: dict[int, dict[tuple[int, int], list[Row | None]]] = {}
    for kind, place in (("begun", 0), ("answer", 1)):
        seen: dict[tuple[int, int], int] = {}
        for item in answers:
            if item["kind"] != kind or item["trial"] is None:
                continue
            key = (item["trial"], item["attempt"] or 1)
            seen[key] = seen.get(key, 0) + 1
            slots = found.setdefault(item["trial"], {})
            slots.setdefault((key[1], seen[key]), [None, None])[place] = item
    return {
        trial: sorted(((pair[0], pair[1]) for pair in slots.values()), key=_started)
        for trial, slots in found.items()
    }


def _started(pair: tuple[Row | None, Row | None]) -> tuple[int, str, str]:
    """Order by the page's own count; its clock, which may be set back, only between machines."""
    item = pair[0] or pair[1] or {}
    return item["attempt"] or 1, item["content"].get("time_utc", ""), item["answer"]


def _row(
    trial: Row, begun: Row | None, answer: Row | None, design: Design, names: Sequence[str]
) -> Row:
    content = answer["content"] if answer else {}
    interrupted = answer is None
    started = content.get("started_utc") or (begun or {"content": {}})["content"].get("time_utc")
    response = content.get("response")
    row = {
        "block": trial["block"],
        "trial": trial["trial"],
        "stimulus": content.get("stimulus") or _stimuli(trial),
        "view_deg": trial["view_deg"],
        "information": trial["information"],
        "condition": trial["condition"],
        "level": content.get("level", trial.get("level")),
        "walker": _walker(trial, names),
        "response": " ".join(map(str, response)) if isinstance(response, list) else response,
        "response_by": content.get("response_by"),
        "response_device": content.get("response_device"),
        "rt_ms": content.get("rt_ms"),
        "outcome": "interrupted" if interrupted else content.get("outcome"),
        "interrupted": int(interrupted),
        "practice": int(trial["practice"]),
        "flag": None if interrupted else _flags(content, design),
        **{name: content.get(name) for name in TIMING},
        "started_utc": started,
        "answer": answer["answer"] if answer else None,
    }
    row["catch"] = int(trial.get("catch", False))
    if "correct" in trial:
        right = _texts(trial["correct"])
        row["right_answer"] = " ".join(right)
        if response is not None:
            row["correct"] = int(str(response) in right)
    if trial["task"] == "rating":
        row["rating"] = response
    elif trial["task"] == "adjustment":
        row["setting"] = response if _is_number(response) else None
        row["setting_start"] = trial["levels"][trial["begins"]]
    elif len(trial["walkers"]) > 1:
        shown = [names[walker] for walker in trial["walkers"]]
        row |= dict(zip("abcd", shown, strict=False))
        chosen = [shown[place] for place in _places(response, len(shown))]
        columns = ("chosen_1", "chosen_2") if trial["task"] == "similar_pair" else ("odd",)
        row |= dict(zip(columns, chosen, strict=False))
    return row


def _stimuli(trial: Row) -> str:
    """Return the names of what a trial shows; of many levels one is shown, which is unknown."""
    return "" if "levels" in trial else " ".join(trial["stimuli"])


def _walker(trial: Row, names: Sequence[str]) -> str | None:
    """Return the one walker that a trial shows."""
    if not trial["walkers"]:
        return "average"
    return str(names[trial["walkers"][0]]) if len(trial["walkers"]) == 1 else None


def _texts(right: Any) -> list[str]:
    return [str(each) for each in (right if isinstance(right, list) else [right])]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _places(response: Any, number: int) -> list[int]:
    """Return the places that were chosen: one, or two of a pair."""
    given = [response] if _is_number(response) else response
    known = isinstance(given, list) and len(given) <= 2
    return [place for place in given if type(place) is int and 0 <= place < number] if known else []


def _flags(content: Row, design: Design) -> str:
    names = {"page_hidden": "hidden", "focus_lost": "unfocused", "resized": "resized"}
    flags = [flag for name, flag in names.items() if content.get(name)]
    dropped, shown = content.get("frames_dropped") or 0, content.get("frames_shown") or 0
    if shown and dropped / (shown + dropped) > design.screen.flag_dropped_share:
        flags.append("dropped_frames")
    return " ".join(flags) or "none"
