# SPDX-License-Identifier: Apache-2.0
"""A flat wall 0.6 m in front of the camera, protected by 40 mm, and a ball of 10 mm that presses into it."""

import json

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
                           compute_device="llvmpipe")


def press(run, to, ticks=1200):
    """Moves the hand from 0.5 m to `to`; returns the last step."""
    step = None
    for tick in range(ticks):
        run.query_contacts()
        z = min(to, 0.5 + 0.0001 * tick)
        step = run.step(fathom.Pose((0, 0, z)), now=1 + tick * 1_000_000)
    return step


def recording(folder, seconds):
    """Writes frames at 30 Hz, few enough points for a busy machine, and a hand that presses; returns the scene."""
    (folder / "wall.pgm").write_bytes(b"P5\n%d %d\n65535\n" % (WIDTH, HEIGHT) + depth().astype(">u2").tobytes())
    (folder / "depth.txt").write_text("".join("%.4f wall.pgm\n" % (i / 30) for i in range(30 * seconds)))
    (folder / "intrinsics.json").write_text(json.dumps({"width": WIDTH, "height": HEIGHT, "fx": 70, "fy": 70, "cx": 40,
                                                        "cy": 30, "depth_scale_m_per_unit": 0.001, "has_color": False}))
    (folder / "hand.csv").write_text("t_s,x,y,z,qw,qx,qy,qz\n" + "".join(
        "%g,0,0,%g,1,0,0,0\n" % (t, z) for t, z in ((0, 0.5), (0.5, TOUCH + 0.01), (seconds, TOUCH + 0.01))))
    scene = folder / "scene.yaml"
    scene.write_text(SCENE.replace("far: 3.0", "far: 3.0, source: {recorded: %s}" % folder))
    return scene
