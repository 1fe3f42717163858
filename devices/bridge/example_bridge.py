# SPDX-License-Identifier: Apache-2.0
"""A bridge for a simulated device: replace read_handle() and drive(), and keep the rest. Needs no library.

example_bridge.py /tmp/my.door &      fathom operate SCENE.yaml --hand-device /tmp/my.door
"""

import math
import os
import signal
import socket
import struct
import sys
import time

HEADER = struct.Struct("=IHHIIQQ")  # magic, version, kind, size, reserved, sequence, time_ns
HAND = struct.Struct("=QII3d4d16s32s")  # see fathom_door_hand in <fathom/device_socket.h>
WRENCH = struct.Struct("=QII3d3d")  # see fathom_door_wrench
DOOR = (0x524F4F44, 1)  # magic, version
HAND_KIND, WRENCH_KIND, READY, LAST = 1, 2, 3, 2
SILENCE, RISE = 10_000_000, 100_000_000  # [ns]
handle = [0.0, 0.0, 0.0]  # [m]


def read_handle():
    return handle


def drive(force):  # [N], about once per millisecond: 300 N/m, 10 N s/m
    for i, f in enumerate(force):
        handle[i] += 1e-3 * (f - 300.0 * handle[i]) / 10.0


def exchange(engine):
    sequence = heard = since = answered = 0
    force = (0.0, 0.0, 0.0)
    while True:
        try:
            while packet := engine.recv(1024, socket.MSG_DONTWAIT):
                if len(packet) != HEADER.size + WRENCH.size:
                    return
                magic, version, kind, size, _, number, stamp = HEADER.unpack_from(packet)
                _, flags, _, *values = WRENCH.unpack_from(packet, HEADER.size)
                known = (magic, version, kind, size) == (*DOOR, WRENCH_KIND, len(packet))
                if not known or flags & LAST or not all(map(math.isfinite, values)):
                    return
                since = stamp if stamp - heard > SILENCE else since  # the first one after a silence
                heard, answered, force = stamp, number, values[:3]
            return  # the engine closed its end
        except BlockingIOError:
            pass  # no more packets
        now = time.monotonic_ns()
        share = 0.0 if now - heard > SILENCE else min(1.0, (now - since) / RISE)
        drive([share * f for f in force])
        sequence += 1
        head = HEADER.pack(*DOOR, HAND_KIND, HEADER.size + HAND.size, 0, sequence, time.monotonic_ns())
        pose = (*read_handle(), 1.0, 0.0, 0.0, 0.0)
        hand = HAND.pack(answered, READY, 0, *pose, b"falcon", b"Python bridge")
        try:
            engine.send(head + hand, socket.MSG_DONTWAIT)
        except BlockingIOError:
            pass  # the engine is behind
        time.sleep(0.001)


if len(sys.argv) != 2:
    sys.exit("usage: example_bridge.py SOCKET")
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGQUIT, signal.SIGHUP):
    signal.signal(number, lambda *_: sys.exit())
os.umask(0o177)  # only this user may connect
if os.path.exists(sys.argv[1]):
    os.unlink(sys.argv[1])
with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as endpoint:
    endpoint.bind(sys.argv[1])
    endpoint.listen(1)
    try:
        while True:
            engine, _ = endpoint.accept()
            with engine:
                try:
                    exchange(engine)
                except OSError:
                    pass  # the engine is gone
                finally:
                    drive((0.0, 0.0, 0.0))
    finally:
        os.unlink(sys.argv[1])
