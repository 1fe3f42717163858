# SPDX-License-Identifier: Apache-2.0
"""A haptic loop in Python."""

import atexit
import threading
import time

import numpy

from ._fathom import HandPort


def haptic_loop(hand: HandPort, pose, write, *, buttons=lambda: 0, running=lambda: True, observe=None):
    """Calls `hand.step()` at the scene's rate until running() is false.

    pose(): the handle's pose, a Pose or a 4 x 4 matrix.
    write(force, torque): sends two arrays [N], [N m] to the device.
    buttons(): Button flags that are down.
    observe(step): called after write(), if given.

    However the loop ends (running(), an exception, KeyboardInterrupt, or the interpreter exits while the loop
    runs in a daemon thread), the last call of write() has zeros. A process that is killed writes nothing more:
    the device must then drop its force by itself.

    Python's threads and garbage collection delay single steps by milliseconds. The forces stay within the
    scene's limits, but a C++ loop feels better.
    """
    ended = zeroed = False
    writing = threading.Lock()  # no force is written after the zeros, also if the interpreter exits meanwhile

    def release():
        nonlocal ended, zeroed
        with writing:
            ended = True
            if not zeroed:
                write(numpy.zeros(3), numpy.zeros(3))
                zeroed = True

    atexit.register(release)
    due = time.monotonic()
    try:
        while running() and not ended:
            step = hand.step(pose(), int(buttons()))
            with writing:
                if ended:
                    break
                write(step.force, step.torque)
            if observe is not None:
                observe(step)
            due = max(due + hand.period, time.monotonic() - hand.period)  # late ticks are not made up for
            time.sleep(max(0.0, due - time.monotonic()))
    finally:
        release()
        atexit.unregister(release)  # stays if a second KeyboardInterrupt ended release()
