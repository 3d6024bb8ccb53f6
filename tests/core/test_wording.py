"""Arguments of Python in the words of another way into the program."""

import pytest

from eigenwalker.core.wording import reworded

OPTIONS = {"unit": "--unit {value}", "size_px": "--size {value}", "rate_hz": "--rate {value}"}


@pytest.mark.parametrize(("sentence", "expected"), [
    ("unit='a\\'\"b' is not known", "--unit a'\"b is not known"),
    ("size_px=(0, 9) is small", "--size (0, 9) is small"),
    ("rate_hz=-1.5e-05 is none", "--rate -1.5e-05 is none"),
    ("expected 'rate_hz=30' in the file", "expected 'rate_hz=30' in the file"),
    ("frame_rate_hz=3 is another word", "frame_rate_hz=3 is another word"),
])  # fmt: skip
def test_values_come_through_whatever_they_hold(sentence, expected):
    assert reworded(sentence, OPTIONS) == expected
