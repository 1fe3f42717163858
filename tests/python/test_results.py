# SPDX-License-Identifier: Apache-2.0
"""Runs of the program as arrays."""

import ast
import enum
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
import unittest.mock

import fathom
import numpy
import wall

SCENE = """
camera: {source: {simulated: plane, pictures: 6}}
fixtures: [{name: wall, role: forbidden, radius: 0.04}]
tool: {spheres: [[0, 0, 0, 0.01]]}
"""


class Results(unittest.TestCase):
    def test_a_replay_gives_one_row_per_tick_and_per_frame(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.yaml"
            scene.write_text(SCENE)
            run = fathom.replay(scene, device="llvmpipe")
            again = fathom.replay(scene, device="llvmpipe", out=pathlib.Path(folder) / "out")
            self.assertTrue((pathlib.Path(folder) / "out" / "summary.json").is_file())
        self.assertEqual(len(run["frames"]["upload_ms"]), 6)
        t = run["haptics"]["t_s"]
        self.assertTrue((numpy.diff(t) > 0).all())
        self.assertEqual(run.summary["digest"], again.summary["digest"])
        self.assertIn("contact", set(run["haptics"]["state"]))

    def test_an_observer_without_any_library_sees_the_contact(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, view = wall.recording(pathlib.Path(folder), seconds=6), pathlib.Path(folder) / "view"
            with subprocess.Popen([fathom.program(), "--device", "llvmpipe", "replay", str(scene), "--realtime", "--out", folder + "/out",
                                   "--operator", folder + "/hand.csv", "--view-door", str(view)],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
                while not view.exists() and run.poll() is None:
                    time.sleep(0.01)
                seen = subprocess.run([sys.executable, "apps/examples/python/observe.py", str(view)], capture_output=True, text=True,
                                      timeout=60, check=False)
                self.assertEqual(run.wait(), 0)
        lines = seen.stdout.splitlines()
        self.assertGreater(len(lines), 5, seen.stderr)
        self.assertTrue(any("contact" in line for line in lines), seen.stdout)

    def test_a_failing_run_raises_with_the_program_s_line(self):
        with self.assertRaisesRegex(fathom.ProgramFailed, "none.yaml.*exit code"):
            fathom.replay("none.yaml")

    def test_an_empty_source_is_not_taken_for_none(self):
        for run in (lambda: fathom.replay("apps/scenes/demo.yaml", source=""), lambda: fathom.profile("budgets", source="")):
            with self.assertRaisesRegex(fathom.ProgramFailed, "--source: value: empty"):
                run()

    def test_only_files_that_the_run_wrote_are_read_from_its_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            out, program = pathlib.Path(folder) / "out", pathlib.Path(folder) / "fathom"
            out.mkdir()
            for name, text in (("solver.csv", "a\n1\n"), ("empty.csv", ""), ("tool.csv", "a\n1\n"),
                               ("old.json", '{"old": 1}'), ("list.json", "[1]")):
                (out / name).write_text(text)
            program.write_text(f"#!/bin/sh\ncd '{out}'\nprintf 'a\\n2\\n' >new && mv new tool.csv\n"
                               "printf '{\"new\": 2}' >profile.json\n")
            program.chmod(0o755)
            with unittest.mock.patch.dict("os.environ", FATHOM_PROGRAM=str(program)):
                run = fathom.profile("tool", out=out)
        self.assertEqual(list(run.tables), ["tool"])
        self.assertEqual(list(run["tool"]["a"]), [2.0])
        self.assertEqual(run.summary, {"new": 2})

    def test_stability_cases_come_with_figure_and_limit(self):
        (case,) = fathom.stability("geometry-gap-of-zero", short=True).summary["cases"]
        self.assertEqual(case["name"], "geometry-gap-of-zero")
        self.assertLessEqual(case["figure"], case["limit"])

    def test_spheres_contain_the_corners_of_their_mesh(self):
        corners = numpy.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]])
        with tempfile.TemporaryDirectory() as folder:
            mesh = pathlib.Path(folder) / "wedge.obj"
            mesh.write_text("".join("v %g %g %g\n" % tuple(c) for c in corners) + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
            spheres = fathom.sphere_cover(mesh, leaves=16)
        self.assertLessEqual(len(spheres), 16)
        distance = numpy.linalg.norm(corners[:, None] - spheres[None, :, :3], axis=2) - spheres[None, :, 3]
        self.assertTrue((distance.min(axis=1) <= 1e-9).all())

    def test_a_set_of_spheres_is_read_as_it_is(self):
        with tempfile.TemporaryDirectory() as folder:
            tool = pathlib.Path(folder) / "tool.sph"
            tool.write_text("1 1\n0 0 0 0.01\n")
            self.assertEqual(fathom.sphere_cover(tool).tolist(), [[0.0, 0.0, 0.0, 0.01]])
            with self.assertRaisesRegex(fathom.ProgramFailed, "--leaves: given with spheres"):
                fathom.sphere_cover(tool, leaves=4)


def names_of(body):
    """Public names that statements define, with those of classes inside."""
    found = {}
    for part in body:
        if isinstance(part, ast.AnnAssign):
            found[part.target.id] = {}
        elif isinstance(part, ast.Assign):
            found[part.targets[0].id] = {}
        elif isinstance(part, (ast.FunctionDef, ast.ClassDef)):
            found[part.name] = names_of(part.body) if isinstance(part, ast.ClassDef) else {}
    return {name: inner for name, inner in found.items() if not name.startswith("_")}


class Documentation(unittest.TestCase):
    def test_the_type_file_names_what_the_module_has_and_nothing_else(self):
        types = pathlib.Path(fathom.__file__).with_name("_fathom.pyi")
        stated = names_of(ast.parse(types.read_text()).body)
        made = {name for name in dir(fathom._fathom) if not name.startswith("_")}
        self.assertEqual(set(stated), made)
        for name, inner in stated.items():
            thing = getattr(fathom._fathom, name)
            if isinstance(thing, type) and not issubclass(thing, (BaseException, enum.Enum)):
                has = {n for n in vars(thing) if not n.startswith("_")} - {"name", "value"} | {"name"} & set(inner)
                self.assertEqual(set(inner), has, name)
            elif isinstance(thing, type) and issubclass(thing, enum.Enum):
                self.assertEqual(set(inner), {member.name for member in thing}, name)

    def test_the_tutorial_in_the_package_s_help_runs(self):
        text = fathom.__doc__
        code = text[text.index("    import fathom"):text.index("With cameras")].replace(
            "fathom.Pose((0, 0, 0.5)))", "fathom.Pose((0, 0, 0.5)), compute_device='llvmpipe')")
        names = {}
        exec(textwrap.dedent(code), names)
        self.assertAlmostEqual(names["step"].force[2], -10.0, delta=0.01)

    def test_every_public_name_has_a_text(self):
        for name in fathom.__all__:
            if name != "__version__":
                self.assertTrue(getattr(fathom, name).__doc__, name)
