"""Ways to spoil a file: some know nothing of what is in it, some know text or binary numbers."""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Callable
from random import Random

import xarray as xr

MOST_BYTES = 1_000_000
"""Files are not made to grow beyond this, but for a line that is very long."""
NUMBERS = (
    *("0", "-0", "1", "-1", "2", "255", "65535", "65536", "4294967296", "99999999999999999999"),
    *("1e308", "-1e308", "1e309", "1e-320", "1e9", "nan", "NaN", "-nan", "inf", "-inf", "Infinity"),
    *("1_0", "0x10", "1,5", "1.5.2", "--1", "+", ".", "e5", "٣", "½", "", " ", "null", "None"),
    *("true", "1e", "9" * 400, "0." + "0" * 400 + "1", "1e99999999", "1e-99999999"),
)
_INTEGERS = (0, 1, 2, 7, 127, 128, 255, 256, 32767, 32768, 65535, 2**31 - 1, 2**31, 2**32 - 1)
_WIDE = (2**62, 2**63 - 1, 2**63, 2**64 - 1)
_FLOATS = (0.0, -0.0, -1.0, 1e-40, 1e9, -1e30, 3e38, float("inf"), float("-inf"), float("nan"))
_MARKS = (
    *((b".", b","), (b"\t", b","), (b",", b";"), (b",", b"\t"), (b" ", b""), (b'"', b"")),
    *((b"\n", b"\r"), (b"\n", b" "), (b"\n", b"\n\n"), (b"{", b"["), (b"-", b"--"), (b"0", b"")),
)
_REPEATED = (
    *(b"1 ", b"1,", b"9", b" ", b"\t", b"\n", b"\r", b"\n ", b",", b"a", b"-", b"1e", b'"', b"'"),
    *(
        b"x_",
        b"_",
        b"a_x,",
        b"a:",
        b":",
        b"#",
        b"# ",
        b"=",
        b"a=1;",
        b"keypoints",
        b"frame\t",
        b"\0",
    ),
)
_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
_VALUE = re.compile(
    rb'(?<=[:\[,])\s*(?:[-+]?\d[\d.eE+-]*|"[^"\\\n]{0,80}"|null|true|false)(?=\s*[,\]}])'
)
_WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*")
_LETTERS = b" \t\n\r,;:.0123456789eE+-naifXYZ\"'#=[]{}()\\/|*~_\x00\x1a\x7f\x80\xbf\xef\xff"

Mutation = Callable[[bytes, Random], bytes]


def mutated(content: bytes, other: bytes, random: Random) -> bytes:
    """Return a file spoilt in one to four ways; `other` is a sound file of the same kind."""
    text = b"\0" not in content
    ways = _ANYWHERE + (_TEXT if text else _BINARY) * 2
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        if random.random() < 0.03:
            content = _spliced(content, other, random)
        content = random.choice(ways)(content, random)[:MOST_BYTES]
    return _long_line(content, random) if random.random() < 0.004 else content


def _spliced(content: bytes, other: bytes, random: Random) -> bytes:
    return content[: _place(content, random)] + other[_place(other, random) :]


def _place(content: bytes, random: Random) -> int:
    """Return a place in a file; more often near its beginning, where its header is."""
    end = len(content) if random.random() < 0.6 else min(len(content), 600)
    return random.randint(0, end)


def _flip(content: bytes, random: Random) -> bytes:
    spoilt = bytearray(content)
    for _ in range(random.choice((1, 1, 2, 8)) if spoilt else 0):
        at = min(_place(content, random), len(spoilt) - 1)
        spoilt[at] ^= 1 << random.randrange(8)
    return bytes(spoilt)


def _replace_byte(content: bytes, random: Random) -> bytes:
    at = _place(content, random)
    return content[:at] + bytes([random.randrange(256)]) + content[at + 1 :]


def _truncate(content: bytes, random: Random) -> bytes:
    return content[: random.randint(0, len(content))]


def _insert(content: bytes, random: Random) -> bytes:
    at = _place(content, random)
    return content[:at] + random.randbytes(random.choice((1, 2, 4, 64))) + content[at:]


def _delete(content: bytes, random: Random) -> bytes:
    at = _place(content, random)
    return content[:at] + content[at + random.choice((1, 2, 4, 40, 512)) :]


def _double_chunk(content: bytes, random: Random) -> bytes:
    at, size = _place(content, random), random.choice((4, 64, 512, 4096))
    return content[: at + size] * random.choice((1, 1, 1, 3)) + content[at:]


def _blank_chunk(content: bytes, random: Random) -> bytes:
    at, size = _place(content, random), random.choice((4, 16, 512))
    return content[:at] + bytes([random.choice((0, 255, 32))]) * size + content[at + size :]


def _binary_number(content: bytes, random: Random) -> bytes:
    order = random.choice("<>")
    width, kind = random.choice(((1, "B"), (2, "H"), (4, "I"), (8, "Q"), (4, "f"), (8, "d")))
    at = _place(content, random) // width * width
    if kind in "fd":
        raw = struct.pack(order + kind, random.choice(_FLOATS))
    else:
        number = random.choice(_INTEGERS + _WIDE) % 256**width
        raw = struct.pack(order + kind, number)
    return content[:at] + raw + content[at + width :]


