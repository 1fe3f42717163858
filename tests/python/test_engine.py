# SPDX-License-Identifier: Apache-2.0
"""Threads: frames of a camera thread, forces of a haptic thread."""

import gc
import os
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

import fathom
import numpy
import wall


def engine(**options):
    return fathom.Engine(fathom.Scene.from_text(wall.SCENE), wall.camera(), compute_device="llvmpipe", **options)


class Live(unittest.TestCase):
    def test_forces_come_from_frames_of_another_thread(self):
        with engine() as made:
            images, hand, observer = made.camera(), made.open_hand(fathom.Pose((0, 0, 0.5))), made.open_observer()
            stop = threading.Event()

            def run_camera():
                while not stop.wait(0.02):
                    self.assertEqual(images.submit(wall.depth()), fathom.SubmitStatus.ACCEPTED)

            thread = threading.Thread(target=run_camera)
            thread.start()
            written, z = [], 0.5
            end = time.monotonic() + 30

            def pose():
                nonlocal z
                z = min(z + 0.0002, wall.TOUCH + 0.01) if images.processed > 0 else z
                return fathom.Pose((0, 0, z))

            def running():
                pressed = len(written) > 5 and all(f < -9.9 for f in written[-5:])
                return not pressed and time.monotonic() < end

            fathom.haptic_loop(hand, pose, lambda force, torque: written.append(force[2]), running=running)
            stop.set()
            thread.join()
            regions = observer.regions()
            self.assertAlmostEqual(written[-2], -10.0, delta=0.1)
            self.assertEqual(written[-1], 0.0)  # the loop leaves the device without force
            self.assertEqual(regions.centres.shape, (wall.WIDTH * wall.HEIGHT, 3))
            self.assertIsNotNone(observer.step())
            self.assertEqual(made.failure, "")

    def test_other_threads_go_on_while_an_engine_starts_and_ends(self):
        counted, stop = 0, threading.Event()

        def count():
            nonlocal counted
            while not stop.wait(0.001):
                counted += 1

        thread = threading.Thread(target=count)
        thread.start()
        begin, before = time.monotonic(), counted
        engine().close()
        duration, after = time.monotonic() - begin, counted
        stop.set()
        thread.join()
        self.assertGreater(after - before, 50 * duration)  # of at most 1000 a second

    def test_stamps_are_checked(self):
        with engine() as made:
            images = made.camera()
            ahead = fathom.now() + 1_000_000_000
            self.assertEqual(images.submit(wall.depth(), stamp=0), fathom.SubmitStatus.MISSING_STAMP)
            self.assertEqual(images.submit(wall.depth(), stamp=ahead), fathom.SubmitStatus.STAMP_AHEAD)
            stamp = fathom.now()
            self.assertEqual(images.submit(wall.depth(), stamp=stamp), fathom.SubmitStatus.ACCEPTED)
            self.assertEqual(images.submit(wall.depth(), stamp=stamp), fathom.SubmitStatus.STAMP_BACK)

    def test_the_text_of_closed_names_a_property_that_can_be_read(self):
        self.assertIn("Engine.failure says why", fathom.SubmitStatus.__doc__)
        self.assertNotIn("failure()", fathom.SubmitStatus.__doc__)
        self.assertIsInstance(fathom.Engine.failure, property)

    def test_a_missing_driver_is_a_missing_compute_device_and_no_bad_input(self):
        script = textwrap.dedent("""
            import sys
            sys.path.insert(0, "tests/python")
            import fathom, wall
            for start in (fathom.Engine, fathom.Lockstep):
                try:
                    start(fathom.Scene.from_text(wall.SCENE), wall.camera())
                except fathom.ComputeDeviceLost as missing:
                    print(isinstance(missing, ValueError), missing)
        """)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False,
                              env={**os.environ, "VK_DRIVER_FILES": "/nonexistent/driver.json"})
        lines = done.stdout.splitlines()
        self.assertEqual(len(lines), 2, done.stderr)
        for line in lines:
            self.assertRegex(line, "^False device: Vulkan driver: none is installed .*mesa-vulkan-drivers")

    def test_ports_outlive_their_engine(self):
        made = engine()
        images, hand = made.camera(), made.open_hand()
        made.close()
        self.assertEqual(images.submit(wall.depth()), fathom.SubmitStatus.CLOSED)
        self.assertFalse(hand.step(fathom.Pose()).force.any())
        with self.assertRaisesRegex(fathom.Error, "closed"):
            made.camera()

    def test_log_lines_reach_the_receiver_from_the_engine_s_threads(self):
        lines = []
        fathom.set_log(lambda level, line: lines.append((level, line)))
        try:
            with engine():
                pass
        finally:
            fathom.set_log(None)
        self.assertTrue(lines)
        self.assertTrue(all(level in ("debug", "info", "warning", "error") for level, _ in lines))

    def test_a_receiver_that_raises_does_not_end_the_engine(self):
        called = []

        def receiver(level, line):
            called.append(line)
            raise RuntimeError("receiver")

        fathom.set_log(receiver)
        try:
            with engine() as made:
                self.assertEqual(made.failure, "")
            self.assertTrue(called)
        finally:
            fathom.set_log(None)
            gc.collect()

    def test_scenes_may_be_read_while_a_receiver_runs_in_another_thread(self):
        script = textwrap.dedent("""
            import sys, threading, time
            sys.path.insert(0, "tests/python")
            import fathom
            fathom.set_log(lambda level, line: time.sleep(0.01))
            scene = sys.argv[1] + "/scene.yaml" # names a file outside of its folder, which is logged
            open(scene, "w").write("fixtures: [{name: wall, role: forbidden}]\\n"
                                   "tool: {spheres: [[0, 0, 0, 0.01]]}\\nhand: {path: ../path.csv}\\n")
            def read():
                for _ in range(20):
                    fathom.Scene.from_file(scene)
            other = threading.Thread(target=read)
            other.start()
            read()
            other.join()
            print("read")
        """)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", script, folder], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.stdout, "read\n", done.stderr)


