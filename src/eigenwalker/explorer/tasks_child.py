"""What the server has done in a process of its own: one task on one folder, within limits.

Captures and populations come from anywhere, and films take long. Here they may crash, hang or ask
for all the memory there is; the server goes on. Run by its path with the task's name, a folder, and
limits in seconds and bytes. ``task.json`` in the folder says what to do; the answer, or with the
status `REFUSED` the sentence that says why there is none, is written into ``answer.json``.
"""

from __future__ import annotations

import json
import math
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

REFUSED = 3
TOO_LARGE = 4
ANSWER = "answer.json"
ASKED = "task.json"
PEOPLE = "people.nc"
"""Where a task leaves the population that its model is of."""

Asked = dict[str, Any]


def main(task: str, folder: str, seconds: int, most_bytes: int) -> int:
    """Return the exit status after one task."""
    from eigenwalker.io.sandbox_child import limit_process

    place = Path(folder)
    asked = json.loads((place / ASKED).read_text(encoding="utf-8"))
    try:
        limit_process(seconds, most_bytes)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            answer = TASKS[task](place, asked)
    except MemoryError:
        return TOO_LARGE
    except ValueError as error:
        (place / ANSWER).write_text(json.dumps(str(error)), encoding="utf-8")
        return REFUSED
    (place / ANSWER).write_text(json.dumps(answer, allow_nan=False), encoding="utf-8")
    return 0


def sent_to(folder: Path) -> Path:
    """Return the folder in a task's folder that holds what was sent, made where it is not there."""
    sent = folder / "sent"
    sent.mkdir(exist_ok=True)
    return sent


def capture(folder: Path, asked: Asked) -> Asked:
    """A capture as a point of a population's space."""
    from eigenwalker.gait.appearance import walker_measures
    from eigenwalker.io.read import is_capture
    from eigenwalker.population.population import FLAG, Population
    from eigenwalker.study.walker_from_file import walker_from_file

    files = [sent_to(folder) / name for name in asked["files"]]
    captures = [path for path in files if is_capture(path)] or files[:1]
    if len(captures) > 1:
        named = ", ".join(path.name for path in captures[:3])
        raise ValueError(f"{len(captures)} captures came ({named}); one at a time is compared.")
    people = Population.load(Path(asked["population"]))
    first = people.walkers[0]
    walker, facts = walker_from_file(
        captures[0],
        form=first.form,
        n_harmonics=max(len(first.harmonics) // 2, 1),
        unit=asked["unit"],
        rate_hz=asked["rate_hz"],
    )
    vector = people.vector(walker)
    made = people.walker(vector)
    return {
        "name": captures[0].name,
        "vector": vector.tolist(),
        "verdict": facts["verdict"],
        "flag": facts[FLAG],
        "messages": _messages(facts),
        "measures": {
            str(name): None if math.isnan(value) else value
            for name, value in walker_measures(made).items()
        },
    }


def _messages(facts: dict) -> list[str]:
    """What is to be known of a capture, in sentences."""
    strides, seconds = round(facts["strides"]), facts["duration_s"]
    messages = [
        f"{strides} strides in {seconds:.0f} s at {facts['frequency_hz']:.2f} Hz; the sines of "
        f"this walker hold {100 * facts['r2']:.0f} % of its movement."
    ]
    if facts["flag"]:
        messages.append(str(facts["flag"]))
    if facts["rebuilt"]:
        messages.append(f"Rebuilt: {facts['rebuilt']}.")
    if facts["unit_guessed"]:
        messages.append(f"The file names no unit; {facts['unit']} was guessed from the height.")
    return messages


def population(folder: Path, asked: Asked) -> Asked:
    """The model of a population's file."""
    from eigenwalker.population.population import Population

    path = sent_to(folder) / asked["files"][0]
    return {"model": _model(Population.load(path), folder, path.stem), "messages": []}


def study(folder: Path, asked: Asked) -> Asked:
    """A population made of captures, and what became of each that is not in it."""
    from eigenwalker.study.fit_folder import fit_folder

    captures = sent_to(folder)
    found = fit_folder(captures, traits=_traits_table(captures), n_jobs=1)
    out = found.files[found.files["status"] != "used"]
    messages = [f"{row.file}: {row.status}. {row.reason}" for row in out.itertuples()]
    messages += [f"{name}: not in the table of traits." for name in found.unlisted[:20]]
    if found.population is None:
        raise ValueError(
            f"None of {len(found.files)} captures could be used. {' '.join(messages[:5])}"
        )
    messages.append(
        "This population is kept until the server ends; for Python, write it to a file first: "
        f"eigenwalker fit FOLDER -o {PEOPLE}"
    )
    used = [str(name) for name in found.population.traits["file"]]
    return {"model": _model(found.population, folder, _named(used)), "messages": messages}


def _named(files: list[str]) -> str:
    """What a population is called that was made of captures.

    Examples
    --------
    >>> _named(["ada.c3d", "ben.c3d"]), _named([f"{number}.c3d" for number in range(9)])
    ('Captures ada.c3d and ben.c3d', 'Captures 0.c3d, 1.c3d and 7 more')

    """
    first, rest = files[:2], len(files) - 2
    if rest > 0:
        return f"Captures {', '.join(first)} and {rest} more"
    return f"{'Captures' if rest == 0 else 'Capture'} {' and '.join(first)}"


def _traits_table(captures: Path) -> Path | None:
    from eigenwalker.io.read import is_capture

    tables = [path for path in sorted(captures.glob("*.csv")) if not is_capture(path)]
    if len(tables) > 1:
        raise ValueError(f"{len(tables)} tables of traits came; one is enough.")
    return tables[0] if tables else None


def _model(people: Any, folder: Path, title: str) -> Asked:
    from eigenwalker.explorer.model import page_model

    people.save(folder / PEOPLE)
    return page_model(people, title=title, source=PEOPLE)


def film(folder: Path, asked: Asked) -> Asked:
    """A film of a stimulus."""
    from eigenwalker.stimulus.stimulus import Stimulus
    from eigenwalker.stimulus.write_stimulus import write_stimulus

    shown = Stimulus.load(sent_to(folder) / asked["files"][0])
    display = shown.display
    pixels = f"{display.width_px} x {display.height_px} pixels"
    _check_length(shown, display.width_px * display.height_px, pixels, asked["most_pixels"])
    dots = shown.file.dots_computed
    _check_length(shown, dots, f"{dots} dots to compute", asked["most_dots"])
    path = write_stimulus(shown, folder / f"film.{asked['format']}")
    return {"file": path.name}


def _check_length(shown: Any, each: int, of_what: str, most: float) -> None:
    """Refuse films of more than so much in all their frames, before any is drawn."""
    seconds, rate_hz = shown.timing.duration_s, shown.timing.rate_hz
    if each * seconds * rate_hz > most:
        raise ValueError(
            f"A film of {seconds:g} s with {of_what} at {rate_hz:g} Hz is too long here; up to "
            f"{most / (each * rate_hz):.2g} s are made. Longer ones are written by write_stimulus "
            "in Python."
        )


TASKS: dict[str, Callable[[Path, Asked], Asked]] = {
    "capture": capture,
    "population": population,
    "study": study,
    "film": film,
}

if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])))
