"""One BLAS thread for products of small matrices, which more threads slow down."""

# threadpoolctl has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false
from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS uses one thread."""
    return _thread_pools().limit(limits=1, user_api="blas")


@cache
def _thread_pools() -> ThreadpoolController:
    return ThreadpoolController()  # looks through all loaded libraries, which takes 2 ms
