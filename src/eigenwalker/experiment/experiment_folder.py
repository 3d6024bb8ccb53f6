"""The folder of an experiment: its design, texts, stimuli, versions and answers."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenwalker.experiment.design import Design
from eigenwalker.experiment.design_file import (
    BadDesign,
    Fault,
    design_text,
    fault_at,
    lines_of,
    parse_design,
    read_design,
)
from eigenwalker.experiment.experiment_texts import (
    Texts,
    missing_texts,
    read_texts,
    template,
    wrong_texts,
)
from eigenwalker.experiment.manipulations import (
    CARICATURE,
    MANIPULATIONS,
    manipulation_design,
)
from eigenwalker.experiment.observer_page import observer_page
from eigenwalker.experiment.order import (
    Trial,
    session_trials,
    shown_walkers,
    stimulus_name,
)
from eigenwalker.experiment.stimulus_bundle import (
    Bundle,
    Piece,
    stimulus_bundle,
    stimulus_piece,
)
from eigenwalker.experiment.walker_faults import walker_faults

if TYPE_CHECKING:
    from eigenwalker.population.population import Population

DESIGN, TEXTS, STIMULI, PEOPLE = "design.toml", "texts", "stimuli", "walkers.json"
OBSERVER_PAGE = "page.html"
ANSWERS, VERSIONS, BACKUPS = "answers.sqlite", "versions", "backups"
MAX_IN_MEMORY = 2000
"""Stimuli of a version that a server has in memory, some 10 kB each."""
_NUMBER = re.compile(r"(?m)^(# )?number = \d+")
DESIGNS = (
    *("troje2002", "wdp2002", "prazak2010", "detection"),
    *("same_different", "odd_one_out", "adjustment"),
)
"""Ready to run, beside `MANIPULATIONS` and `CARICATURE`."""
_ANEW = "make them anew: eigenwalker experiment stimuli {}"
TEXTS_OF = {
    "choice": "troje2002",
    "rating": "wdp2002",
    "similar_pair": "prazak2010",
    "detection": "detection",
    "same_different": "same_different",
    "odd_one_out": "odd_one_out",
    "adjustment": "adjustment",
}
"""The texts that a design of one's own begins with, by the task of its first block."""


