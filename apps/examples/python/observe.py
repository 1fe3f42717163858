# SPDX-License-Identifier: Apache-2.0
"""Prints force and gap of a running engine ten times a second. Needs no library.

fathom operate scene.yaml --view-door /tmp/view &      observe.py /tmp/view
"""

import socket
import struct
import sys

HEADER = struct.Struct("=IHHIIQQ")  # magic, version, kind, size, reserved, sequence, time_ns
STATE = struct.Struct("=24dqQII")  # see fathom_door_state in <fathom/device_socket.h>
MAGIC, VERSION, KIND = 0x524F4F44, 1, 3
STATES = ("off", "free", "contact", "escape", "trapped", "fading", "waiting")

if len(sys.argv) != 2:
    sys.exit("usage: observe.py SOCKET")
with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as view:
    try:
        view.connect(sys.argv[1])
    except OSError as error:
        sys.exit(f"observe.py: {sys.argv[1]}: {error.strerror}")
    while packet := view.recv(65536):
        magic, version, kind, size, _, sequence, _ = HEADER.unpack_from(packet)
        if (magic, version, size) != (MAGIC, VERSION, len(packet)):
            sys.exit("observe.py: this socket speaks another protocol")
        if kind != KIND or sequence % 100 != 1:  # regions and fixtures, and most of the ticks
            continue
        values = STATE.unpack_from(packet, HEADER.size)
        t, force, gap = values[0], values[15:18], values[21]
        strength = sum(f * f for f in force) ** 0.5
        print(f"{t:8.2f} s  {STATES[values[27]]:8}  {strength:6.2f} N  gap {1000 * gap:7.1f} mm", flush=True)
