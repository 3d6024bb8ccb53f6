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
from eigenwalker.experiment.design_file import read_design
from eigenwalker.experiment.experiment_texts import Texts, missing_texts, read_texts, template
from eigenwalker.experiment.manipulations import (
    CARICATURE,
    MANIPULATIONS,
    manipulation_design,
)
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

if TYPE_CHECKING:
    from eigenwalker.population.population import Population

DESIGN, TEXTS, STIMULI, PEOPLE = "design.toml", "texts", "stimuli", "walkers.json"
ANSWERS, VERSIONS, BACKUPS = "answers.sqlite", "versions", "backups"
MAX_KEPT = 2000
"""Stimuli of a version that a server has in memory, some 10 kB each."""
_NUMBER = re.compile(r"(?m)^(# )?number = \d+")
DESIGNS = (
    *("troje2002", "wdp2002", "prazak2010", "detection"),
    *("same_different", "odd_one_out", "adjustment"),
)
"""Ready to run, beside `MANIPULATIONS` and `CARICATURE`."""
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
            if len(self._pieces) >= MAX_KEPT:
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
        """Return what is missing beside the design, each with what to do."""
        found: list[str] = []
        try:
            found += [
                f"{STIMULI}/{name}.json is missing; make a new folder of this design: "
                f"experiment new FOLDER --design {self.folder / DESIGN}"
                for name in self.stimulus_names()
                if not self.stimulus_path(name).is_file()
            ]
        except (OSError, KeyError, ValueError) as error:
            found.append(str(error) if isinstance(error, ValueError) else f"{PEOPLE} is missing")
        for language in self.design.languages:
            path = f"{TEXTS}/{language}.md"
            try:
                lacking = missing_texts(self.design, self.texts(language))
            except OSError:
                found.append(f"{path} is missing; write it, or take {language!r} out of languages")
            except ValueError:
                found.append(f"{path} is not in UTF-8; save it as UTF-8")
            else:
                found += [f"{path} lacks the section '# {name}'; add it" for name in lacking]
        return found

    def hash(self) -> str:
        """Return the hash of design, texts and stimuli: the version of the experiment."""
        whole = hashlib.sha256()
        for path in self._paths():
            content = (self.folder / path).read_bytes()
            whole.update(f"{path}\0{len(content)}\0".encode() + content)
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
        """Copy design, texts and stimuli into a folder, which appears whole or not at all."""
        unfinished = folder.with_name(f".{folder.name}.part")
        shutil.rmtree(unfinished, ignore_errors=True)
        for path in self._paths():
            target = unfinished / path
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.folder / path, target)
        unfinished.rename(folder)


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
    text, texts = _design_text(design_name)
    if folder.exists() and any(folder.iterdir()):
        raise ValueError(f"{folder} is not empty; name a new folder.")
    (folder / TEXTS).mkdir(parents=True, exist_ok=True)
    text = text.replace("{seed}", str(seed))
    if walkers is not None:
        text = _NUMBER.sub(f"number = {walkers}", text)
    (folder / DESIGN).write_text(text, encoding="utf-8")
    (folder / TEXTS / "en.md").write_text(template(texts), encoding="utf-8")
    people = {
        "walkers": population.names,
        "provenance": dict(population.provenance),
        **walker_scores(population),
    }
    (folder / PEOPLE).write_text(json.dumps(people) + "\n", encoding="utf-8")
    material = Material(folder)
    write_stimuli(material, population, progress)
    return material


def _design_text(name: str) -> tuple[str, str]:
    """Return the text of a design by its name or file, and the name of its texts."""
    folder = files("eigenwalker.experiment").joinpath("designs")
    if name.endswith(".toml"):
        design = read_design(Path(name))
        task = design.blocks[0].task
        return Path(name).read_text(encoding="utf-8-sig"), TEXTS_OF[task]
    if name in DESIGNS:
        return folder.joinpath(f"{name}.toml").read_text(encoding="utf-8"), name
    kind, _, which = name.partition(":")
    found = CARICATURE if name == "caricature" else MANIPULATIONS.get(which)
    if found is None or (kind != "manipulation" and name != "caricature"):
        known = [*DESIGNS, "caricature", *(f"manipulation:{each}" for each in MANIPULATIONS)]
        raise ValueError(f"--design {name!r} is not known; choose from {', '.join(known)}.")
    frame = folder.joinpath("manipulation.toml").read_text(encoding="utf-8")
    return manipulation_design(frame, which or name, found), "troje2002"


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
    """Write the stimulus files that a design needs."""
    from eigenwalker.experiment.condition_stimuli import ConditionStimuli

    (material.folder / STIMULI).mkdir(exist_ok=True)
    stimuli = ConditionStimuli(material.design, population)
    everyone = [*material.walkers, None]
    for done, walker in enumerate(everyone):
        if progress is not None:
            progress(done, len(everyone))
        for name, stimulus in stimuli.of(walker):
            material.stimulus_path(name).write_text(stimulus.to_json(), encoding="utf-8")
