// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("stability lists its cases without an output folder, and requires the folder to run them") {
    const ProgramRun list = runFathom({"stability", "--list", "stiff", "solver-needle"});
    CAPTURE(list.err);
    CHECK(list.exitCode == 0);
    CHECK(list.out.starts_with("solver    solver-needle\nstiff     "));
    CHECK(list.out.find("feel") == std::string::npos);
    const ProgramRun run = runFathom({"stability", "solver-needle"});
    CHECK(run.exitCode == 2);
    CHECK(run.err == "fathom: stability: --out is required; see fathom stability --help\n");
    CHECK(
        runFathom({"stability", "solvr", "--list"}).err.find("'solvr', did you mean 'solver'? (allowed: ") !=
        std::string::npos);
}
