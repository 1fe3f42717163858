# SPDX-License-Identifier: Apache-2.0
"""A hand wheel in front of a wall, as a depth and colour camera sees it. The examples share it."""

import fathom
import numpy

WIDTH, HEIGHT, FOCAL = 320, 240, 300.0
SCENE = """
camera: {near: 0.1, far: 1.5}
filter: {radius: 2, sigma: 0.01}
fixtures: [{name: wheel, role: forbidden, hue: [345, 20], saturation: [0.5, 1], radius: 0.02}]
tool: {spheres: [[0, 0, 0, 0.008]]}
haptics: {device: ideal, stiffness: 1000}
"""


def camera():
    lens = fathom.Intrinsics(WIDTH, HEIGHT, FOCAL, FOCAL, (WIDTH - 1) / 2, (HEIGHT - 1) / 2)
    return fathom.CameraModel(lens, colour_format=fathom.ColourFormat.RGB, metres_per_unit=0.0001)


def frame(noise=0.0, seed=1):
    """Depth [0.1 mm] and colour: a red rim of 80 mm with three spokes at 0.5 m, and a grey wall at 0.7 m."""
    v, u = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    x, y = (u - (WIDTH - 1) / 2) / FOCAL * 0.5, (v - (HEIGHT - 1) / 2) / FOCAL * 0.5
    height = numpy.full(x.shape, -numpy.inf)  # [m] of the surface towards the camera
    rim = 0.012**2 - (numpy.hypot(x, y) - 0.08) ** 2
    height = numpy.where(rim > 0, numpy.sqrt(numpy.maximum(rim, 0)), height)
    for angle in numpy.radians([90, 210, 330]):
        along, across = x * numpy.cos(angle) + y * numpy.sin(angle), y * numpy.cos(angle) - x * numpy.sin(angle)
        spoke = numpy.where((along > 0) & (along < 0.08), 0.007**2 - across**2, -1)
        height = numpy.where(spoke > 0, numpy.maximum(height, numpy.sqrt(numpy.maximum(spoke, 0))), height)
    seen = numpy.isfinite(height)
    metres = numpy.where(seen, 0.5 - height, 0.7) + numpy.random.default_rng(seed).normal(0, noise, x.shape)
    colour = numpy.where(seen[..., None], (200, 30, 30), (120, 120, 120)).astype(numpy.uint8)
    return numpy.round(metres * 10000).astype(numpy.uint16), numpy.ascontiguousarray(colour)
