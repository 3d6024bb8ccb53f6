"""Films: decoded again and compared with what should be in them."""

from __future__ import annotations

import itertools

import av
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.plotting import encoding
from eigenwalker.plotting.layout import arrange, positions_at
from eigenwalker.plotting.raster import draw_discs, draw_lines, lettering
from eigenwalker.plotting.walker_films import write_film

THREE = ("head", "left_ankle", "right_ankle")


def three_dots(frequency_hz: float = 0.84, step: float = 250.0) -> Walker:
    p0 = [[0, 0, 1600], [0, 200, 100], [0, -200, 100]]
    p = [
        [[0, 40, 0], [step, 0, 0], [-step, 0, 0]],
        [[0, 0, 30], [0, 0, 60], [0, 0, 60]],
    ]
    return Walker(THREE, p0, p, [1, 2], [0, 0.7], frequency_hz, time_origin_s=2.3)


def decode(path):
    with av.open(str(path)) as film:
        frames = [frame.to_ndarray(format="gray") for frame in film.decode(video=0)]
        return np.stack(frames), film.duration / av.time_base


def gif_delays(path) -> list[int]:
    """Hundredths of a second in the graphic control extensions, read without any decoder."""
    data, delays = path.read_bytes(), []
    place = data.find(b"\x21\xf9\x04")
    while place >= 0:
        delays.append(int.from_bytes(data[place + 4 : place + 6], "little"))
        place = data.find(b"\x21\xf9\x04", place + 8)
    return delays


def centres(frame: np.ndarray, near: np.ndarray, reach: int = 8) -> np.ndarray:
    """Column and row of the light around each of the given places."""
    found = []
    for column, row in np.rint(near).astype(int):
        rows, columns = np.mgrid[row - reach : row + reach + 1, column - reach : column + reach + 1]
        light = frame[rows, columns].astype(float)
        light[light < 40] = 0
        found.append([(light * columns).sum() / light.sum(), (light * rows).sum() / light.sum()])
    return np.array(found)


@pytest.mark.parametrize("suffix", [".mp4", ".webm", ".gif"])
def test_a_film_has_the_duration_and_size_that_were_asked(tmp_path, suffix):
    path = write_film(three_dots(), tmp_path / f"walk{suffix}", duration_s=1.5, size_px=(201, 300))
    frames, duration = decode(path)
    assert frames.shape == (75 if suffix == ".gif" else 90, 300, 202)
    assert duration == pytest.approx(1.5, abs=0.02)


@pytest.mark.parametrize("suffix", [".mp4", ".gif"])
@pytest.mark.parametrize("azimuth_deg", [0, 30, -90])
def test_dots_are_within_half_a_pixel_of_where_the_walker_is(tmp_path, suffix, azimuth_deg):
    walker = three_dots()
    path = write_film(
        walker, tmp_path / f"walk{suffix}", duration_s=1, azimuth_deg=azimuth_deg, rate_hz=25
    )
    frames, _ = decode(path)
    scene = arrange(
        [positions_at(walker, walker.time_origin_s + np.arange(25) / 25)],
        azimuth_deg=azimuth_deg,
        elevation_deg=0,
        eye_distance_mm=None,
        style="dots",
        size_px=512,
        titles=(),
    )
    for moment in (0, 7, 24):
        expected = scene.places[0][moment]
        apart = np.linalg.norm(expected[:, None] - expected, axis=-1) + 99 * np.eye(3)
        alone = apart.min(axis=1) > 22
        found = centres(frames[moment], expected[alone])
        assert np.abs(found - expected[alone]).max() < 0.5


