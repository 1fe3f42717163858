// SPDX-License-Identifier: Apache-2.0
// fathom: haptic virtual fixtures from a live depth camera. Exit codes: 0 success, 1 a stated limit is
// violated or internal error, 2 bad input, 3 device lost.
#include "apps/arm_simulator/arm_simulator_command.h"
#include "apps/bridge/bridge_command.h"
#include "apps/clock/keep_clock_command.h"
#include "apps/convert/convert_command.h"
#include "apps/devices/devices_command.h"
#include "apps/empty_values.h"
#include "apps/global_options.h"
#include "apps/inspect/inspect_command.h"
#include "apps/latency/latency_command.h"
#include "apps/operate/operate_command.h"
#include "apps/operate/window_latency.h"
#include "apps/plan/plan_command.h"
#include "apps/profile/profile_command.h"
#include "apps/record/record_command.h"
#include "apps/refused_arguments.h"
#include "apps/register/register_command.h"
#include "apps/replay/replay_command.h"
#include "apps/spheres/spheres_command.h"
#include "apps/stability/stability_command.h"
#include "apps/tune/tune_command.h"
#include "apps/watchdog/arm_watchdog_command.h"
#include "engine/gpu/instance.h"
#include "engine/gpu/software_threads.h"
#include "engine/types/error.h"
#include "engine/types/version.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <memory>
#include <poll.h>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace {

// A file that is opened while a standard stream is closed gets its number, and log lines are written to it.
// So /dev/null takes these numbers. It cannot be written as standard output: a lost result is an error, as on
// a full disk.
void openStandardStreams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) { // the lowest free number is next
        if (::fcntl(stream, F_GETFD) < 0) {
            ::open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_RDWR);
        }
    }
}

// Also `fathom help [SUBCOMMAND]`, as many programs have it.
void addHelpCommand(CLI::App& app) {
    CLI::App* help =
        app.add_subcommand("help", "print the help of the program or of a subcommand")->group("");
    const auto name = std::make_shared<std::string>();
    help->add_option("SUBCOMMAND", *name);
    help->callback([&app, name] {
        if (name->empty()) {
            std::cout << app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
            return;
        }
        for (const CLI::App* command : app.get_subcommands(nullptr)) {
            if (command->check_name(*name)) {
                std::cout << command->help(app.get_name());
                return;
            }
        }
        throw fathom::BadInput("help", "subcommand", *name, "a name that fathom --help lists");
    });
}

void addCommands(CLI::App& app, fathom::GlobalOptions& global, int& result) {
    fathom::addReplayCommand(app, global, result);
    fathom::addOperateCommand(app, global);
    fathom::addRecordCommand(app, result);
    fathom::addInspectCommand(app);
    fathom::addConvertCommand(app);
    fathom::addDevicesCommand(app, global);
    fathom::addBridgeCommand(app);
    fathom::addPlanCommand(app, global);
    fathom::addSpheresCommand(app);
    fathom::addRegisterCommand(app, global);
    fathom::addTuneCommand(app, global, result);
    fathom::addLatencyCommand(app, global, fathom::operate::measureWindow, result);
    fathom::addProfileCommand(app, global);
    fathom::addStabilityCommand(app, global, result);
    fathom::addArmSimulatorCommand(app);
    fathom::addArmWatchdogCommand(app);
    fathom::addKeepClockCommand(app);
    addHelpCommand(app);
}

void warnOfUnusedTrace(const CLI::App& app, const std::string& trace) {
    const std::string command = app.get_subcommands().front()->get_name();
    if (!trace.empty() && command != "replay" && command != "profile") {
        spdlog::warn("{}: --trace is not used: replay and profile write a trace", command);
    }
}

int run(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a file at its size limit is then reported like a full disk
    CLI::App app("Haptic virtual fixtures from a live depth camera");
    app.require_subcommand(1);
    fathom::GlobalOptions global;
    app.add_option("--device", global.device, "Vulkan device: part of its name, or its index");
    app.add_option("--trace", global.trace,
                   "replay and profile: write a Chrome trace (JSON) of passes, queries and ticks");
    app.add_flag("--validate", global.validate,
                 "enable Vulkan validation with synchronisation; any message gives exit code 1");
    app.add_flag("--hold-clock", global.holdClock,
                 "keep an NVIDIA GPU at full clock while it waits for frames; uses more power");
    app.add_flag("-v,--verbose", global.verbose, "log more");
    app.set_version_flag("--version", std::string("fathom ") + fathom::version(), "print the version");
    app.fallthrough();
    app.parse_complete_callback([&app, &global] {
        spdlog::set_level(global.verbose ? spdlog::level::debug : spdlog::level::warn);
        warnOfUnusedTrace(app, global.trace);
    });
    int result = 0;
    addCommands(app, global, result);
    fathom::refuseEmptyValues(app);
    for (CLI::App* command : app.get_subcommands(nullptr)) {
        fathom::refuseEmptyValues(*command);
        command->footer("Options of every subcommand, such as --device and --verbose: fathom --help");
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) {
            return app.exit(e); // --help
        }
        std::cerr << "fathom: " << fathom::refusalOf(app, e) << "\n";
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

// Reports a full disk under standard output, and one that is closed. A reader that closed its pipe wants no
// more.
int flushed(int result) {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) {
        return result;
    }
    const int reason = errno;
    pollfd pipe{STDOUT_FILENO, POLLOUT, 0};
    if (reason != EPIPE && !(::poll(&pipe, 1, 0) == 1 && (pipe.revents & POLLERR) != 0)) {
        std::cerr << "fathom: standard output: cannot be written"
                  << (reason != 0 ? std::string(" (") + std::strerror(reason) + ")" : std::string()) << "\n";
    }
    return result == 0 ? 1 : result;
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
    openStandardStreams();
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
    return judged(flushed(result));
}
