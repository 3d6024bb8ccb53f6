"""Your own capture beside the walker that the model makes of it.

    python examples/plot_own_capture.py capture.c3d

Left, what was recorded, in place; right, a mean posture with four others on sines. What is
missing at the right is noise, and what a person does only once. Without a file it rehearses with
a simulated one.
"""

import sys

import eigenwalker as ew

if len(sys.argv) > 1:
    capture = ew.virtual_markers(ew.read_mocap(sys.argv[1]))
else:
    capture = ew.simulate_walk(seed=7, noise_mm=3)

walk = ew.in_place(capture)
walker = ew.decompose_fourier(walk)
lasts_s = float(walk.time[-1] - walk.time[0])
ew.plotting.write_film(
    [walk, walker],
    "own_capture.mp4",
    duration_s=min(lasts_s, 5),
    azimuth_deg=90,
    style="sticks",
    titles=["capture", f"R² {walker.fit.r2:.2f}"],
)
