# SPDX-License-Identifier: Apache-2.0
"""Measures the error of the filtered surface against the filter's radius on a noisy hand wheel, and draws it.

filter_error.py OUT.png
"""

import sys

import fathom
import matplotlib
import numpy
import wheel

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

NOISE = 0.001  # [m] standard deviation of depth


def spheres(text, noise, seed=1):
    """Centres of the wheel's spheres, and the time of the frame on the compute device [ms]."""
    run = fathom.Lockstep(fathom.Scene.from_text(text), wheel.camera())
    times = [run.process(*wheel.frame(noise, seed + i), stamp=i + 1).compute for i in range(9)]
    return run.regions().centres.copy(), 1000 * numpy.median(times)


clean, _ = spheres(wheel.SCENE.replace("radius: 2, sigma", "radius: 0, sigma"), 0.0)
radii, errors, milliseconds = [0, 1, 2, 3, 5], [], []
for radius in radii:
    noisy, time = spheres(wheel.SCENE.replace("radius: 2, sigma", f"radius: {radius}, sigma"), NOISE)
    # Distance of each noisy centre to the nearest clean one, along the line of sight.
    rays = clean[:, :2] / clean[:, 2:]
    nearest = [numpy.argmin(((rays - c[:2] / c[2]) ** 2).sum(axis=1)) for c in noisy[::7]]
    errors.append(1000 * numpy.sqrt(numpy.mean((noisy[::7, 2] - clean[nearest, 2]) ** 2)))
    milliseconds.append(time)

figure, axes = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
axes[0].plot(radii, errors, "o-")
axes[0].axhline(1000 * NOISE, linestyle="--", color="grey", label="camera noise")
axes[0].set(title="error of the surface", xlabel="filter radius [pixels]", ylabel="RMS error [mm]", ylim=(0, None))
axes[0].legend(frameon=False)
axes[1].plot(milliseconds, errors, "o")
for radius, x, y in zip(radii, milliseconds, errors):
    axes[1].annotate(f"  radius {radius}", (x, y))
axes[1].set(title="against time", xlabel="time of a frame on the compute device [ms]", ylabel="RMS error [mm]", ylim=(0, None))
axes[1].margins(x=0.25)
figure.savefig(sys.argv[1], dpi=110)
print("radius  error [mm]  time [ms]")
for row in zip(radii, errors, milliseconds):
    print("%6d  %10.3f  %9.2f" % row)
