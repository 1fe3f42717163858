// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/run_fathom.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("devices lists the compute devices with numbers, and --device takes such a number") {
    const ProgramRun list = runFathom({"devices"});
    REQUIRE(list.exitCode == 0);
    const size_t at = list.out.find("compute llvmpipe");
    REQUIRE(at != std::string::npos);
    const size_t number = list.out.find("--device ", at);
    REQUIRE(number != std::string::npos);
    const std::string index = list.out.substr(number + 9, list.out.find(',', number) - number - 9);
    const ProgramRun chosen = runFathom({"--device", index, "plan", "apps/scenes/demo.yaml"});
    CAPTURE(chosen.err);
    CHECK(chosen.exitCode == 0);
    const ProgramRun none = runFathom({"--device", "999", "plan", "apps/scenes/demo.yaml"});
    CHECK(none.exitCode == 2);
}
