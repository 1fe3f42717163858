# SPDX-License-Identifier: Apache-2.0
# Types of the extension module; texts: help(fathom).
import enum
import os
from typing import Any, Callable, Optional, Sequence, Union, overload

import numpy
from numpy.typing import NDArray

_PoseLike = Union[Pose, NDArray[numpy.float64]]
_Floats = NDArray[numpy.float64]

class Error(RuntimeError): ...
class BadInput(Error, ValueError): ...
class ComputeDeviceLost(Error): ...

def now() -> int: ...
def set_log(receiver: Optional[Callable[[str, str], Any]]) -> None: ...

class Pose:
    @overload
    def __init__(self, position: Sequence[float] = ..., rotation: Sequence[float] = ...) -> None: ...
    @overload
    def __init__(self, matrix: NDArray[Any]) -> None: ...
    position: _Floats
    rotation: tuple[float, float, float, float]
    def matrix(self) -> _Floats: ...

class Scene:
    @staticmethod
    def from_file(file: Union[str, os.PathLike[str]]) -> Scene: ...
    @staticmethod
    def from_text(yaml: str) -> Scene: ...

class DepthFormat:
    UINT16: DepthFormat
    METRES: DepthFormat

class ColourFormat:
    NONE: ColourFormat
    RGB: ColourFormat
    RGBA: ColourFormat
    YUYV: ColourFormat

class SubmitStatus:
    ACCEPTED: SubmitStatus
    MISSING_STAMP: SubmitStatus
    STAMP_AHEAD: SubmitStatus
    STAMP_BACK: SubmitStatus
    MISSING_IMAGE: SubmitStatus
    BAD_POSE: SubmitStatus
    CLOSED: SubmitStatus

class Intrinsics:
    def __init__(self, width: int, height: int, fx: float, fy: float, cx: float, cy: float,
                 distortion: Sequence[float] = ...) -> None: ...
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: list[float]

class CameraModel:
    def __init__(self, depth: Intrinsics, depth_format: DepthFormat = ..., metres_per_unit: float = ...,
                 colour_format: ColourFormat = ..., colour: Optional[Intrinsics] = ..., colour_T_depth: _PoseLike = ...,
                 name: str = ...) -> None: ...
    depth: Intrinsics
    colour: Optional[Intrinsics]
    name: str

class CameraPort:
    def submit(self, depth: NDArray[Any], colour: Optional[NDArray[numpy.uint8]] = ..., *, base_T_camera: _PoseLike = ...,
               stamp: Optional[int] = ...) -> SubmitStatus: ...
    def clock_jumped(self) -> None: ...
    dropped: int
    processed: int

class Button(enum.IntFlag):
    GUIDANCE = 1
    DEAD_MAN_OPEN = 2
    CLUTCH = 4

class StepWarning(enum.IntFlag):
    NO_SCENE = 1
    OLD_SCENE = 2
    COMPUTE_DEVICE_LOST = 4
    NOT_FINITE = 8
    TIME_BACK = 16
    STALLED = 32
    ENGINE_FAILED = 64
    ARM_STILL = 128
    OTHER_CLOCK = 256

class State:
    OFF: State
    FREE: State
    CONTACT: State
    ESCAPE: State
    TRAPPED: State
    FADING: State
    WAITING: State

class Contact:
    point: _Floats
    normal: _Floats
    gap: float
    fixture: int

class Step:
    force: _Floats
    torque: _Floats
    residual_force: _Floats
    residual_torque: _Floats
    base_T_tool: Pose
    base_T_command: Pose
    state: State
    warnings: StepWarning
    scene_age: float
    min_gap: float
    guidance: float
    frame: int
    joints: list[float]
    grasp: float
    contacts: list[Contact]

class HandPort:
    def step(self, device_T_handle: _PoseLike, buttons: int = ..., now: Optional[int] = ...) -> Step: ...
    period: float

class ReportStatus:
    ACCEPTED: ReportStatus
    MISSING_STAMP: ReportStatus
    STAMP_AHEAD: ReportStatus
    STAMP_BACK: ReportStatus
    BAD_POSTURE: ReportStatus

class ArmSetpoint:
    joints: list[float]
    grasp: float
    hold: bool
    forces_off: bool
    stamp: int

class ArmPort:
    def report(self, joints: Sequence[float], grasp: float = ..., *, stamp: Optional[int] = ...,
               ready: bool = ...) -> ReportStatus: ...
    def setpoint(self) -> ArmSetpoint: ...
    names: list[str]

class GuidanceTarget:
    fixture: int
    present: bool
    base_T_tool: Pose

class Regions:
    frame: int
    stamp: int
    origin: _Floats
    centres: NDArray[numpy.float32]
    radii: NDArray[numpy.float32]
    fixtures: NDArray[numpy.uint32]
    targets: list[GuidanceTarget]
    def __len__(self) -> int: ...

class ObserverPort:
    def regions(self) -> Optional[Regions]: ...
    def step(self) -> Optional[Step]: ...

class Engine:
    def __init__(self, scene: Scene, camera: CameraModel, *, compute_device: str = ..., reader: str = ...,
                 measured_arm: bool = ...) -> None: ...
    def camera(self) -> CameraPort: ...
    def open_hand(self, device_T_handle: _PoseLike = ..., base_T_tool: Optional[_PoseLike] = ...) -> HandPort: ...
    def open_arm(self) -> ArmPort: ...
    def open_observer(self) -> ObserverPort: ...
    compute_device_lost: bool
    compute_device_name: str
    failure: str
    def close(self) -> None: ...
    def __enter__(self) -> Engine: ...
    def __exit__(self, *args: Any) -> None: ...

class FrameTimes:
    upload: float
    compute: float
    published: float

class Lockstep:
    def __init__(self, scene: Scene, camera: CameraModel, device_T_handle: _PoseLike = ...,
                 base_T_tool: Optional[_PoseLike] = ..., *, compute_device: str = ..., reader: str = ...) -> None: ...
    def process(self, depth: NDArray[Any], colour: Optional[NDArray[numpy.uint8]] = ..., *,
                base_T_camera: _PoseLike = ..., stamp: int) -> FrameTimes: ...
    def query_contacts(self) -> bool: ...
    def step(self, device_T_handle: _PoseLike, buttons: int = ..., *, now: int) -> Step: ...
    def end_frames(self) -> None: ...
    def regions(self) -> Optional[Regions]: ...
    period: float
