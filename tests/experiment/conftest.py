"""A small experiment, of four walkers and eight trials."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import eigenwalker as ew
from eigenwalker.experiment.answer_writer import AnswerWriter
from eigenwalker.experiment.design_file import parse_design
from eigenwalker.experiment.experiment_folder import (
    ANSWERS,
    DESIGN,
    PEOPLE,
    new_experiment,
    recipe,
)
from eigenwalker.experiment.service import Service


@pytest.fixture(scope="session")
def templates(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Folder of a design with four walkers, made once."""
    made: dict[str, Path] = {}
    place = tmp_path_factory.mktemp("experiments")

    def template(design: str) -> Path:
        if design not in made:
            made[design] = place / design
            new_experiment(made[design], design, ew.load_population(), walkers=4)
        return made[design]

    return template


@pytest.fixture
def small(templates: Callable[[str], Path], tmp_path: Path) -> Callable[..., Path]:
    """Maker of folders of experiments, with texts of their design replaced."""

    def make(design: str = "troje2002", **changes: str) -> Path:
        folder = tmp_path / design
        shutil.copytree(templates(design), folder)
        text = (folder / DESIGN).read_text(encoding="utf-8")
        for name, value in changes.items():
            lines = [
                f"{name} = {value}" if line.startswith(f"{name} =") else line
                for line in text.splitlines()
            ]
            text = "\n".join(lines) + "\n"
        (folder / DESIGN).write_text(text, encoding="utf-8")
        people = json.loads((folder / PEOPLE).read_text(encoding="utf-8"))
        people["made_for"] = recipe(parse_design(text))  # the stimuli pass for those of the design
        (folder / PEOPLE).write_text(json.dumps(people), encoding="utf-8")
        return folder

    return make


@pytest.fixture
def service(small: Callable[..., Path]) -> Iterator[Service]:
    """A service of a small experiment."""
    folder = small()
    with AnswerWriter(folder / ANSWERS) as writer:
        yield Service(folder, writer)
