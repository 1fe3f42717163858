// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/haply_message.h"

#include "engine/include/fathom/device_socket.h"
#include "engine/types/error.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

namespace fathom {

namespace {

using Json = nlohmann::json;

double numberAt(const Json& object, const char* key) {
    const auto found = object.find(key);
    const double value = found != object.end() && found->is_number() ? found->get<double>() : NAN;
    if (!std::isfinite(value)) {
        throw Error(std::string("the service's state lacks the number '") + key + "'");
    }
    return value;
}

// The list entry with a state and this id; null when there is none.
const Json* stateOf(const Json& all, const char* kind, const std::string& device, std::string& found) {
    const auto list = all.find(kind);
    if (list == all.end() || !list->is_array()) {
        return nullptr;
    }
    for (const Json& one : *list) {
        const bool whole = one.is_object() && one.contains("device_id") && one["device_id"].is_string() &&
                           !one["device_id"].get_ref<const std::string&>().empty() && one.contains("state") &&
                           one["state"].is_object();
        if (whole && (device.empty() || one["device_id"].get<std::string>() == device)) {
            found = one["device_id"].get<std::string>();
            return &one["state"];
        }
    }
    return nullptr;
}

void takeGrip(const Json& state, HaplyState& out) {
    const auto turned = state.find("orientation");
    if (turned == state.end() || !turned->is_object()) {
        return;
    }
    const dquat q(numberAt(*turned, "w"), numberAt(*turned, "x"), numberAt(*turned, "y"),
                  numberAt(*turned, "z"));
    if (!(glm::dot(q, q) > 1e-6)) {
        throw Error("the service's state has a zero orientation");
    }
    out.grip = true;
    out.sample.deviceThandle.rotation = glm::normalize(q);
    const auto pressed = [&](const char* name) {
        const auto buttons = state.find("buttons");
        return buttons != state.end() && buttons->is_object() && buttons->contains(name) &&
               (*buttons)[name].is_boolean() && (*buttons)[name].get<bool>();
    };
    out.sample.buttons =
        (pressed("a") ? FATHOM_DOOR_GUIDANCE : 0u) | (pressed("b") ? FATHOM_DOOR_CLUTCH : 0u);
}

} // namespace

std::optional<HaplyState> readHaplyState(std::string_view message, const std::string& device) {
    const Json all = Json::parse(message, nullptr, false);
    if (!all.is_object()) {
        throw Error("the service's message is not a JSON object");
    }
    HaplyState out;
    const Json* state = stateOf(all, "inverse3", device, out.device);
    if (state == nullptr) {
        return std::nullopt;
    }
    const auto place = state->find("cursor_position");
    if (place == state->end() || !place->is_object()) {
        throw Error("the service's state has no cursor_position");
    }
    out.sample.deviceThandle.position = {numberAt(*place, "x"), numberAt(*place, "y"), numberAt(*place, "z")};
    std::string grip;
    for (const char* kind : {"verse_grip", "wireless_verse_grip"}) {
        if (const Json* held = stateOf(all, kind, "", grip); held != nullptr && !out.grip) {
            takeGrip(*held, out);
        }
    }
    return out;
}

std::string haplyForce(const std::string& device, const dvec3& force, const std::string& name) {
    Json message = {
        {"inverse3",
         {{{"device_id", device},
           {"commands",
            {{"set_cursor_force", {{"vector", {{"x", force.x}, {"y", force.y}, {"z", force.z}}}}}}}}}}};
    if (!name.empty()) {
        message["session"] = {{"configure", {{"profile", {{"name", name}}}}}};
    }
    return message.dump();
}

} // namespace fathom
