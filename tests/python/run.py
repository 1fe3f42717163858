# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of the Python module; the last line counts them."""

import pathlib
import sys
import unittest

here = pathlib.Path(__file__).parent
sys.path.insert(0, str(here))
result = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(unittest.defaultTestLoader.discover(str(here)))
failed = len(result.failures) + len(result.errors)
print(f"python: tests: {result.testsRun - failed} passed, {failed} failed")
sys.exit(failed > 0 or result.testsRun == 0)
