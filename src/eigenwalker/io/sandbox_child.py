"""What runs in the child process of `child_process`: one function on one file, within limits.

Run by its path, so that it imports nothing but what the function's own module does. Its arguments
are the module's path, the function's name, the file, and limits in seconds and bytes; arrays go to
standard output as an .npz, a refusal to standard error with the status `REFUSED`.
"""

from __future__ import annotations

import importlib.util
import io
import sys

REFUSED = 3
TOO_LARGE = 4


def main(module: str, function: str, path: str, seconds: int, most_bytes: int) -> int:
    """Return the exit status after one file."""
    import numpy as np

    spec = importlib.util.spec_from_file_location("reader", module)
    assert spec is not None
    assert spec.loader is not None
    reader = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(reader)
    limit_itself(seconds, most_bytes)
    try:
        arrays = getattr(reader, function)(path)
        if sum(array.nbytes for array in arrays.values()) > most_bytes:
            return TOO_LARGE
        written = io.BytesIO()
        np.savez(written, **{f"_{name}": array for name, array in arrays.items()})
    except MemoryError:
        return TOO_LARGE
    except Exception as error:  # whatever a damaged file makes a reader raise
        sys.stderr.write(" ".join(f"{error or type(error).__name__}".split())[:300])
        return REFUSED
    sys.stdout.buffer.write(written.getvalue())
    return 0


def limit_itself(seconds: int, most_bytes: int) -> None:
    """Set what the system takes away from a process; Windows has no such limits."""
    try:
        import resource
    except ImportError:
        return
    for kind, most in (
        (resource.RLIMIT_AS, most_bytes),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_CORE, 0),
    ):
        try:
            resource.setrlimit(kind, (most, most))
        except (ValueError, OSError):
            continue  # macOS knows no limit of address space


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4], seconds=int(sys.argv[4]), most_bytes=int(sys.argv[5])))
