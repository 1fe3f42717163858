# SPDX-License-Identifier: Apache-2.0
"""Runs the program `fathom` and reads what it writes into NumPy arrays."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field

import numpy


class ProgramFailed(RuntimeError):
    """The program ended with another exit code than 0. The message is its last line."""


@dataclass
class Run:
    """Results of a run of the program.

    tables: name of each CSV file without .csv -> {column: array}; numbers are float64, empty cells NaN.
    summary: contents of the run's JSON file, {} if it wrote none.
    log: what the program printed.
    """

    tables: dict = field(default_factory=dict)
    summary: dict = field(default_factory=dict)
    log: str = ""

    def __getitem__(self, name):
        return self.tables[name]


def program() -> str:
    """Path of the program: $FATHOM_PROGRAM, else the one of this build, else the installed one."""
    built = pathlib.Path(__file__).absolute().parents[2] / "fathom"
    for path in (os.environ.get("FATHOM_PROGRAM"), str(built) if built.is_file() else None, shutil.which("fathom")):
        if path:
            return path
    raise FileNotFoundError("the program 'fathom' is not on PATH, and FATHOM_PROGRAM does not name it")


def replay(scene, *, source=None, out=None, device=None, options=()) -> Run:
    """Runs a scene file headless, in lockstep: the same input gives the same result to the last bit.

    source: a recording instead of the scene's camera (`fathom inspect` says what it holds).
    out: folder that keeps the files; None = read and removed. Files that lie there from before are not read.
    device: part of a Vulkan device's name, or its index.
    options: further options of `fathom replay`, for example ("--query", "gpu").

    run["haptics"] has one row per tick, run["frames"] one per frame.
    """
    chosen = ["--source", str(source)] if source is not None else []
    return _run("replay", [str(scene)] + chosen + list(options), out, device)


def stability(*cases, short=False, out=None, device=None) -> Run:
    """Runs stability cases or groups of them (none = all) against their limits.

    A case that misses its limit raises ProgramFailed.
    """
    return _run("stability", list(cases) + (["--short"] if short else []), out, device)


def profile(*studies, quick=False, source=None, out=None, device=None) -> Run:
    """Measures error against run time. One table per study."""
    chosen = ["--source", str(source)] if source is not None else []
    return _run("profile", list(studies) + (["--quick"] if quick else []) + chosen, out, device)


def sphere_cover(mesh, leaves=None, *, scale=None) -> numpy.ndarray:
    """Spheres that contain a mesh: array of shape (n, 4), x y z radius [m] in the mesh's frame.

    mesh: STL, OBJ or COLLADA file. leaves: largest number of spheres (128). scale: metres per unit of the file (1).
    """
    with tempfile.TemporaryDirectory(prefix="fathom-") as folder:
        path = pathlib.Path(folder) / "tool.json"
        options = (["--leaves", str(leaves)] if leaves is not None else []) + (
            ["--scale", repr(float(scale))] if scale is not None else [])
        _call(["spheres", str(mesh), *options, "--out", str(path)])
        (link,) = json.loads(path.read_text()).values()
    return numpy.array([[*sphere["origin"], sphere["radius"]] for sphere in link["spheres"]], dtype=float)


def _call(arguments, device=None):
    command = [program()] + (["--device", str(device)] if device is not None else []) + arguments
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = (done.stderr or done.stdout).strip().splitlines() or ["no message"]
        raise ProgramFailed(f"{lines[-1]} (exit code {done.returncode})")
    return done.stdout + done.stderr


def _run(command, arguments, out, device):
    with tempfile.TemporaryDirectory(prefix="fathom-") as folder:
        where = pathlib.Path(out) if out is not None else pathlib.Path(folder) / "out"
        before = _files(where)
        run = Run(log=_call([command] + arguments + ["--out", str(where)], device))
        # Others are of an earlier run, or not of this program.
        written = [path for path, state in sorted(_files(where).items()) if before.get(path) != state]
        for path in written:
            if path.suffix == ".csv":
                run.tables[path.stem] = _table(path)
            elif path.suffix == ".json":
                run.summary.update(json.loads(path.read_text()))
        return run


def _files(folder):
    """Files in a folder, each with what changes when it is written again: the program renames a new file."""
    found = {path: path.stat() for path in folder.glob("*") if path.is_file()}
    return {path: (s.st_ino, s.st_size, s.st_mtime_ns, s.st_ctime_ns) for path, s in found.items()}


def _table(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    header, rows = rows[0], rows[1:]
    return {name: _column([row[i] if i < len(row) else "" for row in rows]) for i, name in enumerate(header)}


def _column(cells):
    try:
        return numpy.array([float(cell) if cell != "" else numpy.nan for cell in cells], dtype=float)
    except ValueError:
        return numpy.array(cells, dtype=str)