def test_the_scale_is_in_the_picture_as_well(tmp_path):
    """Known truth from outside the staging: the ankles are 400 mm apart, the head 1500 above."""
    still = Walker(THREE, three_dots().p0, np.zeros((1, 3, 3)), [1], [0], 1.0)
    frames, _ = decode(write_film(still, tmp_path / "still.gif", duration_s=0.1, azimuth_deg=0))
    rows, columns = np.nonzero(frames[0] > 127)
    head, ankles = columns[rows < 256], columns[rows > 256]
    left, right = ankles[ankles > ankles.mean()], ankles[ankles < ankles.mean()]
    tall = rows[rows > 256].mean() - rows[rows < 256].mean()
    assert (left.mean() - right.mean()) / tall == pytest.approx(400 / 1500, abs=0.003)
    assert head.mean() == pytest.approx(ankles.mean(), abs=0.5)


@pytest.mark.parametrize(("rate_hz", "delay"), [(50, 2), (25, 4), (20, 5)])
def test_a_gif_lasts_as_long_as_the_walk(tmp_path, rate_hz, delay):
    path = write_film(three_dots(), tmp_path / "w.gif", duration_s=4, rate_hz=rate_hz, size_px=64)
    assert gif_delays(path) == [delay] * (4 * rate_hz)


@given(st.floats(0.4, 1.6), st.integers(1, 3), st.sampled_from([50, 25, 20]))
@settings(max_examples=15, deadline=None)
def test_a_gif_of_whole_strides_keeps_the_tempo_to_a_hundredth_of_a_second(
    tmp_path_factory, frequency_hz, n_strides, rate_hz
):
    path = tmp_path_factory.mktemp("gif") / "w.gif"
    write_film(three_dots(frequency_hz), path, n_strides=n_strides, rate_hz=rate_hz, size_px=32)
    delays = gif_delays(path)
    assert abs(sum(delays) - 100 * n_strides / frequency_hz) <= 0.5 + 1e-9
    assert min(delays) >= encoding.CENTISECONDS[rate_hz]


@pytest.mark.parametrize("suffix", [".mp4", ".gif"])
def test_a_film_of_whole_strides_repeats_without_a_seam(tmp_path, suffix):
    path = write_film(three_dots(0.93), tmp_path / f"w{suffix}", n_strides=1, azimuth_deg=90)
    frames, duration = decode(path)
    assert duration == pytest.approx(1 / 0.93, abs=0.006)
    dark = frames.astype(float)
    steps = np.abs(np.diff(dark, axis=0)).sum(axis=(1, 2))
    seam = np.abs(dark[0] - dark[-1]).sum()
    assert steps.min() * 0.8 < seam < steps.max() * 1.2


def test_walkers_of_different_tempo_keep_step_over_whole_strides(tmp_path):
    slow, fast = three_dots(0.7), three_dots(1.1)
    frames, duration = decode(
        write_film([slow, fast], tmp_path / "w.gif", n_strides=2, size_px=(400, 300))
    )
    assert duration == pytest.approx(2 / 0.9, abs=0.01)
    assert np.abs(frames[:, :, :200].astype(int) - frames[:, :, 200:]).max() <= 1


def test_walkers_side_by_side_have_one_scale_and_stay_in_their_panels():
    small = Walker(THREE, 0.5 * three_dots().p0, 0.5 * three_dots().p, [1, 2], [0, 0], 1.0)
    giant = Walker(THREE, 3 * three_dots().p0, 6 * three_dots().p, [1, 2], [0, 0], 1.0)
    seconds = np.linspace(0, 1, 40)
    scene = arrange(
        [positions_at(walker, seconds) for walker in (small, giant)],
        azimuth_deg=90,
        elevation_deg=0,
        eye_distance_mm=None,
        style="sticks",
        size_px=(600, 300),
        titles=("small", "giant"),
    )
    heights = [np.ptp(places[..., 1], axis=1).max() for places in scene.places]
    assert heights[1] / heights[0] > 5.5
    for index, places in enumerate(scene.places):
        assert places[..., 0].min() > 300 * index
        assert places[..., 0].max() < 300 * (index + 1)
        assert places[..., 1].min() > 0
        assert places[..., 1].max() < 300


