// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/open_hand.h"

#include "devices/bridge/socket_hand.h"
#include "devices/recorded/hand_csv.h"
#include "devices/usb/space_mouse_hand.h"
#include "engine/haptics/device_preset.h"
#include "engine/run/open_scene.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

namespace fathom {

namespace {

const std::string kSpaceMouse = "spacemouse";

std::unique_ptr<LiveHand> open(const std::string& name, uint32_t clutchBit) {
    if (name == kSpaceMouse || name.starts_with(kSpaceMouse + ":")) {
        SpaceMouseOptions options;
        options.clutchBit = clutchBit;
        return std::make_unique<SpaceMouseHand>(name.substr(std::min(name.size(), kSpaceMouse.size() + 1)),
                                                options);
    }
    const bool bridged = name == "falcon" || name == "haply" || name == "ros2"; // through `fathom guard`
    if (bridged) {
        return std::make_unique<SocketHand>(
            defaultEndpoint(name, "--hand-device PATH, the socket of the bridge"), clutchBit);
    }
    std::error_code failed;
    if (name.find('/') == std::string::npos && !std::filesystem::exists(name, failed)) {
        throw BadInput("--hand-device", name, "no such device and no socket",
                       "falcon, haply, ros2, spacemouse, or the socket of a bridge");
    }
    return std::make_unique<SocketHand>(name, clutchBit);
}

std::string listed(const AxisMask& axes) {
    static const char* const kNames[] = {"x", "y", "z", "rx", "ry", "rz"};
    std::string text;
    for (size_t i = 0; i < axes.size(); ++i) {
        if (axes[i]) {
            text.append(text.empty() ? "" : " ").append(kNames[i]);
        }
    }
    return text.empty() ? "nothing" : text;
}

} // namespace

std::unique_ptr<LiveHand> openLiveHand(const std::string& name, Scene& scene) {
    auto hand = open(name, scene.hand.clutchBit);
    const DevicePreset* preset = findPreset(hand->preset());
    if (preset == nullptr) {
        throw BadInput("--hand-device", "preset", "'" + hand->preset() + "'", presetNames());
    }
    scene.haptics.device = preset->name;
    return hand;
}

std::string axesOf(const std::string& preset) {
    const DevicePreset& device = devicePreset(preset);
    const AxisMask& drives = device.actuated;
    const bool force = drives[0] || drives[1] || drives[2], torque = drives[3] || drives[4] || drives[5];
    std::string text = listed(device.sensed) + " sensed, " + listed(drives) + " driven";
    if (!force) {
        text += "; force and torque are shown, not felt";
    } else if (!torque) {
        text += "; torque is shown, not felt";
    }
    return text;
}

bool awaitHand(LiveHand& hand, const std::atomic<bool>& stop, double seconds) {
    const auto began = std::chrono::steady_clock::now();
    const auto waited = [began] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    bool reported = false;
    for (;;) {
        hand.read(0.0);
        if (hand.alive()) {
            return true;
        }
        if (stop.load()) {
            return false;
        }
        if (seconds > 0.0 && waited() >= seconds) {
            throw DeviceLost(
                fmt::format("{}: no usable sample in --seconds {:.4g}", hand.description(), seconds));
        }
        if (!reported && waited() > 1.0) {
            log::warn("waiting for a usable sample of {}: check that it is plugged in and homed",
                      hand.description());
            reported = true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

namespace {

// Least distance [m] of the path from the base's origin, the camera and the placed shapes.
double distanceOf(const HandPath& path, const Scene& scene) {
    std::vector<dvec3> places{dvec3(0.0), scene.baseTcamera.position};
    for (const FixtureClass& f : scene.fixtures) {
        places.push_back(f.isPoints() ? dvec3(0.0) : f.baseTshape.position);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const HandWaypoint& waypoint : path.waypoints()) {
        const dvec3 at = scene.hand.scale * (scene.hand.baseRdevice * waypoint.deviceThandle.position);
        for (const dvec3& place : places) {
            least = std::min(least, glm::distance(at, place));
        }
    }
    return least;
}

} // namespace

HandPath openHandPath(const std::filesystem::path& file, const Scene& scene, bool poseless) {
    constexpr double kUsualPath = 10.0;                   // [m] most
    constexpr double kUsualPlace = 20.0, kMapPlace = 2e4; // [m] farther, the base frame is that of a map
    HandPath path(readHandCsv(file));
    dvec3 low(path.waypoints()[0].deviceThandle.position), high(low);
    for (const HandWaypoint& waypoint : path.waypoints()) {
        low = glm::min(low, waypoint.deviceThandle.position);
        high = glm::max(high, waypoint.deviceThandle.position);
    }
    const dvec3 size = scene.hand.scale * (high - low);
    const double length = std::max({size.x, size.y, size.z}), away = distanceOf(path, scene) - scene.farZ;
    warnIfLong(file.string() + ": the hand moves", length, kUsualPath);
    const bool placed = poseless || scene.source.kind == CameraSource::Kind::Simulated;
    if (length <= kUsualPath && placed && away < kMapPlace) {
        warnIfLong(file.string() + ": what the camera sees and the hand's way are apart by", away,
                   kUsualPlace);
    }
    return path;
}

} // namespace fathom
