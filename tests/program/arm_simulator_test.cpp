// SPDX-License-Identifier: Apache-2.0
// `fathom arm-simulator`, driven by the drivers of both arms through the pseudo-terminal that it opens.
#include "devices/serial/eca_arm.h"
#include "devices/serial/reach_arm.h"
#include "tests/rig/program_refusal.h"
#include "tests/support/eventually.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

// Runs the program in the background and ends it with SIGTERM.
class Simulator {
public:
    Simulator(const std::string& protocol, std::filesystem::path link, const std::filesystem::path& said)
        : link_(std::move(link))
        , process_(startFathom({"arm-simulator", protocol, "--link", link_.string()}, said)) {
        CHECK(testing::eventually([&] { return std::filesystem::exists(link_); }));
    }
    Simulator(const Simulator&) = delete;
    Simulator& operator=(const Simulator&) = delete;
    ~Simulator() {
        CHECK(exitCodeOf(process_, SIGTERM) == 0);
        CHECK_FALSE(std::filesystem::is_symlink(link_));
    }

private:
    std::filesystem::path link_;
    pid_t process_;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

TEST_CASE("A simulated Reach moves where its driver commands, and a simulated ECA finds its stops") {
    Stage stage;
    for (const ReachKind kind : {ReachKind::Alpha5, ReachKind::Bravo7}) {
        const std::string name = kind == ReachKind::Alpha5 ? "reach_alpha5" : "reach_bravo7";
        {
            const Simulator simulator(name, stage / "reach", stage / name);
            SerialPort port((stage / "reach").string(), 115200);
            ReachArm arm(port, {}, kind);
            const ArmCommand go{{0.1, -0.1, 0.2, 0.05, 0.002, 0.01, 0.001}, false};
            CHECK(testing::eventually([&] {
                arm.step(now(), go);
                double off = 0.0;
                for (size_t k = 0; k < reachDevices(kind).size(); ++k) {
                    off = std::max(off, std::abs(arm.feedback().position[k] - go.position[k]));
                }
                return !arm.feedback().stale && off < 1e-4;
            }));
        }
        CHECK(stage.read(name).find(name + " simulated at /dev/pts/") == 0);
    }
    const Simulator simulator("eca_5e", stage / "eca", stage / "said");
    SerialPort port((stage / "eca").string(), 115200);
    EcaArm arm(port);
    CHECK(testing::eventually([&] {
        arm.step(now(), {{}, false});
        return arm.feedback().homed;
    }));
}

TEST_CASE("arm-simulator rejects unknown arms and invalid line parameters in one line") {
    Stage stage;
    stage.write("file", "not to be lost");
    checkRefusal({"arm-simulator", "oberon"}, {"arm-simulator", "oberon"});
    checkRefusal({"arm-simulator", "eca_5e", "--link", (stage / "no/such/folder").string()},
                 {"--link", "No such file"});
    checkRefusal({"arm-simulator", "eca_5e", "--link", (stage / "file").string()}, {"--link", "File exists"});
    CHECK(stage.read("file") == "not to be lost");
}
