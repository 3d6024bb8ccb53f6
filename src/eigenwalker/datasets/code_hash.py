"""Which code the built-in people are made by; without imports, as the build of a wheel asks too."""

import hashlib
from pathlib import Path

_DATASETS = Path(__file__).parent
_PACKAGE = _DATASETS.parent
_ROOMS = ("core", "markers", "gait", "decomposition", "population", "simulation")
"""What a simulated capture passes through on its way to a walker in a population."""
BUILT = _DATASETS / "built"


def people_file() -> Path:
    """Return where the built-in people of this very code are, or would be."""
    return BUILT / f"people-{code_hash()[:16]}.npz"


def code_hash() -> str:
    """Return the SHA-256, in hexadecimal digits, of the code and numbers that people come from."""
    found = hashlib.sha256()
    files = [
        path
        for room in _ROOMS
        for path in (_PACKAGE / room).rglob("*")
        if path.suffix in (".py", ".toml")
    ]
    for path in sorted([*files, *_DATASETS.glob("built_in*.py")]):
        found.update(path.relative_to(_PACKAGE).as_posix().encode())
        found.update(path.read_bytes().replace(b"\r\n", b"\n"))
    return found.hexdigest()
