// SPDX-License-Identifier: Apache-2.0
#include "apps/guard/guard_command.h"

#include "apps/binding/stop_signals.h"
#include "apps/number_option.h"
#include "devices/haply/haply_bridge.h"
#include "devices/ros2/ros2_bridge.h"
#include "devices/usb/falcon_bridge.h"
#include "engine/haptics/device_preset.h"
#include "engine/run/thread_placement.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>
#include <memory>

namespace fathom {

namespace {

struct GuardOptions {
    std::string kind;
    std::string endpoint;
    std::string firmware;
    std::string service = "localhost:10001"; // of Haply
    std::string device;                      // its id; empty = the first
    std::string topics;                      // of ROS 2
};

// Real-time priority on any CPU: the engine's haptic thread has its own CPU, and the two alternate.
void hurry() {
    ThreadPlacement placement = ThreadPlacement::ofThisProcess();
    placement.haptic = placement.all;
    const std::string refused = makeHapticThread(placement);
    if (!refused.empty()) {
        log::warn("guard: no permission for {}; the exchange may be slower at times", refused);
    }
}

template <class Guard>
void runGuard(Guard& guard, const GuardOptions& options, const StopSignals& signals) {
    std::cout << options.kind << " at " << guard.place() << ", socket " << guard.endpoint().path().string()
              << "; Ctrl-C ends with zero force" << std::endl;
    hurry();
    guard.run(signals.asked());
    const auto& f = guard.figures();
    std::cout << "ended with zero force after " << f.replies << " exchanges; " << f.late << " answers late, "
              << f.faults << " packets broken, " << guard.losses() << " times unplugged, "
              << guard.endpoint().gate().silences() << " engine timeouts" << std::endl;
}

HaplyBridge::Options haplyOptions(const GuardOptions& options, const std::filesystem::path& endpoint) {
    HaplyBridge::Options haply{endpoint, "", 0, options.device};
    const size_t colon = options.service.rfind(':');
    const std::string port = colon == std::string::npos ? "" : options.service.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), haply.port);
    if (colon == 0 || error != std::errc() || end != port.data() + port.size() || haply.port == 0) {
        throw BadInput("guard", "--service", options.service, "HOST:PORT");
    }
    haply.host = options.service.substr(0, colon);
    return haply;
}

void guardDevice(const GuardOptions& options) {
    const StopSignals signals;
    const std::filesystem::path endpoint =
        options.endpoint.empty() ? defaultEndpoint(options.kind) : std::filesystem::path(options.endpoint);
    if (options.kind == "haply") {
        HaplyBridge guard(haplyOptions(options, endpoint));
        runGuard(guard, options, signals);
    } else if (options.kind == "ros2") {
        const Ros2HandRequest request = parseRos2HandRequest(options.topics);
        const DevicePreset& preset = devicePreset(request.preset);
        const auto guard = openRos2Bridge(request, endpoint, preset.forceLimit, preset.torqueLimit);
        runGuard(*guard, options, signals);
    } else {
        FalconBridge guard({endpoint, options.firmware});
        runGuard(guard, options, signals);
    }
}

} // namespace

void addGuardCommand(CLI::App& app) {
    auto options = std::make_shared<GuardOptions>();
    CLI::App* command = app.add_subcommand("guard", "drive a haptic device and share it through a socket");
    command->add_option("DEVICE", options->kind, "device to drive")
        ->required()
        ->check(wordIn({"falcon", "haply", "ros2"}));
    command->add_option("--door", options->endpoint,
                        "socket to listen on (default: $XDG_RUNTIME_DIR/fathom-DEVICE.door)");
    command->add_option("--firmware", options->firmware,
                        "Falcon firmware file, needed after power-on; not included");
    command->add_option("--service", options->service,
                        "HOST:PORT of Haply's Inverse Service (default: localhost:10001)");
    command->add_option("--device", options->device, "id of the Inverse3 (default: the first)");
    command->add_option("--topics", options->topics,
                        "pose=TOPIC[,KEY=VALUE]... of the node of ROS 2 that drives the device");
    command->callback([options] { guardDevice(*options); });
}

} // namespace fathom
