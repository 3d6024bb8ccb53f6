"""All stimuli of a session as one JSON, of which each stimulus is compressed once for everybody."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

_HEADER = b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\xff"
_LAST_BLOCK = b"\x03\x00"


@dataclass(frozen=True)
class Piece:
    """A part of a file, as it is and compressed so that others may follow (RFC 1951)."""

    plain: bytes
    deflated: bytes

    @classmethod
    def of(cls, text: str) -> Piece:
        """Compress a part."""
        plain, compressor = text.encode(), zlib.compressobj(9, wbits=-15)
        deflated = compressor.compress(plain) + compressor.flush(zlib.Z_FULL_FLUSH)
        return cls(plain, deflated)


def stimulus_piece(name: str, text: str) -> Piece:
    """Return a stimulus under its name."""
    return Piece.of(f"{json.dumps(name)}:{text}")


@dataclass(frozen=True)
class Bundle:
    """A file as it is and as gzip (RFC 1952)."""

    plain: bytes
    gzipped: bytes


_OPEN, _COMMA, _CLOSE = (Piece.of(text) for text in "{,}")


def stimulus_bundle(stimuli: Iterable[Piece]) -> Bundle:
    """Return stimuli as one JSON.

    Examples
    --------
    >>> import gzip
    >>> both = stimulus_bundle([stimulus_piece("one", "1"), stimulus_piece("two", "2")])
    >>> both.plain, gzip.decompress(both.gzipped)
    (b'{"one":1,"two":2}', b'{"one":1,"two":2}')
    """
    pieces = [_OPEN]
    for stimulus in stimuli:
        pieces += [stimulus, _COMMA]
    pieces = [*(pieces[:-1] if len(pieces) > 1 else pieces), _CLOSE]
    plain = b"".join(piece.plain for piece in pieces)
    end = struct.pack("<II", zlib.crc32(plain), len(plain) % 2**32)
    deflated = b"".join(piece.deflated for piece in pieces)
    return Bundle(plain, _HEADER + deflated + _LAST_BLOCK + end)
