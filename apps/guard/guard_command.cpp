// SPDX-License-Identifier: Apache-2.0
#include "apps/guard/guard_command.h"

#include "apps/binding/stop_signals.h"
#include "apps/binding/thread_placement.h"
#include "devices/usb/falcon_guard.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <spdlog/spdlog.h>

namespace fathom {

namespace {

struct GuardOptions {
    std::string kind;
    std::string door;
    std::string firmware;
};

// Real-time priority, on any CPU: the engine's haptic thread has one for itself and they take turns.
void hurry() {
    ThreadPlacement placement = ThreadPlacement::ofThisProcess();
    placement.haptic = placement.all;
    const std::string refused = makeHapticThread(placement);
    if (!refused.empty()) {
        spdlog::warn("guard: refused {}; the exchange will be slower at times", refused);
    }
}

void runGuard(const GuardOptions& options) {
    const StopSignals signals;
    const std::filesystem::path door =
        options.door.empty() ? defaultDoor(options.kind) : std::filesystem::path(options.door);
    FalconGuard guard({door, options.firmware});
    std::cout << options.kind << " at " << guard.place() << ", door " << guard.door().path().string()
              << "; Ctrl-C ends with zero force" << std::endl;
    hurry();
    guard.run(signals.asked());
    const FalconFigures& f = guard.figures();
    std::cout << "ended with zero force after " << f.replies << " exchanges; " << f.late << " answers late, "
              << f.faults << " packets broken, " << guard.losses() << " times unplugged, "
              << guard.door().gate().silences() << " silences of the engine" << std::endl;
}

} // namespace

void addGuardCommand(CLI::App& app) {
    auto options = std::make_shared<GuardOptions>();
    CLI::App* command = app.add_subcommand("guard", "own a haptic device and open a door to it");
    command->add_option("DEVICE", options->kind, "what to guard")
        ->required()
        ->check(CLI::IsMember({"falcon"}));
    command->add_option("--door", options->door,
                        "socket to listen at (default $XDG_RUNTIME_DIR/fathom-DEVICE.door)");
    command->add_option("--firmware", options->firmware,
                        "the Falcon's firmware, for after power-on; none is shipped");
    command->callback([options] { runGuard(*options); });
}

} // namespace fathom