def _text_number(content: bytes, random: Random) -> bytes:
    """Replace a number, one in the first lines as often as one anywhere."""
    within = content if random.random() < 0.5 else content[:600]
    hits = [hit.span() for hit in _NUMBER.finditer(within)]
    if not hits:
        return _flip(content, random)
    start, end = random.choice(hits)
    return content[:start] + random.choice(NUMBERS).encode() + content[end:]


def _word(content: bytes, random: Random) -> bytes:
    """Put another word of the file in the place of one, or none, or a strange one."""
    hits = [hit.span() for hit in _WORD.finditer(content[:20_000])]
    if not hits:
        return _flip(content, random)
    (start, end), (a, b) = random.choice(hits), random.choice(hits)
    strange = (b"", "Fuß 行走".encode(), b"\xff\xfe", b"x" * 3000, b"a b", b"*12", b"__class__")
    word = content[a:b] if random.random() < 0.6 else random.choice(strange)
    return content[:start] + word + content[end:]


def _letters(content: bytes, random: Random) -> bytes:
    at = _place(content, random)
    word = bytes(random.choice(_LETTERS) for _ in range(random.randint(1, 6)))
    return content[:at] + word + content[at + random.choice((0, len(word))) :]


def _lines(content: bytes, random: Random) -> bytes:
    """Leave a line out, double it, or exchange it with another."""
    lines = content.split(b"\n")
    a, b = random.randrange(len(lines)), random.randrange(len(lines))
    match random.randrange(4):
        case 0:
            del lines[a]
        case 1:
            lines.insert(b, lines[a])
        case 2:
            lines[a], lines[b] = lines[b], lines[a]
        case _:
            lines[a:b] = lines[a:b] * 2
    return b"\n".join(lines)


def _tokens(content: bytes, random: Random) -> bytes:
    """Leave out, double or exchange cells of one line."""
    lines = content.split(b"\n")
    at = random.randrange(len(lines))
    mark = next((mark for mark in (b"\t", b",", b" ") if mark in lines[at]), b" ")
    cells = lines[at].split(mark)
    a, b = random.randrange(len(cells)), random.randrange(len(cells))
    match random.randrange(3):
        case 0:
            del cells[a]
        case 1:
            cells.insert(b, cells[a])
        case _:
            cells[a], cells[b] = cells[b], cells[a]
    lines[at] = mark.join(cells)
    return b"\n".join(lines)


def _exchange_everywhere(content: bytes, random: Random) -> bytes:
    """Write another mark for one in the whole file: decimal commas, other ends of lines."""
    return content.replace(*random.choice(_MARKS))


def _recode(content: bytes, random: Random) -> bytes:
    text = content.decode("utf-8", errors="replace")
    codes = ("utf-16", "utf-16-be", "utf-32", "utf-8-sig", "cp037")
    return text.encode(random.choice(codes), errors="replace")


def _nest(content: bytes, random: Random) -> bytes:
    """Open brackets somewhere, or put closed ones in the place of a value of JSON."""
    depth = random.choice((1, 50, 400, 950, 2000, 20_000, 100_000))
    hits = [hit.span() for hit in _VALUE.finditer(content)]
    if hits and random.random() < 0.7:
        start, end = random.choice(hits)
        return content[:start] + _nested(depth, random) + content[end:]
    at = _place(content, random)
    bracket = random.choice((b"[", b"{", b"(", b'{"a":', b'"', b"JOINT a {", b"begin\n"))
    return content[:at] + bracket * depth + content[at:]


def _nested(depth: int, random: Random) -> bytes:
    """Return lists and objects of JSON in one another, all closed."""
    open_, close = random.choice(
        ((b"[", b"]"), (b'{"a":', b"}"), (b'[{"a":', b"}]"), (b"[1,", b"]"))
    )
    inner = random.choice((b"", b"1", b'"a"', b"null")) if open_ == b"[" else b"1"
    return open_ * depth + inner + close * depth


def nested_attribute(content: bytes, random: Random) -> bytes:
    """Put nested JSON in the place of an attribute of a NetCDF file, or into its object."""
    dataset = xr.load_dataset(io.BytesIO(content))
    text = _nested(random.choice((400, 950, 2000, 20_000, 100_000)), random).decode()
    name = random.choice(sorted(dataset.attrs, key=str))
    dataset.attrs[name] = random.choice((text, f'{{"a": {text}}}'))
    return bytes(dataset.to_netcdf())


def _long_line(content: bytes, random: Random) -> bytes:
    at = _place(content, random)
    unit = random.choice(_REPEATED)
    return content[:at] + unit * (2_000_000 // len(unit)) + content[at:]


_ANYWHERE: tuple[Mutation, ...] = (
    _flip, _replace_byte, _truncate, _insert, _delete, _double_chunk, _blank_chunk,
)  # fmt: skip
_TEXT: tuple[Mutation, ...] = (
    *(_text_number,) * 4, *(_word,) * 2, _letters, _lines, _lines, _tokens, _tokens,
    _exchange_everywhere, _recode, _nest,
)  # fmt: skip
_BINARY: tuple[Mutation, ...] = (*(_binary_number,) * 5, _text_number, _word)
