# SPDX-License-Identifier: Apache-2.0
"""Frames and steps on one thread."""

import unittest

import fathom
import numpy
import wall


class Lockstep(unittest.TestCase):
    def test_a_tool_pressed_10_mm_into_a_wall_feels_10_n(self):
        run = wall.lockstep()
        run.process(wall.depth(), stamp=1)
        run.end_frames()
        step = wall.press(run, wall.TOUCH + 0.01)
        self.assertEqual(step.state, fathom.State.CONTACT)
        self.assertAlmostEqual(step.force[2], -10.0, delta=0.01)
        self.assertLessEqual(step.base_T_tool.position[2], wall.TOUCH + 1e-6)
        self.assertEqual(step.contacts[0].fixture, 0)
        self.assertEqual(step.warnings, 0)

    def test_before_the_first_frame_there_is_no_force_and_a_warning(self):
        run = wall.lockstep()
        self.assertFalse(run.query_contacts())
        self.assertIsNone(run.regions())
        step = run.step(fathom.Pose((0, 0, 0.7)), now=1)
        self.assertEqual(step.state, fathom.State.OFF)
        self.assertIn(fathom.StepWarning.NO_SCENE, step.warnings)
        self.assertFalse(step.force.any())

    def test_regions_are_views_that_outlive_the_run(self):
        run = wall.lockstep()
        times = run.process(wall.depth(), stamp=1)
        regions = run.regions()
        centres, radii = regions.centres, regions.radii
        self.assertEqual(centres.shape, (wall.WIDTH * wall.HEIGHT, 3))
        self.assertEqual(centres.dtype, numpy.float32)
        self.assertFalse(centres.flags.owndata)
        self.assertFalse(centres.flags.writeable)
        del run, regions
        self.assertTrue(numpy.allclose(centres[:, 2], 0.6, atol=1e-6))
        self.assertTrue(numpy.allclose(radii, 0.04))
        self.assertGreater(times.published, times.upload)

    def test_an_empty_frame_has_no_spheres(self):
        run = wall.lockstep()
        run.process(wall.depth(0), stamp=1)
        regions = run.regions()
        self.assertEqual(regions.centres.shape, (0, 3))
        self.assertEqual(len(regions), 0)

    def test_metres_give_the_regions_of_millimetres(self):
        metres = wall.lockstep(depth_format=fathom.DepthFormat.METRES)
        metres.process(numpy.full((wall.HEIGHT, wall.WIDTH), 0.6, numpy.float32), stamp=1)
        units = wall.lockstep()
        units.process(wall.depth(), stamp=1)
        self.assertTrue(numpy.allclose(metres.regions().centres, units.regions().centres, atol=1e-6))

    def test_the_camera_pose_moves_the_regions(self):
        run = wall.lockstep()
        matrix = numpy.eye(4)
        matrix[:3, 3] = 1.0, 2.0, 3.0
        run.process(wall.depth(), base_T_camera=matrix, stamp=1)
        regions = run.regions()
        self.assertAlmostEqual(float((regions.centres[:, 2] + regions.origin[2]).max()), 3.6, places=5)

    def test_equal_runs_are_equal_to_the_last_bit(self):
        forces = []
        for _ in range(2):
            run = wall.lockstep()
            run.process(wall.depth(), stamp=1)
            run.end_frames()
            forces.append(wall.press(run, wall.TOUCH + 0.003, 700).force)
        self.assertTrue((forces[0] == forces[1]).all())


class Poses(unittest.TestCase):
    def test_a_matrix_and_its_pose_agree_for_turns_about_every_axis(self):
        for w, x, y, z in numpy.random.default_rng(1).normal(size=(200, 4)):
            pose = fathom.Pose((1, 2, 3), (w, x, y, z))
            again = fathom.Pose(pose.matrix())
            self.assertTrue(numpy.allclose(pose.matrix(), again.matrix(), atol=1e-12))
            self.assertTrue(numpy.allclose(pose.matrix()[:3, :3] @ pose.matrix()[:3, :3].T, numpy.eye(3)))

    def test_half_turns_keep_their_axis(self):
        for axis in range(3):
            matrix = numpy.diag([1.0 if i == axis else -1.0 for i in range(3)] + [1.0])
            self.assertTrue(numpy.allclose(fathom.Pose(matrix).matrix(), matrix))
