"""What a file seems to be that no reader takes, in words for its owner."""

from __future__ import annotations

import codecs
import re

from eigenwalker.io.capture_file import as_utf8

_MAX_QUOTED = 32
"""Letters of a text that are quoted."""
_SIGNATURES = (
    (rb"\x89HDF\r\n\x1a\n", "a NetCDF-4 or HDF5 file"),
    (rb"CDF[\x01\x02\x05]", "a NetCDF file"),
    (rb"MATLAB", "a MATLAB file"),
    (
        rb"\x93NUMPY|PK\x03\x04.{26}[^\0]{1,200}?\.npy",
        "NumPy arrays, as AMASS and others have them",
    ),
    (rb"PK[\x03\x05]", "a ZIP archive, such as a document or a spreadsheet is"),
    (rb"\x1f\x8b", "a file compressed with gzip"),
    (rb"BZh|7z\xbc\xaf|\xfd7zXZ|Rar!|\(\xb5/\xfd", "an archive"),
    (rb"%PDF", "a PDF document"),
    (rb"\xd0\xcf\x11\xe0", "a document of an older office program"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8|RIFF....WEBP|II\*\x00|MM\x00\*", "a picture"),
    (rb"....ftyp|RIFF....AVI |\x1aE\xdf\xa3", "a film"),
    (rb"RIFF....WAVE|ID3|OggS|fLaC", "a sound"),
    (rb"\x7fELF|MZ", "a program"),
    (rb"Kaydara FBX", "an FBX file"),
    (rb"SQLite format 3", "an SQLite database"),
    (rb"\s*<(?:!doctype html|html)", "a page of HTML"),
    (rb"\s*<\?xml", "a file of XML"),
)


def file_type_of(content: bytes) -> str:
    """Return what a file seems to be, as the end of a sentence."""
    beginning = as_utf8(content[:1000])
    for signature, kind in _SIGNATURES:
        if re.match(signature, beginning, re.DOTALL | re.IGNORECASE):
            return kind
    try:  # not to the end, where a letter may be cut
        words = " ".join(codecs.getincrementaldecoder("utf-8-sig")().decode(beginning).split())
    except UnicodeDecodeError:
        words = ""
    if not words or not words.isprintable():
        return "a file of no kind that is known here"
    quoted = words if len(words) <= _MAX_QUOTED else f"{words[:_MAX_QUOTED].rstrip()} ..."
    return f'a text that begins with "{quoted}"'


def with_article(name: str) -> str:
    """Return a name with "a" or "an" before it."""
    return f"{'an' if name[:1].upper() in 'AEIOU' else 'a'} {name}"
