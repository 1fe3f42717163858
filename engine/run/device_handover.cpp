// SPDX-License-Identifier: Apache-2.0
#include "engine/run/device_handover.h"

#include <chrono>

namespace fathom {

namespace {

constexpr auto kPoll = std::chrono::milliseconds(5); // poll interval of `stop`, which has no notification

} // namespace

DeviceHandover::State DeviceHandover::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

void DeviceHandover::change(State from, State to) {
    const std::lock_guard lock(mutex_);
    if (state_ == from) {
        state_ = to;
        changed_.notify_all();
    }
}

DeviceHandover::State DeviceHandover::awaitOther(State than, const std::atomic<bool>& stop) {
    std::unique_lock lock(mutex_);
    while (state_ == than && !stop.load(std::memory_order_relaxed)) {
        changed_.wait_for(lock, kPoll);
    }
    return state_;
}

void DeviceHandover::lose(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (state_ == State::InUse || state_ == State::Offered) {
        state_ = State::Lost;
        why_ = why;
        changed_.notify_all();
    }
}

bool DeviceHandover::lost() const {
    const State now = state();
    return now == State::Lost || now == State::Released;
}

bool DeviceHandover::notInUse() const {
    return state() != State::InUse;
}

std::string DeviceHandover::why() const {
    const std::lock_guard lock(mutex_);
    return why_;
}

bool DeviceHandover::awaitRelease(const std::atomic<bool>& stop) {
    return awaitOther(State::Lost, stop) == State::Released && !stop.load(std::memory_order_relaxed);
}

bool DeviceHandover::offer(const std::atomic<bool>& stop) {
    change(State::Released, State::Offered);
    return awaitOther(State::Offered, stop) == State::InUse;
}

bool DeviceHandover::wanted() const {
    return state() == State::Lost;
}

void DeviceHandover::release() {
    change(State::Lost, State::Released);
}

bool DeviceHandover::offered() const {
    return state() == State::Offered;
}

void DeviceHandover::accept() {
    change(State::Offered, State::InUse);
}

} // namespace fathom