@given(st.floats(-6, 6), st.sampled_from([0, 30, 90, 200]), st.sampled_from(["dots", "sticks"]))
@settings(max_examples=20, deadline=None)
def test_nothing_is_drawn_at_the_border_however_large_the_step(alpha, azimuth_deg, style):
    walker = three_dots(step=250 + 150 * alpha)
    scene = arrange(
        [positions_at(walker, np.linspace(0, 1.19, 12))],
        azimuth_deg=azimuth_deg,
        elevation_deg=10,
        eye_distance_mm=None,
        style=style,
        size_px=128,
        titles=(),
    )
    for cover in itertools.islice(scene.frames(), 12):
        border = [cover[0], cover[-1], cover[:, 0], cover[:, -1]]
        assert max(edge.max() for edge in border) == 0


def test_a_capture_plays_on_its_own_clock_and_gaps_are_not_drawn(tmp_path):
    values = np.zeros((11, 2, 3))
    values[:, 0] = np.linspace([0, 0, 0], [0, 0, 500], 11)
    values[:, 1] = [0, 400, 0]
    values[5:, 1] = np.nan
    walk = label_trajectories(values, markers=["a", "b"], rate_hz=10, start_s=7)
    frames, duration = decode(write_film(walk, tmp_path / "w.gif", rate_hz=20, azimuth_deg=0))
    assert duration == pytest.approx(1.0)
    right_half = frames[..., frames.shape[2] // 2 :].max(axis=(1, 2))
    assert (right_half[:8] > 200).all()
    assert (right_half[10:] < 20).all()


def test_a_walker_beside_a_capture_plays_on_the_clock_of_the_capture(tmp_path):
    walker = three_dots()
    capture = walker.trajectories(7.3 + np.arange(61) / 60)
    path = write_film([capture, walker], tmp_path / "w.gif", duration_s=0.9, size_px=(400, 300))
    frames, _ = decode(path)
    assert np.abs(frames[:, :, :200].astype(int) - frames[:, :, 200:]).max() <= 12


def test_a_film_longer_than_the_capture_is_refused(tmp_path):
    walk = label_trajectories(np.zeros((11, 1, 3)), markers=["a"], rate_hz=10)
    with pytest.raises(ValueError, match=r"lasts 1\.000 s, and the film asks for"):
        write_film(walk, tmp_path / "w.mp4", duration_s=2)


def test_black_on_white_is_white_on_black_the_other_way_round(tmp_path):
    dark, _ = decode(write_film(three_dots(), tmp_path / "d.gif", duration_s=0.1))
    light, _ = decode(
        write_film(three_dots(), tmp_path / "l.gif", duration_s=0.1, background="light")
    )
    assert (light[dark == 0] == 255).all()
    assert (light[dark == 255] == 25).all()


def test_titles_stand_over_their_walkers(tmp_path):
    path = write_film(
        [three_dots()] * 2, tmp_path / "t.gif", duration_s=0.1, titles=["$women", "+6 SD"]
    )
    frames, _ = decode(path)
    head = frames[0, :40]
    middle = head.shape[1] // 2
    assert (head[:, :middle] > 90).sum() > 50
    assert (head[:, middle:] > 90).sum() > 50


def test_the_hook_hears_of_every_frame(tmp_path):
    heard = []
    write_film(
        three_dots(), tmp_path / "w.gif", duration_s=0.2, progress=lambda *how: heard.append(how)
    )
    assert heard == [(frame, 10) for frame in range(1, 11)]


def test_titles_may_be_in_any_script(tmp_path):
    path = write_film(three_dots(), tmp_path / "t.gif", duration_s=0.1, titles=["\u6b69\u304f"])
    assert (decode(path)[0][0, :40] > 90).sum() > 20


def test_a_capture_of_which_nothing_was_seen_is_refused(tmp_path):
    walk = label_trajectories(np.full((11, 1, 3), np.nan), markers=["a"], rate_hz=10)
    with pytest.raises(ValueError, match="no samples at all"):
        write_film(walk, tmp_path / "w.mp4")


def test_a_film_that_breaks_off_leaves_what_was_there_and_nothing_else(tmp_path):
    path = tmp_path / "w.mp4"
    path.write_bytes(b"before")

    def stop(done, _):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_film(three_dots(), path, duration_s=1, size_px=64, progress=stop)
    assert [file.name for file in tmp_path.iterdir()] == ["w.mp4"]
    assert path.read_bytes() == b"before"


@pytest.mark.parametrize(
    ("name", "choices", "words"),
    [
        ("w.avi", {}, r"must end in one of \['.gif', '.mp4', '.webm'\]"),
        ("w.gif", {"rate_hz": 30}, r"choose one of \[20, 25, 50\]"),
        ("w.mp4", {"rate_hz": 0}, "rate_hz=0"),
        ("w.mp4", {"duration_s": -1}, "duration_s=-1"),
        ("w.mp4", {"duration_s": 2, "n_strides": 2}, "give one"),
        ("w.mp4", {"n_strides": 0}, "1 or more"),
        ("w.mp4", {"style": "cartoon"}, "style='cartoon' is none of"),
        ("w.mp4", {"background": "pink"}, "background='pink' is none of"),
        ("w.mp4", {"titles": ["a", "b"]}, "2 titles for 1 walkers"),
        ("w.mp4", {"size_px": 8}, "too small"),
        ("w.mp4", {"size_px": (8, 400)}, "too small"),
    ],
)
def test_choices_that_make_no_film_are_refused_in_words(tmp_path, name, choices, words):
    with pytest.raises(ValueError, match=words):
        write_film(three_dots(), tmp_path / name, **choices)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_does_not_exist_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        write_film(three_dots(), tmp_path / "nowhere" / "w.mp4")


@given(st.floats(8, 24), st.floats(8, 24), st.floats(2, 6))
def test_a_disc_has_its_place_and_its_area(column, row, radius):
    canvas = np.zeros((33, 33), np.uint8)
    draw_discs(canvas, np.array([[column, row]]), radius=radius)
    rows, columns = np.mgrid[:33, :33]
    place = [(canvas * grid).sum() / canvas.sum() for grid in (columns, rows)]
    np.testing.assert_allclose(place, [column, row], atol=0.06)
    assert canvas.sum() / 255 == pytest.approx(np.pi * radius**2, rel=0.1)


@given(st.floats(-20, 50), st.floats(-20, 50), st.floats(-20, 50), st.floats(-20, 50))
def test_what_reaches_over_the_border_is_cut(x0, y0, x1, y1):
    small, large = np.zeros((30, 30), np.uint8), np.zeros((130, 130), np.uint8)
    draw_lines(small, np.array([[x0, y0]]), np.array([[x1, y1]]), width=3)
    draw_lines(large, np.array([[x0 + 50, y0 + 50]]), np.array([[x1 + 50, y1 + 50]]), width=3)
    draw_discs(small, np.array([[x0, y0]]), radius=4)
    draw_discs(large, np.array([[x0 + 50, y0 + 50]]), radius=4)
    assert np.abs(small.astype(int) - large[50:80, 50:80]).max() <= 1


def test_long_words_are_set_smaller_until_they_fit():
    canvas = lettering("a title that is much too long for its panel", width=120, height=20)
    assert canvas.shape == (20, 120)
    assert canvas[:, :2].max() == 0
    assert canvas[:, -2:].max() == 0
    assert canvas.max() > 128


def test_all_joints_are_drawn_as_a_stick_figure(tmp_path):
    p0 = np.random.default_rng(0).normal(0, 400, (15, 3))
    walker = Walker(JOINTS.markers, p0, np.zeros((1, 15, 3)), [1], [0], 1.0)
    frames, _ = decode(write_film(walker, tmp_path / "w.gif", duration_s=0.1, style="sticks"))
    assert 0.01 < (frames[0] > 100).mean() < 0.5
