# SPDX-License-Identifier: Apache-2.0
"""Slides a probe over a hand wheel, 8 mm inside of its protected region, and draws the force that a hand feels.

felt_force.py OUT.png
"""

import sys

import fathom
import matplotlib
import numpy
import wheel

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

DEPTH = 0.468  # [m] of the hand: the region of the rim begins at 0.5 - 0.012 - 0.02 - 0.008 = 0.46 m
xs, ys = numpy.linspace(-0.13, 0.13, 131), numpy.linspace(-0.11, 0.11, 45)

run = fathom.Lockstep(fathom.Scene.from_text(wheel.SCENE), wheel.camera(), fathom.Pose((xs[0], ys[0], DEPTH)))
run.process(*wheel.frame(), stamp=1)
run.end_frames()
force = numpy.zeros((len(ys), len(xs), 3))
now = 1
for row, y in enumerate(ys):
    for column in range(len(xs)) if row % 2 == 0 else reversed(range(len(xs))):  # there and back
        for _ in range(20):  # 2 mm in 20 ms
            run.query_contacts()
            step = run.step(fathom.Pose((xs[column], y, DEPTH)), now=now)
            now += 1_000_000
        force[row, column] = step.force

strength = numpy.linalg.norm(force, axis=2)
figure, axes = pyplot.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
image = axes[0].pcolormesh(xs * 1000, ys * 1000, strength, cmap="viridis", shading="nearest")
touched = numpy.zeros_like(strength, dtype=bool)
touched[::3, ::6] = strength[::3, ::6] > 0.05  # [N] a smaller force would be drawn as a dot
rows, columns = numpy.nonzero(touched)
axes[0].quiver(xs[columns] * 1000, ys[rows] * 1000, force[rows, columns, 0], force[rows, columns, 1],
               color="white", angles="xy")
axes[0].set(title="force on the hand", xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
axes[0].invert_yaxis()
figure.colorbar(image, label="size of the force [N]")
middle = len(ys) // 2
axes[1].plot(xs * 1000, -force[middle, :, 2], label="out of the wheel")
axes[1].plot(xs * 1000, force[middle, :, 0], label="sideways")
axes[1].set(title="along the middle row", xlabel="x [mm]", ylabel="components [N]")
axes[1].legend(frameon=False)
figure.savefig(sys.argv[1], dpi=110)
sideways = force[middle, :, 0]
print(f"largest force {strength.max():.1f} N, sideways {sideways.min():.1f} to {sideways.max():.1f} N; "
      f"{numpy.mean(strength > 0.01):.0%} of the positions touch")
