// SPDX-License-Identifier: Apache-2.0
// What `--arm` rejects before the arm moves.
#include "tests/rig/arm_stage.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("An arm that does not answer, is outside its limits or is not described is rejected") {
    const auto refused = [](const std::string& driver, const std::vector<std::string>& more, int exitCode,
                            const std::string& part) {
        const Stage stage;
        setUp(stage, driver, pushing(1.0));
        ReachSimulator arm;
        setStart(arm);
        arm.position[4] = 2.5;
        if (part.find("motor current") != std::string::npos) {
            arm.current.fill(std::nan(""));
        }
        ArmBench bench(arm, stage / "line");
        std::vector<std::string> words{"--realtime", "--arm", (stage / "line").string()};
        words = more.empty() ? words : more;
        if (driver.find("eca") != std::string::npos) { // the wrong protocol
            arm.speed.fill(0.0);
        }
        const ProgramRun run = runFathom(stage.command(words));
        CHECK(run.exitCode == exitCode);
        CHECK_MESSAGE(run.err.find(part) != std::string::npos, run.err);
        CHECK_FALSE(std::filesystem::exists(stage / "out/summary.json"));
    };
    refused(kReach, {}, 2, "joint shoulder: 2.500000 (allowed: -2.000000 to 2.000000");
    refused(kReach, {}, 3, "axis base reports no motor current");
    refused(kEca, {}, 3, "no answer");
    refused(kReach, {"--arm", "x"}, 2, "--arm: x (allowed: together with --realtime)");
    refused(kReach, {"--realtime", "--arm", "/nowhere"}, 2, "/nowhere: serial line");
    refused("protocol: reach_alpha5, axes: [{axis: hip, joint: slew}]", {}, 2,
            "arm.driver.axes[0].axis: 'hip' (allowed: base, shoulder, elbow, wrist)");
    refused("protocol: reach_alpha5, axes: [{axis: base, joint: hip}]", {}, 2,
            "arm.driver.axes[0].joint: 'hip' (allowed: slew, shoulder, elbow)");
    refused("protocol: reach_alpha5, axes: [{axis: base, joint: slew}]", {}, 2, "joint 'shoulder' has none");
    refused("protocol: modbus, axes: []", {}, 2, "arm.driver.protocol");
    refused("protocol: eca_5e, axes: [{axis: slew, joint: slew, sign: 2}]", {}, 2, "arm.driver.axes[0].sign");
    refused("protocol: eca_5e, axes: [], jaws: {open: 1, closed: 1}", {}, 2, "arm.driver.jaws");
    refused("protocol: reach_alpha5, axes: [{axis: base, joint: slew}, {axis: base, joint: elbow}]", {}, 2,
            "each axis and each joint once");
}
