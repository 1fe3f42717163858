// SPDX-License-Identifier: Apache-2.0
// From what --hand-device names to a live haptic device.
#pragma once

#include "devices/live_hand.h"
#include "engine/scene/scene.h"

#include <atomic>
#include <memory>
#include <string>

namespace fathom {

// What --hand-device takes.
inline constexpr const char* kHandHelp =
    "a live hand: falcon, haply, spacemouse[:/dev/hidrawN], or the socket of a bridge";

// name: "falcon" or "haply" (the default door of `fathom guard` of it), "spacemouse",
// "spacemouse:/dev/hidrawN", or the path of a hand door. The device's own preset takes the place of the
// scene's haptics.device. Throws BadInput.
std::unique_ptr<LiveHand> openLiveHand(const std::string& name, Scene& scene);

// Which axes it senses and drives, in one line: "x y z sensed, x y z driven; torque is shown, not felt".
std::string axesOf(const std::string& preset);

// Until the device gives poses (plugged in, homed) or `stop`: false then. Tells once what it waits for.
bool awaitHand(LiveHand& hand, const std::atomic<bool>& stop);

} // namespace fathom
