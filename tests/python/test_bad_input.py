# SPDX-License-Identifier: Apache-2.0
"""Invalid arguments: ValueError names the argument, what it is and what is allowed."""

import math
import unittest

import fathom
import numpy
import wall


class BadInput(unittest.TestCase):
    def refused(self, *parts):
        return self.assertRaisesRegex(ValueError, ".*".join(parts))

    def test_depth_of_another_type_shape_or_stride_is_refused_by_name(self):
        run = wall.lockstep()
        with self.refused("depth: float64", "allowed: uint16"):
            run.process(wall.depth().astype(float), stamp=1)
        with self.refused("depth: uint16 of shape \\(80, 61\\)", "\\(61, 80\\)"):
            run.process(numpy.zeros((80, 61), numpy.uint16), stamp=1)
        with self.refused("depth: strides", "ascontiguousarray"):
            run.process(numpy.zeros((wall.HEIGHT, 2 * wall.WIDTH), numpy.uint16)[:, ::2], stamp=1)
        with self.refused("depth: >u2", "uint16"):
            run.process(wall.depth().astype(">u2"), stamp=1)
        with self.assertRaises(TypeError):
            run.process(None, stamp=1)

    def test_masked_values_are_refused_because_nothing_reads_the_mask(self):
        pixels = numpy.zeros((wall.HEIGHT, wall.WIDTH, 3), numpy.uint8)
        run = wall.lockstep(colour_format=fathom.ColourFormat.RGB)
        with self.refused("depth: masked values \\(allowed: an array without a mask; use filled\\(0\\)\\)"):
            run.process(numpy.ma.array(wall.depth(), mask=True), pixels, stamp=1)
        with self.refused("colour: masked values"):
            run.process(wall.depth(), numpy.ma.array(pixels, mask=pixels == 0), stamp=1)
        with self.refused("pose: masked values"):
            fathom.Pose(numpy.ma.array(numpy.eye(4), mask=numpy.eye(4) > 0.5))
        fathom.Pose(numpy.ma.array(numpy.eye(4), mask=False))  # as readers of files return arrays
        run.process(numpy.ma.array(wall.depth(), mask=True).filled(0), pixels, stamp=1)
        self.assertEqual(len(run.regions()), 0)

    def test_colour_that_the_camera_does_not_have_or_lacks_is_refused(self):
        pixels = numpy.zeros((wall.HEIGHT, wall.WIDTH, 3), numpy.uint8)
        with self.refused("colour: an image", "None"):
            wall.lockstep().process(wall.depth(), pixels, stamp=1)
        run = wall.lockstep(colour_format=fathom.ColourFormat.RGB)
        with self.refused("colour: .*NoneType", "colour_format"):
            run.process(wall.depth(), stamp=1)
        with self.refused("colour: uint8 of shape", "\\(61, 80, 3\\)"):
            run.process(wall.depth(), pixels[..., :2].copy(), stamp=1)

    def test_a_lens_that_is_not_finite_is_refused_by_field(self):
        for field in ("fx", "fy", "cx", "cy"):
            values = {"width": 80, "height": 60, "fx": 70, "fy": 70, "cx": 40, "cy": 30, field: math.nan}
            with self.refused(f"depth.{field}: nan"):
                fathom.CameraModel(fathom.Intrinsics(**values))
        with self.refused("distortion: inf"):
            fathom.CameraModel(fathom.Intrinsics(80, 60, 70, 70, 40, 30, [0, 0, math.inf, 0, 0]))
        with self.refused("metres_per_unit: nan"):
            wall.camera(metres_per_unit=math.nan)

    def test_a_focal_length_of_zero_is_refused_by_the_engine(self):
        model = fathom.CameraModel(fathom.Intrinsics(80, 60, 0, 70, 40, 30))
        with self.assertRaisesRegex(fathom.BadInput, "fx") as raised:
            fathom.Lockstep(fathom.Scene.from_text(wall.SCENE), model, compute_device="llvmpipe")
        self.assertIsInstance(raised.exception, fathom.Error)
        self.assertIsInstance(raised.exception, ValueError)

    def test_poses_that_are_no_poses_are_refused(self):
        with self.refused("position: nan"):
            fathom.Pose((0, math.nan, 0))
        with self.refused("rotation: norm 0"):
            fathom.Pose((0, 0, 0), (0, 0, 0, 0))
        with self.refused("pose: array of shape \\(3, 3\\)"):
            fathom.Pose(numpy.eye(3))
        for matrix in (numpy.diag([1.0, 1.0, -1.0, 1.0]), numpy.diag([2.0, 2.0, 2.0, 1.0])):
            with self.refused("pose: the upper left", "a rotation matrix"):
                fathom.Pose(matrix)

    def test_a_quaternion_of_any_length_but_zero_is_normalised(self):
        for length in (5e-324, 1e-200, 1e-7, 2.0, 1e200, 1.7e308):
            self.assertEqual(tuple(fathom.Pose((0, 0, 0), (length, 0, 0, 0)).rotation), (1, 0, 0, 0))
        for length in (1e-300, 1e-7, 1e300):
            rotation = fathom.Pose((0, 0, 0), (3 * length, 0, -4 * length, 0)).rotation
            self.assertLess(abs(numpy.array(rotation) - (0.6, 0, -0.8, 0)).max(), 1e-15)

    def test_a_matrix_given_where_a_pose_is_wanted_is_refused_with_its_reason(self):
        run = wall.lockstep()
        slanted = numpy.eye(4)
        slanted[0, 1] = 0.01
        for matrix, reason in ((numpy.full((4, 4), math.nan), "pose: nan"),
                               (slanted, "pose: the upper left 3 x 3 part times its transpose differs .* by 0.01"),
                               (numpy.eye(4)[:3], "pose: array of shape \\(3, 4\\)"),
                               (numpy.eye(4, dtype=complex), "pose: complex numbers")):
            with self.refused(reason):
                run.step(matrix, now=20)
            with self.refused(reason):
                run.process(wall.depth(), stamp=1, base_T_camera=matrix)
        with self.assertRaises(TypeError):
            run.step("here", now=20)

    def test_a_rotation_with_six_digits_is_a_pose_of_unit_length(self):
        c, s = numpy.cos(0.3), numpy.sin(0.3)
        matrix = numpy.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) @ fathom.Pose((0, 0, 0), (0.3, 0.4, -0.5, 0.7)).matrix()
        for digits in (5, 6, 12):
            pose = fathom.Pose(numpy.round(matrix, digits))
            self.assertAlmostEqual(numpy.linalg.norm(pose.rotation), 1.0, places=12)
            self.assertLess(abs(pose.matrix() - matrix).max(), 2 * 10.0**-digits)

    def test_a_receiver_of_the_log_that_is_no_function_is_refused_by_name(self):
        with self.assertRaisesRegex(TypeError, "receiver: int \\(allowed: a function of level and line, or None\\)"):
            fathom.set_log(3)

    def test_a_scene_with_a_wrong_key_is_refused_in_one_line(self):
        with self.assertRaises(fathom.BadInput) as raised:
            fathom.Scene.from_text("fixturs: []")
        self.assertIn("fixturs", str(raised.exception))
        self.assertNotIn("\n", str(raised.exception))

    def test_a_device_that_does_not_exist_is_refused(self):
        with self.assertRaisesRegex(fathom.Error, "no such gpu"):
            fathom.Lockstep(fathom.Scene.from_text(wall.SCENE), wall.camera(), compute_device="no such gpu")
