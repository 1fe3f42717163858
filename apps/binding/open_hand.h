// SPDX-License-Identifier: Apache-2.0
// Opens the live haptic device that --hand-device names, and hand paths.
#pragma once

#include "devices/live_hand.h"
#include "devices/simulated/hand_path.h"
#include "engine/scene/scene.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

namespace fathom {

// Help text of --hand-device.
inline constexpr const char* kHandHelp =
    "a live hand: falcon, haply, ros2, spacemouse[:/dev/hidrawN], or the socket of a bridge";

// name: "falcon", "haply" or "ros2" (the default socket of its `fathom guard`), "spacemouse",
// "spacemouse:/dev/hidrawN", or the path of a bridge's socket. The device's own preset replaces the scene's
// haptics.device. Throws BadInput.
std::unique_ptr<LiveHand> openLiveHand(const std::string& name, Scene& scene);

// The axes that it senses and drives, in one line: "x y z sensed, x y z driven; torque is shown, not felt".
std::string axesOf(const std::string& preset);

// Waits until the device sends poses (plugged in and homed); false when `stop` is set first. Logs once what
// it waits for. Throws DeviceLost after this time [s]; 0 = never.
bool awaitHand(LiveHand& hand, const std::atomic<bool>& stop, double seconds);

// The path of a CSV file. Logs a warning when, scaled, it is so long, or so far from everything in the scene,
// that its unit may be the millimetre. poseless: no frame has a pose, so that the scene's place of the camera
// holds. Throws BadInput.
HandPath openHandPath(const std::filesystem::path& file, const Scene& scene, bool poseless);

} // namespace fathom
