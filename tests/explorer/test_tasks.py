"""What the server says of files that were sent: by their own names, without its folders."""

import json

import pytest

from eigenwalker.explorer import tasks


@pytest.mark.parametrize(("files", "said"), [
    ({"a.c3d": b"", "traits.csv": bytes(range(256))}, "The traits table traits.csv could not"),
    ({"a.c3d": b"", "names.toml": b"a = "}, "The mapping names.toml is no TOML"),
    ({"notes.bin": b"\0"}, "There are no captures"),
])  # fmt: skip
def test_files_keep_their_names_and_folders_are_not_told(tmp_path, files, said):
    for name, content in files.items():
        (tasks.files_of(tmp_path) / name).write_bytes(content)
    settings = {"files": list(files), "unit": None, "rate_hz": None, "mapping": None}
    (tmp_path / tasks.SETTINGS).write_text(json.dumps(settings))
    with pytest.raises(ValueError, match=said) as caught:
        tasks.study(str(tmp_path))
    assert str(tmp_path) not in str(caught.value)
