"""The file of the built-in people, made by ``python -m eigenwalker.datasets.built_in_file``.

Building a wheel does so, as does an editable installation. The file's name holds the hash of the
code that made it, so that other code does not find it, and simulates the people instead.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.core.walker import CaptureFit, Walker
from eigenwalker.datasets.code_hash import BUILT, code_hash, people_file
from eigenwalker.population.correspondence import Correspondence, ReferenceWalker
from eigenwalker.population.population import FLAG, Population

_ONE_OF_EACH = ("p0", "p", "phases", "frequency_hz", "speed_mm_s", "time_origin_s")
_FIT = [field.name for field in fields(CaptureFit)]


def write_people(people: Population, path: Path, **details: Any) -> Path:
    """Write simulated people, with `details` of them, as arrays that NumPy reads fast."""
    first, correspondence = people.walkers[0], people.correspondence
    assert correspondence is not None
    arrays = {name: np.stack([getattr(w, name) for w in people.walkers]) for name in _ONE_OF_EACH}
    arrays |= {
        f"fit_{name}": np.stack([getattr(w.fit, name) for w in people.walkers]) for name in _FIT
    }
    arrays["harmonics"], arrays["similarity"] = first.harmonics, correspondence.similarity
    reference = correspondence.reference
    arrays["reference_axes"], arrays["reference_average"] = reference.axes, reference.average
    about = {
        "markers": first.markers,
        "form": first.form,
        "traits": people.traits.drop(columns=FLAG).to_dict("list"),
        "flags": correspondence.flags,
        "provenance": {**people.provenance, **details, "sha256": _hash_of(people)},
    }
    arrays["about"] = np.array(json.dumps(about))
    with atomic_write(path) as unfinished, unfinished.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return path


def read_people(path: Path) -> Population:
    """Read what `write_people` wrote: the same numbers, to the last bit."""
    import pandas as pd

    with np.load(path, allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in stored.files}
    about = json.loads(arrays.pop("about").item())
    markers, form = tuple(about["markers"]), about["form"]
    reference = ReferenceWalker(
        arrays["reference_axes"], arrays["reference_average"], form, markers
    )
    flags = tuple(about["flags"])
    walkers = [
        Walker(
            markers=markers,
            harmonics=arrays["harmonics"],
            form=form,
            fit=CaptureFit(**{name: _plain(arrays[f"fit_{name}"][number]) for name in _FIT}),
            **{name: arrays[name][number] for name in _ONE_OF_EACH},
        )
        for number in range(len(flags))
    ]
    return Population(
        walkers,
        pd.DataFrame(about["traits"]),
        Correspondence(reference, arrays["similarity"], flags),
        about["provenance"],
    )


def _plain(value: Any) -> Any:
    return value if np.ndim(value) else value.item()


def _hash_of(people: Population) -> str:
    return hashlib.sha256(np.ascontiguousarray(people.X, dtype="<f8").tobytes()).hexdigest()


def build() -> Path:
    """Simulate the built-in people and write them where `load_population` finds them."""
    from eigenwalker._version import __version__
    from eigenwalker.datasets.built_in import simulate_built_in

    BUILT.mkdir(exist_ok=True)
    for old in BUILT.glob("people-*.npz"):
        old.unlink()
    return write_people(
        simulate_built_in(),
        people_file(),
        built=f"with eigenwalker {__version__}, by the code of hash {code_hash()[:16]}",
    )


if __name__ == "__main__":
    print(build())
