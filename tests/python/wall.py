# SPDX-License-Identifier: Apache-2.0
"""A flat wall 0.6 m in front of the camera, protected by 40 mm, and a ball of 10 mm that presses into it."""

import fathom
import numpy

SCENE = """
camera: {near: 0.1, far: 3.0}
error_budget: 0
fixtures: [{name: wall, role: forbidden, radius: 0.04}]
tool: {spheres: [[0, 0, 0, 0.01]]}
haptics: {device: ideal, stiffness: 1000}
"""
WIDTH, HEIGHT = 80, 61  # odd: rows are no multiple of a group
TOUCH = 0.55  # [m] 0.6 - 0.04 - 0.01


def lens():
    return fathom.Intrinsics(WIDTH, HEIGHT, 70, 70, 40, 30)


def camera(**formats):
    return fathom.CameraModel(lens(), **formats)


def depth(millimetres=600):
    return numpy.full((HEIGHT, WIDTH), millimetres, numpy.uint16)


def lockstep(**formats):
    return fathom.Lockstep(fathom.Scene.from_text(SCENE), camera(**formats), fathom.Pose((0, 0, 0.5)),
                           device="llvmpipe")


def press(run, to, ticks=1200):
    """Moves the hand from 0.5 m to `to`; returns the last step."""
    step = None
    for tick in range(ticks):
        run.answer()
        z = min(to, 0.5 + 0.0001 * tick)
        step = run.step(fathom.Pose((0, 0, z)), now=1 + tick * 1_000_000)
    return step
