"""How far an experiment is: groups, sessions, answers, and what is wrong."""

from __future__ import annotations

from collections import Counter
from contextlib import closing
from pathlib import Path
from typing import Any

from eigenwalker.experiment import store
from eigenwalker.experiment.experiment_folder import ANSWERS, Material


def experiment_status(folder: Path, *, check: bool = True) -> dict[str, Any]:
    """Return the progress of an experiment in numbers; reads only, and checks the file first."""
    design = Material(folder).design
    with closing(store.read_only(folder / ANSWERS, check=check)) as database:
        counts = store.counts(database)
        sessions = list(store.sessions(database))
        active = store.active_places(database, *design.places_held)
        quality = {
            "dropped_frames": store.n_dropping(database, design.screen.flag_dropped_share),
            "not_stored": store.n_not_stored(database),
        }
        frozen = [row["version"] for row in store.versions(database) if row["frozen_utc"]]
    outcomes = Counter(
        (row["group"], row["outcome"] or "left or under way")
        for row in sessions
        if row["observer_kind"] == "real"
    )
    return {
        "name": design.name,
        "versions": frozen,
        "groups": {
            group.name: {
                "wanted": group.observers,
                "finished_or_under_way": sum(row["group"] == group.name for row in active),
                "sessions": {
                    outcome: number
                    for (name, outcome), number in sorted(outcomes.items())
                    if name == group.name
                },
            }
            for group in design.groups
        },
        "tests": sum(row["observer_kind"] == "test" for row in sessions),
        "simulated": sum(row["observer_kind"] == "simulated" for row in sessions),
        **counts,
        **quality,
    }


def status_lines(status: dict[str, Any]) -> str:
    """Return the progress as a person reads it."""
    lines = [f"{status['name']}: {status['answers']} items kept, {status['refused']} refused"]
    for name, group in status["groups"].items():
        sessions = ", ".join(f"{n} {what}" for what, n in group["sessions"].items()) or "none"
        lines.append(
            f"  {name}: {group['finished_or_under_way']} of {group['wanted']} observers; "
            f"sessions: {sessions}"
        )
    lines.append(
        f"  {status['tests']} test sessions, {status['simulated']} simulated, "
        f"{status['withdrawn']} withdrawn"
    )
    return "\n".join(lines)
