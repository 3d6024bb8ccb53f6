"""The names that the package gives to the world, and the rooms that hold them."""

from __future__ import annotations

import collections
import importlib
import inspect
import pkgutil
from pathlib import Path
from types import ModuleType

import pytest

import eigenwalker as ew

PACKAGE = Path(ew.__file__).parent
ROOMS = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
PUBLIC_ROOMS = [room for room in ROOMS if (PACKAGE / room / "__init__.pyi").exists()]
FORMATS = {"bvh", "c3d", "netcdf"}
"""File formats that have a reader and a writer."""
SHARED = {"__init__", "fourier", *FORMATS}


def room(name: str) -> ModuleType:
    return importlib.import_module(f"eigenwalker.{name}")


def test_every_public_name_is_there() -> None:
    for name in ew.__all__:
        assert getattr(ew, name) is not None


@pytest.mark.parametrize("name", PUBLIC_ROOMS)
def test_every_public_name_of_a_room_is_there(name: str) -> None:
    for public in room(name).__all__:
        assert getattr(room(name), public) is not None


@pytest.mark.parametrize("name", PUBLIC_ROOMS)
def test_a_function_is_not_hidden_by_the_module_of_its_name(name: str) -> None:
    for module in pkgutil.iter_modules(room(name).__path__):
        if module.name in room(name).__all__:
            importlib.import_module(f"eigenwalker.{name}.{module.name}")
            assert callable(getattr(room(name), module.name))


def test_the_top_lists_what_one_needs_every_day_and_the_rooms() -> None:
    listed = dir(ew)
    assert {name for name in listed if isinstance(getattr(ew, name), ModuleType)} == set(
        PUBLIC_ROOMS
    )
    assert 25 <= len(listed) - len(PUBLIC_ROOMS) <= 35


def test_pinned_names_work_from_the_top_and_are_not_listed() -> None:
    assert ew.assess is ew.quality.assess
    assert ew.motion_map is ew.metric.motion_map
    assert not {"assess", "motion_map", "register", "loop"} & set(dir(ew))


def test_the_root_holds_no_modules_of_its_own() -> None:
    files = {path.name for path in PACKAGE.iterdir() if path.is_file()}
    assert files == {"__init__.py", "__init__.pyi", "__main__.py", "_version.py", "py.typed"}


def test_no_module_name_stands_in_two_rooms() -> None:
    rooms = collections.defaultdict(set)
    for path in PACKAGE.rglob("*.py"):
        if path.parent != PACKAGE:
            rooms[path.stem].add(path.relative_to(PACKAGE).parts[0])
    assert {name for name, where in rooms.items() if len(where) > 1} <= SHARED


@pytest.mark.parametrize("name", PUBLIC_ROOMS)
def test_the_types_of_public_functions_are_public(name: str) -> None:
    public = {
        id(getattr(room(where), each)) for where in PUBLIC_ROOMS for each in room(where).__all__
    }
    missing = set()
    for each in room(name).__all__:
        thing = getattr(room(name), each)
        if not inspect.isfunction(thing):
            continue
        module = vars(inspect.getmodule(thing))
        for annotation in thing.__annotations__.values():
            for word in set(str(annotation).replace("[", " ").replace("]", " ").split()):
                kind = module.get(word.strip(",|"))
                ours = inspect.isclass(kind) and kind.__module__.startswith("eigenwalker")
                if ours and id(kind) not in public:
                    missing.add(kind.__name__)
    assert not missing
