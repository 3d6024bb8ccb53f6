"""What the server lets a child process do: one task on one folder (see `io.sandbox`).

Captures and populations come from anywhere, and films take long; here they may crash, hang or ask
for all the memory there is. The folder holds the settings of the task, ``task.json``, and the files
that were sent, ``sent``.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

from eigenwalker.explorer.field_names import in_fields

SETTINGS = "task.json"
PEOPLE = "people.nc"
"""Where a task leaves the population that its model is of."""

Answer = dict[str, Any]


def files_of(folder: str | Path) -> Path:
    """Return the folder in a task's folder for the files that were sent; made if need be."""
    files = Path(folder, "sent")
    files.mkdir(exist_ok=True)
    return files


def _task(function: Callable[[Path, Answer], Answer]) -> Callable[[str], bytes]:
    """Return a function of a folder and its settings as one of the folder, with JSON as result."""

    @wraps(function)
    def task(folder: str) -> bytes:
        settings = json.loads(Path(folder, SETTINGS).read_text(encoding="utf-8"))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                answer = function(Path(folder), settings)
            except ValueError as error:
                raise ValueError(_without_folder(in_fields(str(error)), folder)) from error
        if "messages" in answer:
            answer["messages"] = [
                _without_folder(in_fields(each), folder) for each in answer["messages"]
            ]
        return json.dumps(answer, allow_nan=False).encode()

    return task


def _without_folder(sentence: str, folder: str) -> str:
    """Return a sentence that names files as they were sent, without the folder of the task."""
    sent = str(Path(folder, "sent"))
    return sentence.replace(f" in {sent}", " among these files").replace(f"{sent}/", "")


@_task
def capture(folder: Path, settings: Answer) -> Answer:
    """Return a capture as a point of a population's space."""
    from eigenwalker.gait.appearance import walker_measures
    from eigenwalker.io.read import is_capture
    from eigenwalker.population.population import Population
    from eigenwalker.study.messages import capture_lines, flag_of
    from eigenwalker.study.predict_captures import prediction_lines
    from eigenwalker.study.process_capture import process_capture

    files = [files_of(folder) / name for name in settings["files"]]
    captures = [path for path in files if is_capture(path)] or files[:1]
    if len(captures) > 1:
        named = ", ".join(path.name for path in captures[:3])
        raise ValueError(f"{len(captures)} captures came ({named}); one at a time is compared.")
    people = Population.load(Path(settings["population"]))
    first = people.walkers[0]
    result = process_capture(
        captures[0],
        form=first.form,
        n_harmonics=max(len(first.harmonics) // 2, 1),
        unit=settings["unit"],
        rate_hz=settings["rate_hz"],
        mapping=_mapping(files_of(folder), settings),
    )
    vector = people.vector(result.walker)
    made = people.walker(vector)
    return {
        "name": captures[0].name,
        "vector": vector.tolist(),
        "verdict": result.quality.verdict,
        "flag": flag_of(result.quality),
        "messages": [*capture_lines(result), *prediction_lines(people, vector)],
        "measures": {
            str(name): None if math.isnan(value) else value
            for name, value in walker_measures(made).items()
        },
    }


@_task
def population(folder: Path, settings: Answer) -> Answer:
    """Return the model of a population's file."""
    from eigenwalker.population.population import Population

    path = files_of(folder) / settings["files"][0]
    return {"model": _model(Population.load(path), folder, path.stem), "messages": []}


@_task
def study(folder: Path, settings: Answer) -> Answer:
    """Return the model of a population made of captures, and why some are not in it."""
    from eigenwalker.study.fit_folder import fit_folder

    captures = files_of(folder)
    fitted = fit_folder(
        captures,
        traits=_traits_table(captures),
        unit=settings["unit"],
        rate_hz=settings["rate_hz"],
        mapping=_mapping(captures, settings),
        n_jobs=1,
    )
    not_used = fitted.files[fitted.files["status"] != "used"]
    messages = [
        f"{row.file}: {row.status}. {in_fields(str(row.reason).removeprefix(f'{row.file}: '))}"
        for row in not_used.itertuples()
    ]
    messages += [f"{name}: not in the table of traits." for name in fitted.unlisted[:20]]
    if fitted.population is None:
        raise ValueError(
            f"None of {len(fitted.files)} captures could be used. {' '.join(messages[:5])}"
        )
    messages.append(
        "This population is kept until the server ends; for Python, write it to a file first: "
        f"eigenwalker fit FOLDER -o {PEOPLE}"
    )
    used = [str(name) for name in fitted.population.traits["file"]]
    return {"model": _model(fitted.population, folder, _title(used)), "messages": messages}


def _title(files: list[str]) -> str:
    """Return a title for a population made of captures."""
    first, rest = files[:2], len(files) - 2
    if rest > 0:
        return f"Captures {', '.join(first)} and {rest} more"
    return f"{'Captures' if rest == 0 else 'Capture'} {' and '.join(first)}"


def _mapping(captures: Path, settings: Answer) -> Any:
    """Return the mapping that came beside captures, else the one that was given to the server."""
    from eigenwalker.markers.mapping import is_mapping

    sent = [path for path in sorted(captures.glob("**/*.toml")) if is_mapping(path)]
    sent = sent or [path for path in captures.glob("*.toml") if not _describes(path)]
    if len(sent) > 1:
        raise ValueError(f"{len(sent)} mappings of markers came; one is enough.")
    return sent[0] if sent else settings.get("mapping")


def _describes(path: Path) -> bool:
    """Return whether a TOML file describes the table of the same name."""
    return any(each.suffix != path.suffix for each in path.parent.glob(f"{path.stem}.*"))


def _traits_table(captures: Path) -> Path | None:
    from eigenwalker.io.read import is_capture

    sheets = [*captures.glob("*.csv"), *captures.glob("*.xlsx")]
    tables = [path for path in sorted(sheets) if not is_capture(path)]
    if len(tables) > 1:
        raise ValueError(f"{len(tables)} tables of traits came; one is enough.")
    return tables[0] if tables else None


def _model(people: Any, folder: Path, title: str) -> Answer:
    from eigenwalker.explorer.model import page_models

    people.save(folder / PEOPLE)
    return page_models(people, title=title, source=PEOPLE)


@_task
def film(folder: Path, settings: Answer) -> Answer:
    """Make a film of a stimulus, and return the name of its file."""
    from eigenwalker.stimulus.stimulus import Stimulus
    from eigenwalker.stimulus.write_stimulus import write_stimulus

    stimulus = Stimulus.load(files_of(folder) / "stimulus.json")
    display = stimulus.display
    pixels = f"{display.width_px} x {display.height_px} pixels"
    _check_length(stimulus, display.width_px * display.height_px, pixels, settings["max_pixels"])
    dots = stimulus.file.dots_computed
    _check_length(stimulus, dots, f"{dots} dots to compute", settings["max_dots"])
    path = write_stimulus(stimulus, folder / f"film.{settings['format']}")
    return {"file": path.name}


def _check_length(stimulus: Any, each: int, content: str, limit: float) -> None:
    """Refuse films of more than so much in all their frames, before any is drawn."""
    seconds, rate_hz = stimulus.timing.duration_s, stimulus.timing.rate_hz
    if each * seconds * rate_hz > limit:
        raise ValueError(
            f"A film of {seconds:g} s with {content} at {rate_hz:g} Hz is too long here; up to "
            f"{limit / (each * rate_hz):.2g} s are made. Longer ones are made of a saved stimulus "
            "by eigenwalker stimulus."
        )
