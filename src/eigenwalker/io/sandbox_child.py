"""What runs in the child process of `sandbox`: one function, within limits of time and memory.

Run by its path, so that it imports nothing but what the function's own module does. Its arguments
are the module's path, the function's name, limits in seconds and bytes, and the arguments of the
function. The function returns bytes, which go to standard output; after an error, its message does.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import threading

FAILED = 1
"""The function raised an error that is none of those below, as a fault in the program does."""
REFUSED = 3
"""The function raised a ValueError: it cannot use what it was given."""
TOO_LARGE = 4
"""The function needs more memory than it may have, or returns more bytes."""


def main(module: str, function: str, seconds: str, max_bytes: str, *arguments: str) -> int:
    """Return the exit status after one call."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with os.fdopen(os.dup(1), "wb") as output:
        os.dup2(2, 1)  # what libraries print does not mix with the result
        try:
            spec = importlib.util.spec_from_file_location("job", module)
            assert spec is not None
            assert spec.loader is not None
            job = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(job)
            limit_process(int(seconds), int(max_bytes))
            result: bytes = getattr(job, function)(*arguments)
        except MemoryError:
            return TOO_LARGE
        except Exception as error:  # damaged files make readers raise anything
            output.write((str(error) or type(error).__name__).encode(errors="replace"))
            return REFUSED if isinstance(error, ValueError) else FAILED
        if len(result) > int(max_bytes):
            return TOO_LARGE
        output.write(result)
    return 0


def _end_with_parent() -> None:
    """Wait for the end of standard input, which is a pipe that the parent holds, and end."""
    os.read(0, 1)
    os._exit(FAILED)


def limit_process(seconds: int, max_bytes: int) -> None:
    """Limit the time and memory of this process; Windows cannot."""
    try:
        import resource
    except ImportError:
        return
    for kind, limit in (
        (resource.RLIMIT_AS, max_bytes),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_CORE, 0),
    ):
        try:
            resource.setrlimit(kind, (limit, limit))
        except (ValueError, OSError):
            continue  # macOS knows no limit of address space


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
