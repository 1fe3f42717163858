// SPDX-License-Identifier: Apache-2.0
// `--validate`, which this suite uses for every run: messages of the Vulkan validation layers are printed and
// fail the run.
#include "tests/rig/program_refusal.h"
#include "tests/support/validation_wanted.h"

#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

// Sets an environment variable for programs started during its lifetime.
class Variable {
public:
    Variable(const char* name, const std::string& value)
        : name_(name) {
        ::setenv(name, value.c_str(), 1);
    }
    ~Variable() { ::unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
};

void prepare(const Stage& stage) {
    stage.recording(std::vector<Image>(2, Image(kWidth, kHeight, 600)));
    stage.scene({});
    stage.hand({{0.0, {0, 0, 0}}});
}

} // namespace

TEST_CASE("A message of the Vulkan layers is printed and fails a run that is otherwise complete") {
    if (!testing::validationWanted()) {
        return;
    }
    const Stage stage;
    prepare(stage);
    const Variable advice("VK_LAYER_ENABLES",
                          "VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT"); // reports small buffers
    const ProgramRun run = runFathom(stage.command());
    CAPTURE(run.err);
    CHECK(run.exitCode == 1);
    CHECK(run.errorLines().size() > 1);
    CHECK(run.err.starts_with("error: Vulkan validation: "));
    const auto lines = run.errorLines();
    const auto messages = std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
        return line.starts_with("error: Vulkan validation: ");
    });
    CHECK(lines.back() == "fathom: " + std::to_string(messages) + " Vulkan validation messages");
    CHECK(std::filesystem::exists(stage / "out" / "summary.json"));
}

TEST_CASE("Missing validation layers are reported and never skipped") {
    if (!testing::validationWanted()) {
        return;
    }
    const Stage stage;
    prepare(stage);
    const Variable nowhere("VK_LAYER_PATH", (stage / "none").string());
    checkRefusal(stage.command(), {"validation layer", "not installed", "vulkan-validationlayers"}, 1);
    CHECK(!std::filesystem::exists(stage / "out" / "summary.json"));
}

TEST_CASE("Without a Vulkan driver one line names the package to install") {
    const Stage stage;
    prepare(stage);
    const Variable none("VK_DRIVER_FILES", (stage / "none.json").string());
    checkRefusal(stage.command(), {"Vulkan driver", "none is installed", "mesa-vulkan-drivers"});
    CHECK(!std::filesystem::exists(stage / "out" / "summary.json"));
}

TEST_CASE("A scene of shapes alone needs no Vulkan driver") {
    const Stage stage;
    stage.recording(std::vector<Image>(2, Image(kWidth, kHeight, 600)));
    SceneText scene;
    scene.fixtures = {
        "name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, 0.5], quat_xyzw: "
        "[1, 0, 0, 0]}"};
    stage.scene(scene);
    stage.hand({{0.0, {0, 0, 0.4}}, {0.5, {0, 0, 0.55}}});
    const std::string digest = stage.replay({}, {}, "with").summary.at("digest");
    const Variable none("VK_DRIVER_FILES", (stage / "none.json").string());
    const Replay without = stage.replay({}, {}, "without");
    CHECK(without.summary.at("digest") == digest);
    CHECK(without.summary.at("device") == "none");
    CHECK(without.ticks.back().state == "contact");
    const ProgramRun plan =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    CHECK(plan.exitCode == 0);
    CHECK(plan.out.find("device  none (no pass to run)\n") != std::string::npos);
}
