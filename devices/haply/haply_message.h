// SPDX-License-Identifier: Apache-2.0
// The subset of messages of Haply's Inverse Service, 3.1 and later, that a hand needs. Source: docs.haply.co,
// inverseSDK/service/realtime: websocket-protocol and control-commands.
#pragma once

#include "engine/types/haptic_device.h"

#include <optional>
#include <string>
#include <string_view>

namespace fathom {

// The state of one Inverse3, and of the grip on it, as the service reports it.
struct HaplyState {
    std::string device; // device_id of the Inverse3
    HandSample sample;  // cursor_position [m], the service's application space; orientation and buttons of a
                        // VerseGrip where one is there: a guidance, b clutch
    bool grip = false;
};

// Parses the state of the Inverse3 with this id, or of the first when empty. Empty when the message has no
// such device. Throws Error that describes an invalid message.
std::optional<HaplyState> readHaplyState(std::string_view message, const std::string& device);

// A request for a force [N] of one tick; the service answers with one state. name: of this program, in the
// first message of a connection, else empty.
std::string haplyForce(const std::string& device, const dvec3& force, const std::string& name = "");

} // namespace fathom
