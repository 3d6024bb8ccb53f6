"""No command replaces an input, or a file that it did not make."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from eigenwalker.cli.main import COMMANDS, load_command, main
from eigenwalker.cli.outputs import MORE_OUTPUTS, NOT_GUARDED, OUTPUT, guarded


def write_copy(capture: Path, output: Path, text: str = "made") -> None:
    """Stand for a command that reads a file and writes a file."""
    output.write_text(text)


def write_report(folder: Path | None = None, output: Path = Path("report")) -> None:
    """Stand for a command that writes a folder."""
    output.mkdir(exist_ok=True)
    (output / "index.html").write_text("made")


@pytest.fixture
def copy():
    return guarded(write_copy, "convert")


@pytest.fixture
def source(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("a.c3d").write_text("raw")
    return tmp_path


@pytest.mark.parametrize("name", ["a.c3d", "./a.c3d", "sub/../a.c3d", "soft.c3d", "hard.c3d"])
def test_an_input_is_not_replaced_by_any_spelling(source, copy, name):
    Path("sub").mkdir()
    os.symlink("a.c3d", "soft.c3d")
    os.link("a.c3d", "hard.c3d")
    with pytest.raises(ValueError, match=r"is read by this command.*--force"):
        copy(capture=Path("a.c3d"), output=Path(name))
    assert Path("a.c3d").read_text() == "raw"
    copy(capture=Path("a.c3d"), output=Path(name), force=True)
    assert Path("a.c3d").read_text() == "made"


def test_an_output_is_replaced_by_the_command_that_made_it_alone(source, copy):
    mine = Path("mine.trc")
    mine.write_text("by hand")
    with pytest.raises(ValueError, match=r"not made by eigenwalker convert"):
        copy(capture=Path("a.c3d"), output=mine)
    for text in ("first", "second"):
        copy(capture=Path("a.c3d"), output=Path("b.trc"), text=text)
        assert Path("b.trc").read_text() == text
    with pytest.raises(ValueError, match=r"not made by eigenwalker fit"):
        guarded(write_copy, "fit")(capture=Path("a.c3d"), output=Path("b.trc"))
    Path("b.trc").write_text("edited by hand")
    with pytest.raises(ValueError, match=r"changed since"):
        copy(capture=Path("a.c3d"), output=Path("b.trc"))
    copy(capture=Path("a.c3d"), output=Path("b.trc"), force=True)
    copy(capture=Path("a.c3d"), output=Path("b.trc"))


def test_a_folder_that_holds_other_files_is_not_written_into(source):
    report = guarded(write_report, "classify")
    report(output=Path("new"))
    report(output=Path("new"))
    Path("new/notes.txt").write_text("mine")
    with pytest.raises(ValueError, match=r"did not make.*notes.txt"):
        report(output=Path("new"))
    report(output=Path("new"), force=True)
    assert Path("new/notes.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("name", "output", "beside"),
    [
        ("parameters", "a.csv", ["a-persons.csv", "a-codebook.csv", "a.json", "a.html", "a.pdf"]),
        ("predict", "a.csv", ["a.json"]),
        ("stimulus", "a.py", ["a.npz"]),
        ("synthesize", "a.PY", ["a.npz"]),
    ],
)
def test_files_beside_an_output_are_guarded_as_it_is(source, name, output, beside):
    def write(capture: Path | None = None, output: Path | None = None) -> None:
        for each in (output, *beside):
            Path(each).write_text("made")

    command = guarded(write, name)
    for each in beside:
        Path(each).write_text("mine")
        with pytest.raises(ValueError, match=rf"{each} is there, and was not made by"):
            command(output=Path(output))
        assert Path(each).read_text() == "mine"
        Path(each).unlink()
    command(output=Path(output))
    command(output=Path(output))
    with pytest.raises(ValueError, match="is read by this command"):
        command(capture=Path(beside[0]), output=Path(output))


def test_pictures_of_an_earlier_call_do_not_stay_among_the_new(source):
    def write(number: int = 3, output: Path = Path("out"), name: str = "frame") -> None:
        output.mkdir(exist_ok=True)
        for index in range(number):
            (output / f"{name}_{index}.png").write_text(f"{number}")

    stimulus = guarded(write, "stimulus")
    Path("new").mkdir()
    stimulus(number=3, output=Path("new"), name="set")
    stimulus(number=12, output=Path("new"))
    Path("new/frame_99.png").write_text("mine")
    stimulus(number=2, output=Path("new"), force=True)
    names = {path.name for path in Path("new").glob("*.png")}
    assert names == {"set_0.png", "set_1.png", "set_2.png", "frame_0.png", "frame_1.png",
                     "frame_99.png"}  # fmt: skip


def test_a_record_that_is_damaged_makes_nothing_ones_own(source, copy):
    copy(capture=Path("a.c3d"), output=Path("b.trc"))
    for content in ("{", "[]", '{"b.trc": 3}', "[" * 100_000):
        Path(".eigenwalker").write_text(content)
        with pytest.raises(ValueError, match=r"not made by"):
            copy(capture=Path("a.c3d"), output=Path("b.trc"))


def _commands():
    for name in COMMANDS:
        command = load_command(name)
        yield from getattr(command, "commands", {name: command}).items()


def test_every_command_that_writes_is_guarded():
    writing = {
        name: {parameter.name for parameter in command.params}
        for name, command in _commands()
        if {parameter.name for parameter in command.params} & {OUTPUT, MORE_OUTPUTS.get(name)}
    }
    assert {"convert", "fit", "simulate", "classify", "compare", "demo", "stimulus"} <= set(writing)
    assert {name for name, has in writing.items() if "force" not in has} <= {*NOT_GUARDED, "fetch"}
    typed = {option for _, command in _commands() for each in command.params for option in each.opts
             if each.name != OUTPUT}  # fmt: skip
    assert not typed & {"-o", "--output"}


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["convert", "{c}", "{c}"], "is read by this command"),
        (["fit", "{folder}", "-o", "{folder}/x.nc", "--traits", "{t}", "--table", "{t}"],
         "is read"),
        (["stimulus", "-o", "stim"], r"has no suffix; name a file that ends in .*\.json"),
        (["stimulus", "-o", ""], "expected a value, got nothing"),
        (["stimulus", "-o", "."], r"names no file to write"),
        (["stimulus", "-o", "{t}"], "not made by eigenwalker stimulus"),
        (["synthesize", "-o", "{t}"], "not made by eigenwalker stimulus"),
        (["simulate", "-o", "{c}"], "not made by eigenwalker simulate"),
        (["simulate", "-o", "{folder}/x.nc", "--captures", "{folder}"], "holds files"),
        (["classify", "-o", "{folder}"], "holds files"),
        (["demo", "-o", "{folder}", "--no-open"], "holds files"),
        (["compare", "{c}", "{c}", "-o", "{folder}"], "holds files"),
        (["info", "{c}", "--write-mapping", "{t}"], "not made by eigenwalker info"),
        (["stimulus", "--conditions", "{t}", "-o", "{folder}"], "holds files"),
        (["stimulus", "--conditions", "{t}", "-o", "{t}"], "expected a folder .* is a file"),
        (["stimulus", "--crowd", "2", "-o", "{folder}"], "holds files"),
        (["stimulus", "-o", "{folder}/a.py"], "a.npz is there, and was not made"),
        (["predict", "{c}", "{c}", "-o", "{folder}/a.csv"], "a.json is there, and was not made"),
        (["simulate", "-o", "{folder}/x.nc", "--captures", "{t}"], "expected a folder"),
        (["plugin", "-o", "{t}/below"], "expected a folder"),
    ],
)  # fmt: skip
def test_nothing_is_lost(tmp_path, monkeypatch, capsys, command, said):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "folder"
    folder.mkdir()
    capture, traits = folder / "a.c3d", folder / "t.csv"
    capture.write_bytes(b"raw")
    traits.write_text("file,sex\na.c3d,f\n")
    places = {"c": capture, "t": traits, "folder": folder}
    for beside in ("a.npz", "a.json"):
        (folder / beside).write_text("mine")
    before = {path: path.read_bytes() for path in folder.iterdir()}
    words = [word.format(**places) for word in command]
    monkeypatch.setattr("sys.argv", ["eigenwalker", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert re.search(said, capsys.readouterr().err.replace("\n", " "))
    assert {path: path.read_bytes() for path in folder.iterdir()} == before
    assert list(tmp_path.iterdir()) == [folder]
