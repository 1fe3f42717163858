// SPDX-License-Identifier: Apache-2.0
#include "apps/bridge/bridge_command.h"

#include "apps/binding/stop_signals.h"
#include "apps/number_option.h"
#include "devices/haply/haply_bridge.h"
#include "devices/ros2/ros2_bridge.h"
#include "devices/usb/falcon_bridge.h"
#include "engine/haptics/device_preset.h"
#include "engine/run/thread_placement.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/parse_number.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

namespace fathom {

namespace {

struct BridgeOptions {
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

template <class Bridge>
void runBridge(Bridge& bridge, const BridgeOptions& options, const StopSignals& signals) {
    std::cout << options.kind << " at " << bridge.place() << ", socket " << bridge.endpoint().path().string()
              << "; Ctrl-C ends with zero force" << std::endl;
    hurry();
    bridge.run(signals.requested());
    const auto& f = bridge.figures();
    std::cout << "ended with zero force after " << f.replies << " exchanges; " << f.late << " answers late, "
              << f.faults << " packets broken, " << bridge.losses() << " times unplugged, "
              << bridge.endpoint().gate().silences() << " engine timeouts" << std::endl;
}

HaplyBridge::Options haplyOptions(const BridgeOptions& options, const std::filesystem::path& endpoint) {
    HaplyBridge::Options haply{endpoint, "", 0, options.device};
    const size_t colon = options.service.rfind(':');
    const std::string port = colon == std::string::npos ? "" : options.service.substr(colon + 1);
    if (colon == 0 || !parseWhole(port, haply.port) || haply.port == 0) {
        throw BadInput("guard", "--service", options.service, "HOST:PORT");
    }
    haply.host = options.service.substr(0, colon);
    return haply;
}

void bridgeDevice(const BridgeOptions& options) {
    const StopSignals signals;
    const std::filesystem::path endpoint = options.endpoint.empty()
                                               ? defaultEndpoint(options.kind, "--door PATH")
                                               : std::filesystem::path(options.endpoint);
    if (options.kind == "haply") {
        HaplyBridge bridge(haplyOptions(options, endpoint));
        runBridge(bridge, options, signals);
    } else if (options.kind == "ros2") {
        const Ros2HandRequest request = parseRos2HandRequest(options.topics);
        const DevicePreset& preset = devicePreset(request.preset);
        const auto bridge = openRos2Bridge(request, endpoint, preset.forceLimit, preset.torqueLimit);
        runBridge(*bridge, options, signals);
    } else {
        FalconBridge bridge({endpoint, options.firmware});
        runBridge(bridge, options, signals);
    }
}

} // namespace

void addBridgeCommand(CLI::App& app) {
    auto options = std::make_shared<BridgeOptions>();
    CLI::App* command =
        app.add_subcommand("guard", "run the bridge of a haptic device, which shares it through a socket");
    command->alias("bridge");
    command->add_option("DEVICE", options->kind, "device to drive")
        ->required()
        ->check(wordIn({"falcon", "haply", "ros2"}));
    command->add_option("--door", options->endpoint,
                        "socket to listen on (default: $XDG_RUNTIME_DIR/fathom-DEVICE.door)");
    command->add_option("--firmware", options->firmware,
                        "Falcon firmware file, needed after power-on; not included");
    command->add_option("--service", options->service,
                        "HOST:PORT of Haply's Inverse Service (default: localhost:10001)");
    command->add_option("--inverse3,--device", options->device, "id of the Inverse3 (default: the first)");
    command->add_option("--topics", options->topics,
                        "pose=TOPIC[,KEY=VALUE]... of the node of ROS 2 that drives the device");
    command->callback([options] { bridgeDevice(*options); });
}

} // namespace fathom