class Exit(unittest.TestCase):
    def test_an_interpreter_may_end_while_an_engine_logs(self):
        script = textwrap.dedent("""
            import sys, threading, time
            sys.path.insert(0, "tests/python")
            import fathom, wall
            lines = []
            fathom.set_log(lambda level, line: lines.append(line))
            def start_and_end():
                while True:
                    fathom.Engine(fathom.Scene.from_text(wall.SCENE), wall.camera(), compute_device="llvmpipe").close()
            threading.Thread(target=start_and_end, daemon=True).start()
            time.sleep(1.5)
        """)
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_forked_child_that_ends_leaves_the_engine_to_its_parent(self):
        script = textwrap.dedent("""
            import os, signal, sys, threading, time
            sys.path.insert(0, "tests/python")
            import fathom, wall
            fathom.set_log(lambda level, line: None)
            def run_steps():  # a call without the interpreter's lock, which the child does not have
                while True:
                    fathom.Scene.from_text(wall.SCENE)
            made = fathom.Engine(fathom.Scene.from_text(wall.SCENE), wall.camera(), compute_device="llvmpipe")
            images = made.camera()
            threading.Thread(target=run_steps, daemon=True).start()
            for destroys in (False, True):
                begin = time.monotonic()
                child = os.fork()
                if child == 0:
                    signal.alarm(60)
                    if destroys:
                        made.close()
                        del made
                    sys.exit(0)
                print("child", os.waitpid(child, 0)[1], time.monotonic() - begin < 9.5)  # calls are awaited for 10 s
            images.submit(wall.depth())
            while images.processed == 0:
                time.sleep(0.01)
            made.close()
            print("parent")
        """)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.stdout, "child 0 True\nchild 0 True\nparent\n", done.stderr)

    def ends_with_zero(self, end):
        script = textwrap.dedent("""
            import atexit, os, sys, threading, time
            sys.path.insert(0, "tests/python")
            import fathom, wall
            atexit.register(time.sleep, 0.1)  # after the loop's release: a write after it would be seen
            made = fathom.Engine(fathom.Scene.from_text(wall.SCENE), wall.camera(), compute_device="llvmpipe")
            images, hand = made.camera(), made.open_hand(fathom.Pose((0, 0, 0.5)))
            z, felt = 0.5, threading.Event()
            def pose():
                global z
                images.submit(wall.depth())
                z = min(z + 0.0005, wall.TOUCH + 0.01) if images.processed > 0 else z
                return fathom.Pose((0, 0, z))
            def write(force, torque):
                if force[2] != 0: time.sleep(0.01)  # the interpreter's end finds a write at work
                os.write(1, b"%.3f\\n" % force[2])
                if force[2] < -5: felt.set()
            loop = threading.Thread(target=lambda: fathom.haptic_loop(hand, pose, write), daemon=True)
            loop.start()
            assert felt.wait(60)
        """) + end
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False)
        forces = [float(line) for line in done.stdout.split()]
        self.assertLess(min(forces), -5.0, done.stderr)
        self.assertEqual(forces[-1], 0.0, done.stderr)
        return done

    def test_an_interpreter_that_ends_in_a_run_leaves_zero_force(self):
        self.assertEqual(self.ends_with_zero("").returncode, 0)

    def test_an_exception_in_the_main_thread_leaves_zero_force(self):
        self.assertIn("lost", self.ends_with_zero("raise RuntimeError('lost')").stderr)

    def test_a_second_interrupt_while_zeros_are_written_leaves_zero_force(self):
        script = textwrap.dedent("""
            import os, types
            import fathom, numpy
            pressed = types.SimpleNamespace(force=numpy.array((0.0, 0.0, -5.0)), torque=numpy.zeros(3))
            port = types.SimpleNamespace(period=0.001, step=lambda pose, buttons: pressed)
            writes = 0
            def write(force, torque):
                global writes
                writes += 1
                if writes in (3, 4): raise KeyboardInterrupt  # in the loop, and while it leaves
                os.write(1, b"%.3f\\n" % force[2])
            try:
                fathom.haptic_loop(port, lambda: None, write)
            except KeyboardInterrupt:
                pass
        """)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.stdout.split(), ["-5.000", "-5.000", "0.000"], done.stderr)