@dataclass(frozen=True)
class Material:
    """A design with its texts and stimuli, in one folder."""

    folder: Path

    @cached_property
    def design(self) -> Design:
        """The design, checked."""
        return read_design(self.folder / DESIGN)

    @cached_property
    def people(self) -> dict[str, Any]:
        """The walkers' names, scores and classes."""
        return json.loads((self.folder / PEOPLE).read_text(encoding="utf-8"))

    @property
    def walker_names(self) -> list[str]:
        """Names of all walkers of the population, by number."""
        return self.people["walkers"]

    @cached_property
    def walkers(self) -> list[int]:
        """Numbers of the walkers that are shown."""
        return shown_walkers(self.design, len(self.walker_names))

    def texts(self, language: str) -> Texts:
        """Return the texts of a language, which are read once."""
        if language not in self._texts:
            self._texts[language] = read_texts(self.folder / TEXTS, language)
        return self._texts[language]

    @cached_property
    def _texts(self) -> dict[str, Texts]:
        return {}

    def stimulus_path(self, name: str) -> Path:
        """Return the file of a stimulus."""
        return self.folder / STIMULI / f"{name}.json"

    def stimuli(self, names: Collection[str]) -> Bundle:
        """Return stimuli as one JSON; each file is read once."""
        for name in set(names) - set(self._pieces):
            if len(self._pieces) >= MAX_IN_MEMORY:
                self._pieces.clear()
            text = self.stimulus_path(name).read_text(encoding="utf-8")
            self._pieces[name] = stimulus_piece(name, text)
        return stimulus_bundle(self._pieces[name] for name in names)

    @cached_property
    def _pieces(self) -> dict[str, Piece]:
        return {}

    def stimulus_names(self) -> list[str]:
        """Return the names of all stimuli that any observer may be shown."""
        return [
            stimulus_name(walker, condition.name, view)
            for condition in self.design.shown
            for walker in ([None] if condition.walker == "average" else self.walkers)
            for view in self.design.views_deg
        ]

    def trials(self, group: str, place: int, session: int = 0) -> list[Trial]:
        """Return the trials of a session, with right answers where walkers have classes."""
        return session_trials(
            self.design,
            self.walkers,
            group=group,
            place=place,
            session=session,
            classes=self.people["classes"],
        )

    def faults(self) -> list[str]:
        """Return all that is wrong, each with where it is and what to do."""
        found: list[str] = []
        try:
            design: Design | None = self.design
        except BadDesign as error:
            found, design = str(error).splitlines(), error.without
        if design is None:
            return found
        try:
            wrong = self._design_faults(design)
        except (OSError, KeyError, TypeError, json.JSONDecodeError):
            found.append(f"{PEOPLE} is missing or damaged; {_ANEW.format(self.folder)}")
        else:
            found += [f"{DESIGN}, {fault}" for fault in wrong]
            found += self._stimulus_faults() if not found else []
        for language in design.languages:
            found += self._text_faults(design, language)
        return [*dict.fromkeys(found)]

    def _design_faults(self, design: Design) -> list[Fault]:
        """What the design asks of the walkers that they cannot give."""
        lines = lines_of(design_text(self.folder / DESIGN))
        faults = [fault_at(*conflict, lines) for conflict in walker_faults(design, self.people)]
        return sorted(faults, key=lambda fault: fault.line)

    def _stimulus_faults(self) -> list[str]:
        changed = self._changed_since_made()
        if changed:
            what = ", ".join(changed)
            return [
                f"{STIMULI}/ were made for another design ({what}); {_ANEW.format(self.folder)}"
            ]
        names = self.stimulus_names()
        lacking = [name for name in names if not self.stimulus_path(name).is_file()]
        if not lacking:
            return []
        which = ", ".join(f"{STIMULI}/{name}.json" for name in lacking[:3])
        more = f" and {len(lacking) - 3} more" if len(lacking) > 3 else ""
        return [f"{which}{more} missing; {_ANEW.format(self.folder)}"]

    def _changed_since_made(self) -> list[str]:
        """What in the design is not as it was when the stimuli were made."""
        made = self.people.get("made_for")
        if made is None:
            return []
        now = recipe(self.design)
        before, after = made["picture"], now["picture"]
        found = [
            f"{name} is {after[name]}, was {before.get(name)}"
            for name in after
            if after[name] != before.get(name)
        ]
        return found + [
            f"condition {name!r}"
            for name, condition in now["conditions"].items()
            if condition != made["conditions"].get(name)
        ]

    def _text_faults(self, design: Design, language: str) -> list[str]:
        path = f"{TEXTS}/{language}.md"
        try:
            texts = self.texts(language)
        except OSError:
            return [f"{path} is missing; write it, or take {language!r} out of languages"]
        except ValueError:
            return [f"{path} is not in UTF-8; save it as UTF-8"]
        lacking = missing_texts(design, texts)
        return [
            *(f"{path} lacks the section '# {name}'; add it" for name in lacking),
            *(f"{path}: {problem}" for problem in wrong_texts(design, texts)),
        ]

    def hash(self) -> str:
        """Return the hash of design, texts, stimuli and page: the version of the experiment."""
        whole = hashlib.sha256()
        for path in self._paths():
            content = (self.folder / path).read_bytes()
            whole.update(f"{path}\0{len(content)}\0".encode() + content)
        whole.update(observer_page(self.design).encode())
        return whole.hexdigest()

    def state(self) -> list[tuple[str, int, int]]:
        """Return sizes and times of what a hash would read, to see at once whether it changed."""
        paths = [DESIGN, PEOPLE, STIMULI, TEXTS]
        paths += sorted(f"{TEXTS}/{path.name}" for path in (self.folder / TEXTS).glob("*.md"))
        found = [(path, (self.folder / path).stat()) for path in paths]
        return [(path, stat.st_size, stat.st_mtime_ns) for path, stat in found]

    def _paths(self) -> Iterator[str]:
        yield from (DESIGN, PEOPLE)
        yield from (f"{TEXTS}/{language}.md" for language in sorted(self.design.languages))
        yield from (f"{STIMULI}/{name}.json" for name in sorted(self.stimulus_names()))

    def copy_to(self, folder: Path) -> None:
        """Copy all, with the page as it is, into a folder, which appears whole or not at all."""
        unfinished = folder.with_name(f".{folder.name}.part")
        shutil.rmtree(unfinished, ignore_errors=True)
        for path in self._paths():
            target = unfinished / path
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.folder / path, target)
        (unfinished / OBSERVER_PAGE).write_text(observer_page(self.design), encoding="utf-8")
        unfinished.rename(folder)


def recipe(design: Design) -> dict[str, Any]:
    """Return what the stimuli of a design are made from, but walkers and views."""
    picture = design.picture.model_dump(mode="json", exclude={"view_deg", "both_signs"})
    screen = design.screen.model_dump(mode="json", include={"viewing_distance_mm", "px_per_cm"})
    conditions = {each.name: each.model_dump(mode="json") for each in design.shown}
    return {"picture": picture | screen, "conditions": conditions}


