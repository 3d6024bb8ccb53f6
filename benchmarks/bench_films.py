"""Point-light films of stimuli, beside matplotlib's animation writers.

Ten seconds of 15 dots, 1920 x 1080 at 60 frames a second as MP4, and two seconds at 50 as GIF.
matplotlib moves one scatter over an empty figure; H.264 is encoded with the same preset and quality
for both. Where no ffmpeg program is found, matplotlib's frames go through the encoder that ours
take, which leaves out the pipe to ffmpeg and so is a little fast.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import av
import matplotlib as mpl
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from side_by_side import machine, print_table, seconds

import eigenwalker as ew
from eigenwalker.stimulus.drawing import places_px
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.write_stimulus import write_stimulus

WIDTH, HEIGHT, DPI = 1920, 1080, 100


class InProcessWriter(AbstractMovieWriter):
    """What FFMpegWriter does, without the pipe to another process."""

    def setup(self, fig: Figure, outfile: Any, dpi: float | None = None) -> None:  # noqa: D102 - as inherited
        super().setup(fig, outfile, dpi=dpi or DPI)
        self.film = av.open(str(outfile), "w")
        options = {"crf": "24", "preset": "ultrafast"}
        self.stream = self.film.add_stream("libx264", rate=Fraction(self.fps), options=options)
        self.stream.width, self.stream.height = WIDTH, HEIGHT
        self.stream.pix_fmt = "yuv420p"

    def grab_frame(self, **savefig: Any) -> None:  # noqa: D102 - as inherited
        canvas = FigureCanvasAgg(self.fig)
        canvas.draw()
        frame = av.VideoFrame.from_ndarray(np.asarray(canvas.buffer_rgba()), format="rgba")
        self.film.mux(self.stream.encode(frame))

    def finish(self) -> None:  # noqa: D102 - as inherited
        self.film.mux(self.stream.encode())
        self.film.close()


def ffmpeg() -> str | None:
    """The ffmpeg program, of the system or of imageio-ffmpeg."""
    if found := shutil.which("ffmpeg"):
        return found
    try:
        import imageio_ffmpeg
    except ImportError:
        return None
    return imageio_ffmpeg.get_ffmpeg_exe()


def with_matplotlib(stimulus: Stimulus, path: Path, writer: AbstractMovieWriter) -> None:
    """The same film by FuncAnimation."""
    figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI, facecolor="black")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, WIDTH), ylim=(HEIGHT, 0))
    axes.axis("off")
    places = places_px(stimulus, stimulus.play())
    points = stimulus.display.dot_px * 72 / DPI
    dots = axes.scatter(*places[0].T, s=points**2, c="white", lw=0)

    def move(frame: int) -> list[Any]:
        dots.set_offsets(places[frame])
        return [dots]

    film = FuncAnimation(figure, move, frames=len(places), blit=False)
    film.save(str(path), writer=writer, dpi=DPI, savefig_kwargs={"facecolor": "black"})


def assert_same_films(one: Path, other: Path, n_frames: int) -> None:
    """As many frames, and the light in the same places."""
    middles = []
    for path in (one, other):
        with av.open(str(path)) as film:
            frames = [f.to_ndarray(format="gray") for f in film.decode(video=0)]
        assert len(frames) == n_frames, (path, len(frames))
        rows, columns = np.nonzero(frames[n_frames // 2] > 128)
        middles.append([rows.mean(), columns.mean()])
    np.testing.assert_allclose(*middles, atol=2.0)


if __name__ == "__main__":
    people = ew.load_population()
    walker = people.walker(people.average)
    shown = make_stimulus(walker, duration_s=10, size_px=(WIDTH, HEIGHT))
    short = replace(shown, timing=replace(shown.timing, duration_s=2, rate_hz=50))
    program = ffmpeg()
    if program is None:
        how, mp4 = "matplotlib, encoder in the process", InProcessWriter(fps=60)
    else:
        mpl.rcParams["animation.ffmpeg_path"] = program
        how = "matplotlib, FFMpegWriter"
        mp4 = FFMpegWriter(fps=60, codec="h264", extra_args=["-preset", "ultrafast", "-crf", "24"])
    with TemporaryDirectory() as name:
        folder = Path(name)
        times = seconds(
            {
                how: lambda: with_matplotlib(shown, folder / "peer.mp4", mp4),
                "write_stimulus": lambda: write_stimulus(shown, folder / "ours.mp4"),
            },
            rounds=1,
        )
        assert_same_films(folder / "peer.mp4", folder / "ours.mp4", 600)
        print(machine())
        print_table("MP4, 10 s, 1920 x 1080, 60 frames/s", times, aims={"write_stimulus": 2})
        times = seconds(
            {
                "matplotlib, PillowWriter": lambda: with_matplotlib(
                    short, folder / "peer.gif", PillowWriter(fps=50)
                ),
                "write_stimulus": lambda: write_stimulus(short, folder / "ours.gif"),
            },
            rounds=1,
        )
        assert_same_films(folder / "peer.gif", folder / "ours.gif", 100)
        print_table("GIF, 2 s, 1920 x 1080, 50 frames/s", times, aims={"write_stimulus": 15})
