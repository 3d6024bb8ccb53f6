"""The walker in a notebook: set by Python, read back, and what a browser makes of it."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import eigenwalker as ew
from eigenwalker.explorer.interactive_page import built
from eigenwalker.stimulus.stimulus import Stimulus

traitlets = pytest.importorskip("traitlets", reason="anywidget is not installed")
pytest.importorskip("anywidget", reason="anywidget is not installed")

from eigenwalker.explorer.widget import WalkerWidget, show  # noqa: E402 - needs anywidget


@pytest.fixture(scope="module")
def people() -> ew.Population:
    return ew.simulate_population(6, 6, seed=1)


def test_setting_traits_moves_the_walker(people):
    widget = show(people, keep_size=True)
    widget.alpha = {"sex": 2, "weight_kg": -1}
    vector = people.average + 2 * ew.trait_axis(people, "sex").step
    vector -= ew.trait_axis(people, "weight").step
    np.testing.assert_allclose(widget.vector, vector, atol=1e-5)
    assert widget.walker.frequency_hz == pytest.approx(people.walker(vector).frequency_hz)


def test_everything_chosen_makes_the_walker(people):
    widget = show(
        people, keep_size=True, start=4, part="structure", kind="mean_difference", alpha={"sex": 3}
    )
    axis = ew.trait_axis(people, "sex", part="structure", kind="mean_difference")
    np.testing.assert_allclose(widget.vector, people.X[4] + 3 * axis.step, atol=1e-5)
    widget.strengths = [0, 1, 1, 1]
    assert not widget.walker.p[0].any()


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"alpha": {"sex": 99}}, "sex is 99; give a number from -6 to 6"),
        ({"alpha": {"sex": -6.01}}, "sex is -6.01; give"),
        ({"bias": {"trait": "sex", "steps": 4}}, "The bias towards sex is 4; give .* -3 to 3"),
        ({"eigenwalkers": [0, 7]}, "Eigenwalker 2 is 7; give .* -6 to 6"),
        ({"strengths": [3]}, "The strength of component 1 is 3; give .* -2 to 2"),
    ],
)
def test_numbers_beyond_the_sliders_are_refused(people, chosen, said):
    widget = show(people)
    before = widget.vector
    (name, value), *_ = chosen.items()
    with pytest.raises(traitlets.TraitError, match=said):
        setattr(widget, name, value)
    np.testing.assert_array_equal(widget.vector, before)


def test_ones_own_walker_moves_along_traits_of_a_population(people):
    other = people.walkers[9]
    rest = people.drop([9])
    widget = show(other, population=rest, alpha={"sex": -1}, keep_size=True)
    step = ew.trait_axis(rest, "sex").step
    np.testing.assert_allclose(widget.vector, rest.vector(other) - step, atol=1e-5)


def test_size_is_divided_out_until_it_is_kept(people):
    """Troje (2002), eq. 12, as on the page: the slider of sex makes nobody small."""
    widget = show(people, alpha={"sex": 2})
    for shown, keep in ((people.size_normalised(), False), (people, True)):
        widget.keep_size = keep
        expected = shown.average + 2 * ew.trait_axis(shown, "sex").step
        np.testing.assert_allclose(widget.vector, expected, atol=1e-5)


def test_ones_own_walker_has_the_size_of_the_average_until_it_is_kept(people):
    one = people.walkers[2]
    tall = replace(one, p0=1.2 * one.p0, p=1.2 * one.p)
    widget = show(tall, population=people)
    average = people.size_normalised().average[:45]
    assert widget.vector[:45] @ average == pytest.approx(average @ average, rel=1e-6)
    widget.keep_size = True
    np.testing.assert_allclose(widget.vector, people.vector(tall), atol=1e-5)


def test_a_walker_alone_is_shown_as_it_is():
    hop = ew.Walker(["foot", "toe"], [[0, 0, 50], [9, 0, 1]], [[[0, 0, 40]] * 2], [1], [0], 1.0)
    widget = show(hop, strengths=[2])
    time = np.linspace(0, 1, 20)
    doubled = ew.Walker(hop.markers, hop.p0, 2 * hop.p, [1], [0], 1.0)
    np.testing.assert_allclose(
        widget.walker.trajectories(time).values, doubled.trajectories(time).values, atol=1e-5
    )


def test_what_is_shown_is_a_stimulus(people):
    widget = show(people, azimuth_deg=90, style="sticks", dark=False)
    shown = widget.stimulus
    assert (shown.view.view_deg, shown.display.style, shown.display.background) == (
        90,
        "sticks",
        "#ffffff",
    )


def test_a_stimulus_is_shown_as_it_is(people):
    shown = ew.make_stimulus(people.walkers[0], duration_s=1).then("invert")
    widget = show(shown)
    assert isinstance(widget.stimulus, Stimulus)
    assert widget.stimulus.to_json() == shown.to_json()
    with pytest.raises(ValueError, match="A stimulus is shown"):
        _ = widget.walker


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("alpha", {"shoe": 1}, "no trait 'shoe'"),
        ("alpha", {"sex": "much"}, "float"),
        ("alpha", {"sex": float("nan")}, "not finite"),
        ("start", 40, "0 to 11"),
        ("start", "own", "no walker 'own'"),
        ("part", "p9", None),
        ("bias", {"trait": "age_years", "steps": 1}, "no two classes"),
        ("strengths", [1] * 9, "9 strengths"),
        ("style", "stick", "stick"),
        ("elevation_deg", 100.0, "90"),
    ],
)
def test_what_cannot_be_shown_is_refused(people, name, value, said):
    widget = show(people, alpha={"sex": 1})
    with pytest.raises(traitlets.TraitError, match=said):
        setattr(widget, name, value)
    assert widget.alpha == {"sex": 1}


def test_unknown_options_and_things_are_refused(people):
    with pytest.raises(ValueError, match="no \\['colour'\\]"):
        show(people, colour="red")
    with pytest.raises(ValueError, match="got str"):
        show("people.nc")


def test_the_lines_of_the_documentation_run(people, tmp_path, monkeypatch):
    page = (Path(__file__).parents[2] / "docs" / "interactive.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names = {"people": people}
    for lines in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(lines, names)
    assert (tmp_path / "walkers.html").stat().st_size > 300_000


def test_without_anywidget_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "eigenwalker.explorer.widget")
    with pytest.raises(ImportError, match=r"pip install 'eigenwalker\[notebook\]'"):
        import eigenwalker.explorer.widget  # noqa: F401


def test_the_mannequin_is_sent_when_it_is_asked_for(people, monkeypatch):
    sent = []
    monkeypatch.setattr(WalkerWidget, "send", lambda _, message: sent.append(message))
    widget = show(people)
    widget._handle_custom_msg({"wants": "everything"}, [])
    widget._handle_custom_msg({"wants": "mannequin"}, [])
    assert sent == [{"mannequin": built("mannequin.js")}]


HARNESS = """<!doctype html><body style="width:640px"><div id="here"></div>
<script type="application/json" id="values">VALUES</script>
<script type="module">
const script = SCRIPT;
const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
const { default: widget } = await import(address);
const values = JSON.parse(document.getElementById("values").textContent);
const heard = {};
const tell = (event, message) => (heard[event] ?? []).forEach((hears) => hears(message));
window.saved = {};
window.model = {
  get: (name) => values[name],
  set: (name, value) => {
    values[name] = value;
    window.unsaved = { ...window.unsaved, [name]: value };
    tell(`change:${name}`);
  },
  save_changes: () => { Object.assign(window.saved, window.unsaved); window.unsaved = {}; },
  on: (event, hears) => (heard[event] ??= []).push(hears),
  hear: (message) => tell("msg:custom", message),
  off: (event, hears) => (heard[event] = (heard[event] ?? []).filter((each) => each !== hears)),
  send: (message) => (window.sent = message),
};
window.end = widget.render({ model: window.model, el: document.getElementById("here") });
window.ready = true;
</script>
"""


def harness(widget: WalkerWidget) -> str:
    """A page that does for the widget what a notebook does."""
    kinds = dict | list | str | int | float | bool | None
    names = [name for name in widget.trait_names(sync=True) if name not in ("_esm", "layout")]
    values = {name: getattr(widget, name) for name in names}
    kept = {name: value for name, value in values.items() if isinstance(value, kinds)}
    script = json.dumps(built("widget.js")).replace("</", "<\\/")
    return HARNESS.replace("VALUES", json.dumps(kept).replace("<", "\\u003c")).replace(
        "SCRIPT", script
    )


def opened(browser, widget: WalkerWidget, folder: Path):
    """The widget in a browser; whatever goes wrong there fails the test that looks at it."""
    path = folder / "notebook.html"
    path.write_text(harness(widget), encoding="utf-8")
    page = browser.new_page()
    page.set_default_timeout(20_000)
    page.on("pageerror", lambda error: pytest.fail(str(error)))
    page.goto(path.as_uri())
    page.wait_for_function("window.ready")
    return page


LIGHT = """() => {
  const canvas = document.querySelector("#here").shadowRoot.querySelector("canvas");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let light = 0;
  for (let i = 0; i < data.length; i += 4) light += data[i] > 200;
  return light;
}"""


def test_hand_and_python_move_the_same_walker(people, browser, tmp_path):
    page = opened(browser, show(people, playing=False), tmp_path)
    page.wait_for_function(f"({LIGHT})() > 100")
    slider = page.get_by_label("sex: from woman to man")
    slider.press("Home")
    page.wait_for_function("window.saved.alpha?.sex === -6")
    page.evaluate("window.model.set('alpha', { sex: 2.5 })")
    page.wait_for_function(
        "document.querySelector('#here').shadowRoot.querySelector('input').value === '2.5'"
    )
    page.get_by_role("button", name="Back to average").click()
    page.wait_for_function("Object.keys(window.saved.alpha).length === 0")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("window.saved.playing === true")
    page.close()


def test_the_switch_for_size_is_read_in_python_and_set_by_it(people, browser, tmp_path):
    page = opened(browser, show(people, playing=False, alpha={"sex": -6}), tmp_path)
    switch = page.get_by_label("Keep people's size")
    assert not switch.is_checked()
    switch.check()
    page.wait_for_function("window.saved.keep_size === true")
    page.evaluate("window.model.set('keep_size', false)")
    page.wait_for_function(
        "!document.querySelector('#here').shadowRoot.querySelector('[type=checkbox]').checked"
    )
    page.close()


def test_dragging_turns_the_walker_and_python_hears_of_it(people, browser, tmp_path):
    page = opened(browser, show(people, playing=False), tmp_path)
    page.wait_for_function(f"({LIGHT})() > 100")
    page.mouse.move(200, 150)
    page.mouse.down()
    page.mouse.move(300, 150, steps=4)
    page.mouse.up()
    page.wait_for_function("Math.abs(window.saved.azimuth_deg - 30) >= 45")
    page.close()


def test_the_mannequin_is_drawn_once_its_module_is_there(people, browser, tmp_path):
    page = opened(browser, show(people, playing=False), tmp_path)
    page.wait_for_function(f"({LIGHT})() > 100")
    dots = page.evaluate(LIGHT)
    page.evaluate("window.model.set('style', 'mannequin')")
    page.wait_for_function("window.sent?.wants === 'mannequin'")
    page.evaluate("(text) => window.model.hear({ mannequin: text })", built("mannequin.js"))
    page.wait_for_function(f"({LIGHT})() > {2 * dots}")
    page.close()


def test_a_stimulus_plays_and_what_is_none_is_said(people, browser, tmp_path):
    shown = ew.make_stimulus(people.walkers[0], duration_s=1)
    page = opened(browser, show(shown), tmp_path)
    page.wait_for_function(f"({LIGHT})() > 100")
    page.get_by_role("button", name="Pause").click()
    page.wait_for_function("window.saved.playing === false")
    page.evaluate("window.end()")
    page.close()
    broken = opened(browser, WalkerWidget(_stimulus={"format": "odd"}), tmp_path)
    assert "stimulus.format" in broken.get_by_role("alert").inner_text()
    broken.close()
