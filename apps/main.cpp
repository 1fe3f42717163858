// SPDX-License-Identifier: Apache-2.0
// fathom: haptic virtual fixtures from a live depth camera. Exit codes: 0 success, 1 a stated limit is
// violated or internal error, 2 bad input, 3 device lost.
#include "apps/arm_simulator/arm_simulator_command.h"
#include "apps/bridge/bridge_command.h"
#include "apps/clock/keep_clock_command.h"
#include "apps/convert/convert_command.h"
#include "apps/devices/devices_command.h"
#include "apps/global_options.h"
#include "apps/inspect/inspect_command.h"
#include "apps/latency/latency_command.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/window_latency.h"
#include "apps/plan/plan_command.h"
#include "apps/profile/profile_command.h"
#include "apps/record/record_command.h"
#include "apps/register/register_command.h"
#include "apps/replay/replay_command.h"
#include "apps/spheres/spheres_command.h"
#include "apps/stability/stability_command.h"
#include "apps/tune/tune_command.h"
#include "apps/watchdog/arm_watchdog_command.h"
#include "engine/gpu/instance.h"
#include "engine/gpu/software_threads.h"
#include "engine/scene/yaml_node.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/version.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace {

// A command-line error as one line: option, value, what is allowed.
std::string refusalOf(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const std::vector<std::string> rest = app.remaining(true);
    std::vector<std::string> names;
    const auto unknown = [&](const std::string& word) {
        return "'" + word + "'" +
               fathom::suggestion(word, std::vector<std::string_view>(names.begin(), names.end()));
    };
    if (chosen.empty()) {
        for (const CLI::App* command : app.get_subcommands(nullptr)) {
            if (!command->get_group().empty()) { // internal commands have no group
                names.push_back(command->get_name());
            }
        }
        return "subcommand: " + (rest.empty() ? "missing" : unknown(rest.front())) +
               " (allowed: " + fathom::joined(names) + ")";
    }
    if (!rest.empty()) {
        for (const CLI::App* owner : {static_cast<const CLI::App*>(chosen.back()), &app}) {
            for (const CLI::Option* option : owner->get_options()) {
                if (owner != &app || option != app.get_help_ptr()) { // the subcommand has its own
                    names.push_back(option->get_name());
                }
            }
        }
        return chosen.back()->get_name() + ": " + unknown(rest.front()) +
               " (allowed: " + fathom::joined(names) + ")";
    }
    std::string text = chosen.back()->get_name() + ": " + error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

int run(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a file at its size limit is then reported like a full disk
    CLI::App app("Haptic virtual fixtures from a live depth camera");
    app.require_subcommand(1);
    fathom::GlobalOptions global;
    app.add_option("--device", global.device, "Vulkan device: part of its name, or its index");
    app.add_option("--trace", global.trace, "write a Chrome trace (JSON) of passes, queries and ticks");
    app.add_flag("--validate", global.validate,
                 "enable Vulkan validation with synchronisation; any message gives exit code 1");
    app.add_flag("--hold-clock", global.holdClock,
                 "keep an NVIDIA GPU at full clock while it waits for frames; uses more power");
    app.add_flag("-v,--verbose", global.verbose, "log more");
    app.set_version_flag("--version", std::string("fathom ") + fathom::version(), "print the version");
    app.fallthrough();
    app.parse_complete_callback(
        [&global] { spdlog::set_level(global.verbose ? spdlog::level::debug : spdlog::level::warn); });
    fathom::addPlanCommand(app, global);
    fathom::addInspectCommand(app);
    fathom::addConvertCommand(app);
    fathom::addRegisterCommand(app, global);
    fathom::addBridgeCommand(app);
    fathom::addArmWatchdogCommand(app);
    fathom::addArmSimulatorCommand(app);
    fathom::addKeepClockCommand(app);
    fathom::addDevicesCommand(app, global);
    fathom::addProfileCommand(app, global);
    int result = 0;
    fathom::addReplayCommand(app, global, result);
    fathom::addSpheresCommand(app);
    fathom::addOperateCommand(app, global);
    fathom::addStabilityCommand(app, global, result);
    fathom::addTuneCommand(app, global, result);
    fathom::addRecordCommand(app, result);
    fathom::addLatencyCommand(app, global, fathom::operate::measureWindow, result);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) {
            return app.exit(e); // --help
        }
        std::cerr << "fathom: " << refusalOf(app, e) << "\n";
        return 2;
    }
    return result;
}

// A terminal that is stopped, or a full pipe, must not hold up a thread that logs, as the one that commands
// the motors: a thread of its own writes the lines, and the oldest are dropped when too many wait.
void startLog() {
    constexpr size_t kWaiting = 4096;
    spdlog::init_thread_pool(kWaiting, 1);
    spdlog::set_default_logger(std::make_shared<spdlog::async_logger>(
        "fathom", std::make_shared<spdlog::sinks::stderr_sink_mt>(), spdlog::thread_pool(),
        spdlog::async_overflow_policy::overrun_oldest));
    spdlog::set_pattern("%l: %v");
}

// The exit code of the command, or 1 when the validation layer reported messages.
int judged(int result) {
    const uint32_t messages = fathom::gpu::validationMessages();
    if (messages == 0) {
        return result;
    }
    std::cerr << "fathom: " << messages << " Vulkan validation messages\n";
    return result == 0 ? 1 : result;
}

} // namespace

int main(int argc, char** argv) {
    int result = 1;
    std::string failure;
    try {
        fathom::gpu::askForSoftwareThreads();
        startLog();
        result = run(argc, argv);
    } catch (const fathom::Error& e) {
        failure = e.what();
        result = e.exitCode();
    } catch (const std::exception& e) {
        failure = std::string("internal error: ") + e.what();
    }
    spdlog::shutdown(); // its lines come before the last ones
    if (!failure.empty()) {
        std::cerr << "fathom: " << failure << "\n";
    }
    return judged(result);
}
