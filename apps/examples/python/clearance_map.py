# SPDX-License-Identifier: Apache-2.0
"""Draws the distance from a probe to the protected region of a hand wheel, in a plane across it.

clearance_map.py OUT.png
"""

import sys

import fathom
import matplotlib
import numpy
import wheel

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

PROBE = 0.008  # [m] radius
run = fathom.Lockstep(fathom.Scene.from_text(wheel.SCENE), wheel.camera())
run.process(*wheel.frame(), stamp=1)
regions = run.regions()
centres = regions.centres + regions.origin
near = abs(centres[:, 1]) < 0.2  # the plane y = 0 needs no spheres far from it
xs, zs = numpy.linspace(-0.15, 0.15, 151), numpy.linspace(0.35, 0.6, 126)
points = numpy.stack(numpy.meshgrid(xs, [0.0], zs, indexing="ij"), axis=-1).reshape(-1, 3)
clearance = numpy.full(len(points), numpy.inf)
for centre, radius in zip(numpy.array_split(centres[near], 64), numpy.array_split(regions.radii[near], 64)):
    gaps = numpy.linalg.norm(points[:, None] - centre[None], axis=2) - radius - PROBE
    clearance = numpy.minimum(clearance, gaps.min(axis=1, initial=numpy.inf))
clearance = clearance.reshape(len(xs), len(zs)).T * 1000

figure, axis = pyplot.subplots(figsize=(7, 5), layout="constrained")
levels = numpy.arange(-20, 121, 10)
filled = axis.contourf(xs * 1000, zs * 1000, clearance, levels, cmap="RdYlBu", extend="both")
axis.contour(xs * 1000, zs * 1000, clearance, [0], colors="black", linewidths=2)
axis.set(title="clearance of a probe of 8 mm at y = 0; black: contact", xlabel="x [mm]", ylabel="z [mm]", aspect="equal")
axis.invert_yaxis()
figure.colorbar(filled, label="clearance [mm]")
figure.savefig(sys.argv[1], dpi=110)
print(f"{len(regions)} spheres; clearance {clearance.min():.1f} to {clearance.max():.1f} mm")
