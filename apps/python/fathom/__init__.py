# SPDX-License-Identifier: Apache-2.0
"""Virtual fixtures from depth cameras for haptic devices.

Fathom turns depth images into protected regions and guidance, and a hand's pose into a force. Units are SI,
times are nanoseconds of time.monotonic_ns(), a pose named a_T_b maps points from frame b to frame a.

Start without a device or a clock. A wall 0.6 m in front of the camera is protected by 40 mm, and a ball of
10 mm is pressed 10 mm into the region:

    import fathom, numpy
    scene = fathom.Scene.from_text('''
        fixtures: [{name: wall, role: forbidden, radius: 0.04}]
        tool: {spheres: [[0, 0, 0, 0.01]]}
        haptics: {device: ideal, stiffness: 1000}
    ''')
    camera = fathom.CameraModel(fathom.Intrinsics(160, 120, 140, 140, 80, 60))
    run = fathom.Lockstep(scene, camera, fathom.Pose((0, 0, 0.5)))
    run.process(numpy.full((120, 160), 600, numpy.uint16), stamp=1)
    run.end_frames()                                # the last frame does not age
    for tick in range(2000):
        run.query_contacts()                        # one contact query
        z = min(0.56, 0.5 + tick * 0.0001)
        step = run.step(fathom.Pose((0, 0, z)), now=tick * 1_000_000 + 1)
    print(step.state, step.force)                   # State.CONTACT, 10 N along -z
    print(run.regions().centres.shape)              # the protected spheres, as an array

With cameras and a haptic device, use Engine: its ports (CameraPort, HandPort, ArmPort, ObserverPort) belong
to one thread each. haptic_loop() calls your device at the scene's rate and leaves it with zero force however
the loop ends:

    with fathom.Engine(scene, camera) as engine:
        images = engine.camera()                    # camera thread: images.submit(depth)
        fathom.haptic_loop(engine.open_hand(device.pose()), device.pose, device.write)

The program `fathom` runs recordings and studies; these functions start it and read its tables into arrays:

    replay(scene, source=...)      frames, ticks, wrenches and the summary of a run
    stability(case, ...)           stiff and extreme cases against stated limits
    profile(study, ...)            error against run time
    sphere_cover(mesh)             spheres that contain a mesh

Invalid input raises BadInput, which is an Error and a ValueError, in one line that names the value and what is
allowed. Arrays of a wrong type or shape raise ValueError that names the argument.
"""

from ._fathom import (
    ArmPort, ArmSetpoint, BadInput, Button, CameraModel, CameraPort, ColourFormat, ComputeDeviceLost, Contact,
    DepthFormat, Engine, Error, FrameTimes, GuidanceTarget, HandPort, Intrinsics, Lockstep, ObserverPort, Pose,
    Regions, ReportStatus, Scene, State, Step, StepWarning, SubmitStatus, __version__, now, set_log,
)
from .loop import haptic_loop
from .results import ProgramFailed, Run, profile, program, replay, sphere_cover, stability

__all__ = [
    "ArmPort", "ArmSetpoint", "BadInput", "Button", "CameraModel", "CameraPort", "ColourFormat",
    "ComputeDeviceLost", "Contact", "DepthFormat", "Engine", "Error", "FrameTimes", "GuidanceTarget",
    "HandPort", "Intrinsics", "Lockstep", "ObserverPort", "Pose", "ProgramFailed", "Regions", "ReportStatus",
    "Run", "Scene", "State", "Step", "StepWarning", "SubmitStatus", "__version__", "haptic_loop", "now",
    "profile", "program", "replay", "set_log", "sphere_cover", "stability",
]
