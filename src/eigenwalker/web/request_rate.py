"""How many requests a key may send: a bucket a key, which fills with time."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable

MAX_KEYS = 50_000


class TooMany(Exception):  # noqa: N818 - the name says what it is
    """More requests than a key may send; `details` says when the next is taken."""

    def __init__(self, wait_s: int) -> None:
        super().__init__(f"Too many requests; the next is taken in {wait_s} s.")
        self.headers = {"retry-after": str(wait_s)}


class RequestRate:
    """Counts requests by key, never by network address: a computer room shares one.

    Examples
    --------
    >>> rate = RequestRate(at_once=1, per_s=0.5, clock=lambda: 0.0)
    >>> rate.count("key")
    >>> rate.count("key")
    Traceback (most recent call last):
    ...
    eigenwalker.web.request_rate.TooMany: Too many requests; the next is taken in 2 s.
    """

    def __init__(
        self, *, at_once: float, per_s: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._at_once, self._per_s, self._clock = at_once, per_s, clock
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def count(self, key: str) -> None:
        """Count a request; raise `TooMany` where the key has none left."""
        now = self._clock()
        left, then = self._buckets.pop(key, (self._at_once, now))
        left = min(self._at_once, left + (now - then) * self._per_s)
        self._buckets[key] = (left - 1 if left >= 1 else left, now)
        if len(self._buckets) > MAX_KEYS:
            self._buckets.popitem(last=False)
        if left < 1:
            raise TooMany(max(round((1 - left) / self._per_s), 1))
