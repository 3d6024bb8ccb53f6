"""Keys of links: 128 random bits, of which only hashes are stored."""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets


def new_key() -> str:
    """Return a new key of 128 bits."""
    return secrets.token_urlsafe(16)


def hash_of(key: str) -> str:
    """Return what is stored of a key."""
    return hashlib.sha256(key.encode()).hexdigest()


def keyed_hash(secret: str, text: str) -> str:
    """Return a hash of an identifier that nobody can try out without the secret."""
    return hmac.new(bytes.fromhex(secret), text.encode(), hashlib.sha256).hexdigest()


def withdrawal_code(secret: str, observer: int) -> str:
    """Return the code by which an observer withdraws later.

    Examples
    --------
    >>> withdrawal_code("00" * 32, 1)
    'KNB4-GYDV-LCPP-IYGE'
    """
    digest = hmac.new(bytes.fromhex(secret), f"withdraw {observer}".encode(), hashlib.sha256)
    text = base64.b32encode(digest.digest()[:10]).decode()
    return "-".join(text[start : start + 4] for start in range(0, 16, 4))


def same(one: str, other: str) -> bool:
    """Whether two texts are the same, in a time that does not tell where they differ."""
    return hmac.compare_digest(one.encode(), other.encode())
