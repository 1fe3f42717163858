// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/plan_command.h"

#include "apps/binding/arm_axes.h"
#include "apps/binding/open_hand.h"
#include "apps/binding/open_source.h"
#include "apps/binding/raw_path.h"
#include "engine/cycle/arm_text.h"
#include "engine/cycle/haptic_notes.h"
#include "engine/cycle/start_notes.h"
#include "engine/gpu/device.h"
#include "engine/scene/dead_gates.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <optional>

namespace fathom {

namespace {

struct PlanOptions {
    std::string scene;
    std::string source;
};

DeviceFacts factsFor(const Scene& scene, const GlobalOptions& global) {
    if (!scene.hasPoints()) {
        return noDevice();
    }
    const gpu::Instance instance(global.validation());
    return gpu::Device(instance, global.device).facts();
}

std::string sizeOf(const CameraInfo& camera) {
    const std::string size = sizeText(camera.depth.width, camera.depth.height);
    return size + (camera.decimation > 1 ? ", decimation " + std::to_string(camera.decimation) : "");
}

void printNotes(const Scene& scene, const CameraInfo& camera, const std::string& device) {
    if (!scene.hasPoints() && !device.empty()) {
        std::cout << "note    --device " << printable(device) << " is not used: no fixture uses points\n";
    }
    for (const auto& notes : {hapticNotes(scene), unusedKeys(scene), equalityNotes(scene)}) {
        for (const std::string& note : notes) {
            std::cout << "note    " << note << "\n";
        }
    }
    for (const auto& warnings : {hueNotes(scene), deadGates(scene, camera)}) {
        for (const std::string& warning : warnings) {
            std::cout << "warning " << warning << "\n";
        }
    }
}

// What is in order for a plan, but not for each replay of the scene.
void printRefusals(const Scene& scene, const ArmSetup* arm) {
    if (!scene.hand.builtIn && !isRegularFile(scene.hand.path)) {
        std::cout << "warning hand.path: " << printable(scene.hand.path)
                  << ": no such file: replay rejects it unless --operator or --hand-device names a hand\n";
    }
    if (arm != nullptr && scene.arm->driver) {
        try {
            armAxes(scene, *arm);
        } catch (const BadInput& e) {
            std::cout << "warning " << e.what() << ": --arm rejects it\n";
        }
    }
}

// start: base_T_tool of the hand's path, if there is a file.
void printStart(const Scene& scene, const Tool& tool, const ArmSetup* arm, const std::optional<Pose>& start) {
    if (arm == nullptr && !start) {
        return;
    }
    const ToolPlace place{start.value_or(Pose{}), arm != nullptr ? arm->startPosture() : ArmPosture{}};
    for (const std::string& note : startNotes(scene, tool, arm, place)) {
        std::cout << "warning " << note << "\n";
    }
}

void printArm(const ArmSetup& arm) {
    std::cout << "arm     " << arm.model.count() << " joints, " << arm.model.leaves.size() << " leaves on "
              << arm.model.links.size() << " links\n";
    for (const std::string& line : describeArm(arm)) {
        std::cout << "        " << line << "\n";
    }
    for (const std::string& note : arm.model.notes) {
        std::cout << "        " << note << "\n";
    }
}

void runPlan(const PlanOptions& options, const GlobalOptions& global) {
    const Scene scene = openScene(options.scene);
    const auto camera = openCamera(
        scene, options.source.empty() ? std::nullopt : std::optional<std::filesystem::path>(options.source));
    const auto arm = openArm(scene);
    const Tool tool = openTool(scene, arm.get());
    std::optional<Pose> start;
    if (!scene.hand.builtIn && isRegularFile(scene.hand.path)) { // a live hand needs none
        start = startOf(openHandPath(scene.hand.path, scene, camera->info().poseless), scene);
    }
    const DeviceFacts facts = factsFor(scene, global);
    const Plan plan = makePlan(scene, camera->info(), static_cast<uint32_t>(tool.leafCount()), facts);
    std::cout << "scene   " << options.scene << ", " << camera->description() << ", "
              << sizeOf(camera->info()) << "\n"
              << "device  " << facts.name << " (" << (facts.driver.empty() ? "no pass to run" : facts.driver)
              << ")\n"
              << "tool    " << tool.leafCount() << " leaves\n";
    if (arm) {
        printArm(*arm);
    }
    printNotes(scene, camera->info(), global.device);
    printStart(scene, tool, arm.get(), start);
    printRefusals(scene, arm.get());
    std::cout << "\nin: this scene uses it; out: it does not\n";
    printPlan(std::cout, plan);
    std::cout << "\n" << plan.dispatchesPerFrame() << " dispatches per frame\n";
}

} // namespace

void printPlan(std::ostream& out, const Plan& plan) {
    for (const Plan::Item& item : plan.items) {
        out << (item.in ? "in   " : "out  ") << std::left << std::setw(8) << item.kind << std::setw(18)
            << item.name << std::right << std::setw(9);
        if (item.bytes != 0) {
            out << std::fixed << std::setprecision(2) << static_cast<double>(item.bytes) / (1 << 20)
                << " MiB  ";
        } else {
            out << ""
                << "      ";
        }
        out << item.why << "\n";
    }
}

void addPlanCommand(CLI::App& app, const GlobalOptions& global) {
    auto options = std::make_shared<PlanOptions>();
    CLI::App* command =
        app.add_subcommand("plan", "print the passes, buffers and threads of a scene, with reasons");
    command->add_option("SCENE", options->scene, "scene file (YAML)")->required();
    command->add_option("--source", options->source, kSourceHelp);
    command->callback([options, &global] { runPlan(*options, global); });
}

} // namespace fathom
