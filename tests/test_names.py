"""The names that the package gives to the world."""

from __future__ import annotations

import pkgutil

import eigenwalker as ew


def test_every_public_name_is_there() -> None:
    for name in ew.__all__:
        assert getattr(ew, name) is not None


def test_no_public_name_is_also_a_module() -> None:
    modules = {module.name for module in pkgutil.iter_modules(ew.__path__)}
    assert not modules & set(ew.__all__)
