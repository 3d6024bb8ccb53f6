"""The arrays in a MATLAB file, by name.

Run in a child process (`sandbox`), as SciPy does not promise to survive damaged files; so it
imports nothing of this package.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from typing import Any

import numpy as np

MAX_DEPTH = 8
MAX_NUMBERS = 50_000_000


def mat_arrays_npz(path: str) -> bytes:
    """Return the arrays of `mat_arrays` as an .npz file, each name with ``_`` before it."""
    content = io.BytesIO()
    savez: Callable[..., None] = np.savez
    savez(content, **{f"_{name}": array for name, array in mat_arrays(path).items()})
    return content.getvalue()


def mat_arrays(path: str) -> dict[str, np.ndarray]:
    """Return the arrays of real numbers in a MATLAB file, those in structs as ``struct.field``."""
    with open(path, "rb") as file:
        start = file.read(128)
    if start.startswith((b"MATLAB 7.3", b"\x89HDF")):
        return _of_hdf5(path)
    scipy_io = import_module("scipy.io")
    for name, shape, _ in scipy_io.whosmat(path):
        _check_size(name, shape)
    variables = scipy_io.loadmat(path, struct_as_record=False, chars_as_strings=False)
    return dict(_numeric({n: v for n, v in variables.items() if not n.startswith("__")}))


def _check_size(name: str, shape: tuple[int, ...]) -> None:
    if np.prod([float(size) for size in shape]) > MAX_NUMBERS:
        raise ValueError(f"{name} has the shape {shape}")


def _numeric(variables: Mapping[str, Any], depth: int = 0) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the numeric arrays among variables, and those in structs of one element."""
    for name, value in variables.items():
        if not hasattr(value, "dtype"):
            continue
        fields = getattr(value.flat[0], "_fieldnames", None) if value.size == 1 else None
        if value.dtype.kind in "fiub" and value.size:
            yield name, value.astype(float)
        elif fields and depth < MAX_DEPTH:
            inner = {f"{name}.{field}": getattr(value.flat[0], field) for field in fields}
            yield from _numeric(inner, depth + 1)


def _of_hdf5(path: str) -> dict[str, np.ndarray]:
    h5py = import_module("h5py")
    arrays: dict[str, np.ndarray] = {}

    def visit(name: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "fiub" or not item.size:
            return
        if name.startswith("#") or bytes(item.attrs.get("MATLAB_class", b"")) == b"char":
            return  # cells, and texts, which MATLAB stores as numbers
        _check_size(name, item.shape)
        arrays[name.replace("/", ".")] = np.asarray(item[()], dtype=float).T

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return arrays
