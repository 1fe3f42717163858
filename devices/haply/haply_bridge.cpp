// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/haply_bridge.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <thread>

namespace fathom {

namespace {

constexpr auto kConnect = std::chrono::milliseconds(2000);
constexpr double kNoTorque = 0.0; // the handle turns freely
constexpr const char* kName = "fathom";

} // namespace

HaplyBridge::HaplyBridge(const Options& options)
    : DeviceBridge("")
    , options_(options)
    , device_(options.device) {
    endpoint_.emplace(
        SocketServer::Options{options.endpoint, "inverse3", "Haply Inverse3", kForceLimit, kNoTorque});
    connect();
}

HaplyBridge::~HaplyBridge() {
    close();
}

// On connection the service lists its devices. After a reconnect the same device is chosen again, because the
// pilot's hand is on it.
void HaplyBridge::connect() {
    auto service = std::make_unique<WebSocket>(options_.host, options_.port, kConnect);
    const auto inventory = service->receive(kConnect);
    if (!inventory) {
        throw Error(service->place() + ": no message");
    }
    const auto state = readHaplyState(*inventory, device_);
    if (!state) {
        throw BadInput("haply", service->place(),
                       "has no Inverse3" + (device_.empty() ? "" : " '" + device_ + "'"),
                       "a service that lists it");
    }
    device_ = state->device;
    sample_ = state->sample;
    place_ = service->place();
    service_ = std::move(service);
    introduced_ = false;
    awaited_ = 0;
    present_ = true;
    receivedAt_ = Clock::now();
}

void HaplyBridge::open() {
    connect();
    log::warn("inverse3 {}: back at {}", device_, place_);
}

void HaplyBridge::ask(const dvec3& force) {
    service_->send(haplyForce(device_, force, introduced_ ? "" : kName));
    introduced_ = true;
    ++awaited_;
    requestedAt_ = Clock::now();
}

// Reads an answer, if one arrives in time. The service answers in order, so a state is fresh only if no other
// answer is awaited. If it does not contain the device, the device is absent.
bool HaplyBridge::answered(std::chrono::microseconds most) {
    const auto message = service_->receive(most);
    if (!message) {
        return false;
    }
    receivedAt_ = Clock::now();
    ++figures_.replies;
    if (awaited_ > 1) {
        --awaited_;
        ++figures_.surplus;
        return false;
    }
    awaited_ = 0;
    try {
        const auto state = readHaplyState(*message, device_);
        if (present_ != state.has_value()) {
            present_ = state.has_value();
            losses_ += present_ ? 0 : 1;
            log::warn("inverse3 {}: {}", device_, present_ ? "back" : "gone from the service");
        }
        if (state) {
            sample_ = state->sample;
        }
    } catch (const Error& e) { // the next one may be valid
        ++figures_.faults;
        log::debug("{}", e.what());
        return false;
    }
    return true;
}

// Asks again after a request without an answer. Answers that are awaited still when others have come are
// lost.
void HaplyBridge::giveUpLate(Clock::time_point now) {
    if (awaited_ == 0 || now - std::max(requestedAt_, receivedAt_) <= kReplyTime) {
        return;
    }
    ++figures_.late;
    awaited_ = receivedAt_ > requestedAt_ ? 0 : awaited_;
    ask(present_ ? endpoint_->wrench().force : dvec3(0.0));
}

void HaplyBridge::exchange() {
    endpoint_->poll();
    const auto now = Clock::now();
    if (now - receivedAt_ > kLostAfter) {
        throw DeviceLost(place_ + ": silent");
    }
    giveUpLate(now);
    if (awaited_ == 0) {
        if (const auto since = now - requestedAt_; since < kPeriod) {
            std::this_thread::sleep_for(kPeriod - since);
            endpoint_->poll();
        }
        ask(present_ ? endpoint_->wrench().force : dvec3(0.0));
    }
    if (answered(kWait)) {
        endpoint_->send(sample_, present_ ? FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED : 0);
    }
}

// Sends zero force and waits briefly for the answer.
void HaplyBridge::close() noexcept {
    if (!service_) {
        return;
    }
    try {
        ask(dvec3(0.0));
        answered(kReplyTime);
    } catch (const std::exception&) { // already lost
    }
    service_.reset();
    present_ = false;
}

} // namespace fathom
