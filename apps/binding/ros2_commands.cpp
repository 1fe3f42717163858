// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_commands.h"

#include "devices/bag/message_cursor.h"
#include "engine/types/log.h"

#include <utility>

namespace fathom {

namespace {

constexpr const char* kSwitch = "std_msgs/msg/Bool";
constexpr const char* kSwitchCall = "std_srvs/srv/SetBool";

} // namespace

Ros2Commands::Ros2Commands(std::shared_ptr<Ros2Graph> graph, const std::string& prefix)
    : inbox_(graph)
    , forcesOff_(inbox_.subscribe(prefix + "/forces_off", "std_msgs/msg/Empty", Ros2Qos::Reliable))
    , guidance_(inbox_.subscribe(prefix + "/guidance", kSwitch, Ros2Qos::Reliable))
    , freeze_(inbox_.subscribe(prefix + "/freeze", kSwitch, Ros2Qos::Reliable))
    , forcesOffCall_(graph, inbox_, prefix + "/forces_off", "std_srvs/srv/Trigger")
    , guidanceCall_(graph, inbox_, prefix + "/guidance", kSwitchCall)
    , freezeCall_(graph, inbox_, prefix + "/freeze", kSwitchCall) {}

std::optional<bool> Ros2Commands::newest(size_t topic, const char* name) {
    std::optional<bool> value;
    for (const Ros2Message& taken : inbox_.take(topic)) {
        try {
            value = MessageCursor(taken.message->bytes(), true).value<uint8_t>() != 0;
        } catch (const Error& e) {
            if (!std::exchange(logged_, true)) {
                log::warn("ros2: {}: message skipped: {} (logged once)", name, e.what());
            }
        }
    }
    return value;
}

// Whatever a request to stop contains, it stops.
void Ros2Commands::receiveTopics() {
    const bool off = !inbox_.take(forcesOff_).empty();
    const std::optional<bool> guidance = newest(guidance_, "guidance"), freeze = newest(freeze_, "freeze");
    const std::lock_guard lock(mutex_);
    requests_.forcesOff = requests_.forcesOff || off;
    requests_.guidance = guidance ? guidance : requests_.guidance;
    requests_.frozen = freeze ? freeze : requests_.frozen;
}

// The reply confirms that the request was queued.
void Ros2Commands::serve() {
    const auto set = [this](std::optional<bool>& request, const char* on, const char* off) {
        return [this, &request, on, off](MessageCursor& message) {
            const bool value = message.value<uint8_t>() != 0;
            const std::lock_guard lock(mutex_);
            request = value;
            return std::string(value ? on : off);
        };
    };
    forcesOffCall_.serve([this](MessageCursor&) {
        const std::lock_guard lock(mutex_);
        requests_.forcesOff = true;
        return std::string("forces are switched off");
    });
    guidanceCall_.serve(set(requests_.guidance, "guidance is switched on", "guidance is switched off"));
    freezeCall_.serve(set(requests_.frozen, "fixtures are frozen", "fixtures are released"));
}

void Ros2Commands::receive() {
    receiveTopics();
    serve();
}

RemoteRequests Ros2Commands::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(requests_, {});
}

} // namespace fathom
