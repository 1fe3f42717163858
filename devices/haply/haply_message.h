// SPDX-License-Identifier: Apache-2.0
// The messages of Haply's Inverse Service, 3.1 and later, as far as a hand needs them. Source: docs.haply.co,
// inverseSDK/service/realtime: websocket-protocol and control-commands.
#pragma once

#include "devices/haptic_device.h"

#include <optional>
#include <string>
#include <string_view>

namespace fathom {

// The state of one Inverse3, and of the grip on it, as the service tells it.
struct HaplyState {
    std::string device; // device_id of the Inverse3
    HandSample sample;  // cursor_position [m], the service's application space; orientation and buttons of a
                        // VerseGrip where one is there: a guidance, b clutch
    bool grip = false;
};

// Of the Inverse3 with this id, of the first one when it is empty. Nothing: no such device in it. Throws
// Error that says what is wrong with a message that is none.
std::optional<HaplyState> readHaplyState(std::string_view message, const std::string& device);

// A force [N] for a tick, after which the device is idle again; the service answers with one state. name: of
// this program, in the first message of a connection; else empty.
std::string haplyForce(const std::string& device, const dvec3& force, const std::string& name = "");

} // namespace fathom
