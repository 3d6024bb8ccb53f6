"""What commands share is one thing for all of them."""

from __future__ import annotations

import pytest
import xarray as xr

from eigenwalker.cli import exit_codes
from eigenwalker.cli.exit_codes import EXIT_FAILED
from eigenwalker.cli.main import COMMANDS, load_command
from eigenwalker.cli.options import parse_trait_steps, progress_bar
from eigenwalker.simulation import simulate_population, simulate_walk


@pytest.mark.parametrize("text", ["sex", "sex=", "sex=much", "sex=nan", "sex=inf", "=3", ""])
def test_steps_along_a_trait_are_a_trait_and_a_finite_number(text):
    with pytest.raises(ValueError, match=r"sex=\+3"):
        parse_trait_steps(text)


def test_a_trait_may_name_its_two_classes():
    assert parse_trait_steps("style=feminine:masculine=-2") == ("style=feminine:masculine", -2)


TAKE_A_TRAIT = {
    "demo": ("--trait", "beauty"),
    "classify": ("--trait", "beauty"),
    "compare": ("people.nc", "--trait", "beauty"),
    "predict": ("people.nc", "people.nc", "--trait", "beauty"),
    "synthesize": ("--trait", "beauty=1"),
    "stimulus": ("--trait", "beauty=1"),
}


@pytest.mark.parametrize("command", TAKE_A_TRAIT)
def test_every_trait_that_is_not_there_is_named(command, run_command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    simulate_population(2, 2, seed=1).save("people.nc")
    code, _, errors = run_command(command, *TAKE_A_TRAIT[command])
    assert (code, "'beauty'" in errors) == (EXIT_FAILED, True)


@pytest.mark.parametrize(
    ("command", "option"),
    [("synthesize", "--trait"), ("stimulus", "--trait"), ("stimulus", "--morph-to")],
)
@pytest.mark.parametrize("number", ["nan", "inf", "much"])
def test_steps_that_lead_nowhere_are_refused_by_all(
    command, option, number, run_command, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    code, _, errors = run_command(command, option, f"sex={number}")
    assert code == EXIT_FAILED
    assert f"{option} 'sex={number}' does not say how far" in errors
    assert "invalid value" not in errors


def test_every_command_that_takes_a_trait_is_tested_here():
    taking = {
        name
        for name in COMMANDS
        for parameter in load_command(name).params
        if "--trait" in parameter.opts
    }
    assert taking == set(TAKE_A_TRAIT)


def test_options_are_shared_not_copied():
    """Options of one name have one help text, but for those that mean another thing."""
    helps = {}
    for name in COMMANDS:
        for parameter in load_command(name).params:
            helps.setdefault(parameter.opts[0], {})[name] = getattr(parameter, "help", None)
    for option in ("--unit", "--from", "--view", "--elevation", "--open"):
        assert len(set(helps[option].values())) == 1, helps[option]


def test_the_progress_bar_is_silent_off_a_terminal(capsys):
    with progress_bar("Working") as progress:
        progress(1, 2)
    assert capsys.readouterr() == ("", "")


def test_exit_codes_are_apart():
    assert (
        len({exit_codes.EXIT_PARTIAL, exit_codes.EXIT_FAILED, exit_codes.EXIT_INTERRUPTED, 0}) == 4
    )


def test_ways_out_that_a_message_names_are_options(run_command, write_c3d, tmp_path):
    walk = simulate_walk(seed=1, duration_s=4, markers="skin", rate_hz=60)
    names = walk.marker.values
    two = xr.concat(
        [walk.assign_coords(marker=[f"{who}:{name}" for name in names]) for who in ("Ann", "Ben")],
        "marker",
    )
    file = write_c3d(tmp_path / "two.c3d", two)
    file = file or tmp_path / "two.c3d"
    code, printed, errors = run_command("info", file)
    assert "--subject" in printed + errors
    code, printed, _ = run_command("info", file, "--subject", "Ann")
    assert code == 0
    assert "use" in printed.splitlines()[1]