def new_experiment(
    folder: Path,
    design_name: str,
    population: Population,
    *,
    seed: int = 1,
    walkers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Material:
    """Make the folder of an experiment: design, texts, and all stimuli."""
    text = _design_text(design_name)
    if folder.exists() and any(folder.iterdir()):
        raise ValueError(f"{folder} is not empty; name a new folder.")
    text = text.replace("{seed}", str(seed))
    if walkers is not None:
        text = _with_walkers(text, walkers)
    people = people_of(population)
    design = parse_design(text, design_name)
    if conflicts := walker_faults(design, people):
        lines = lines_of(text)
        faults = [fault_at(where, problem, lines) for where, problem in conflicts]
        raise BadDesign(design_name, faults)
    (folder / TEXTS).mkdir(parents=True, exist_ok=True)
    (folder / DESIGN).write_text(text, encoding="utf-8")
    tasks = [TEXTS_OF[block.task] for block in design.blocks]
    (folder / TEXTS / "en.md").write_text(template(design, tasks), encoding="utf-8")
    material = Material(folder)
    write_stimuli(material, population, progress)
    return material


def _with_walkers(text: str, number: int) -> str:
    """Return the text of a design with another number of walkers."""
    if _NUMBER.search(text):
        return _NUMBER.sub(f"number = {number}", text, count=1)
    return text.rstrip() + f"\n\n[walkers]\nnumber = {number}\n"


def people_of(population: Population) -> dict[str, Any]:
    """Return what is kept of a population beside the stimuli."""
    return {
        "walkers": population.names,
        "provenance": dict(population.provenance),
        "traits": trait_poles(population),
        **walker_scores(population),
    }


def trait_poles(population: Population) -> dict[str, list[str]]:
    """Return the negative and the positive pole of each trait that has an axis."""
    from eigenwalker.analysis.contrast import trait_contrast

    found: dict[str, list[str]] = {}
    for name in map(str, population.traits):
        try:
            contrast = trait_contrast(population, name)
        except ValueError:
            continue
        found[name] = [contrast.negative, contrast.positive]
    return found


def _design_text(name: str) -> str:
    """Return the text of a design by its name or file."""
    folder = files("eigenwalker.experiment").joinpath("designs")
    if name.endswith(".toml"):
        if not Path(name).is_file():
            raise ValueError(f"--design {name}: there is no such file.")
        return design_text(Path(name))
    if name in DESIGNS:
        return folder.joinpath(f"{name}.toml").read_text(encoding="utf-8")
    kind, _, which = name.partition(":")
    found = CARICATURE if name == "caricature" else MANIPULATIONS.get(which)
    if found is None or (kind != "manipulation" and name != "caricature"):
        known = [*DESIGNS, "caricature", *(f"manipulation:{each}" for each in MANIPULATIONS)]
        raise ValueError(f"--design {name!r} is not known; choose from {', '.join(known)}.")
    frame = folder.joinpath("manipulation.toml").read_text(encoding="utf-8")
    return manipulation_design(frame, which or name, found)


def walker_scores(population: Population) -> dict[str, Any]:
    """Return where the walkers are in their space, and their traits of two classes.

    Simulated observers answer by them.
    """
    from eigenwalker.analysis.walker_space import WalkerSpace

    n_components = min(10, len(population) - 1)
    scores = WalkerSpace(n_components=n_components).fit_transform(population.X)
    traits = population.traits
    classes = {
        str(name): traits[name].astype(str).tolist()
        for name in traits
        if traits[name].dtype.kind in "OUT" and traits[name].nunique() == 2
    }
    scaled = scores / scores.std(axis=0, ddof=1)
    return {"scores": scaled.round(6).tolist(), "classes": classes}


def write_stimuli(
    material: Material,
    population: Population,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Write the stimulus files that a design needs, and what they were made from."""
    from eigenwalker.experiment.condition_stimuli import ConditionStimuli

    people = {**people_of(population), "made_for": recipe(material.design)}
    (material.folder / PEOPLE).write_text(json.dumps(people) + "\n", encoding="utf-8")
    folder = material.folder / STIMULI
    folder.mkdir(exist_ok=True)
    stimuli = ConditionStimuli(material.design, population)
    everyone = [*shown_walkers(material.design, len(population)), None]
    made: set[str] = set()
    for done, walker in enumerate(everyone):
        if progress is not None:
            progress(done, len(everyone))
        for name, stimulus in stimuli.of(walker):
            material.stimulus_path(name).write_text(stimulus.to_json(), encoding="utf-8")
            made.add(f"{name}.json")
    for path in folder.glob("*.json"):
        if path.name not in made:
            path.unlink()


def remake_stimuli(
    folder: Path,
    population: Population,
    progress: Callable[[int, int], None] | None = None,
) -> Material:
    """Make all stimuli of an experiment anew, as its design is now."""
    text = design_text(folder / DESIGN)
    design = parse_design(text, DESIGN)
    if conflicts := walker_faults(design, people_of(population)):
        lines = lines_of(text)
        raise BadDesign(DESIGN, [fault_at(*conflict, lines) for conflict in conflicts])
    material = Material(folder)
    write_stimuli(material, population, progress)
    return Material(folder)
