// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/device_bridge.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <chrono>
#include <thread>

namespace fathom {

void DeviceBridge::waitForDevice(const std::atomic<bool>& stop) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(250);
    while (!stop.load() && std::chrono::steady_clock::now() < until) {
        endpoint_->poll();
        endpoint_->send(sample_, 0);
        std::this_thread::sleep_for(2 * kWait);
    }
    try {
        open();
    } catch (const Error& e) { // not present yet, or not ready
        log::debug("{}{}", label_, e.what());
    }
}

void DeviceBridge::run(const std::atomic<bool>& stop) {
    while (!stop.load()) {
        if (!isOpen()) {
            waitForDevice(stop);
            continue;
        }
        try {
            exchange();
        } catch (const DeviceLost& e) {
            ++losses_;
            log::warn("{}{}: reported to the engine, reconnecting", label_, e.what());
            close();
        }
    }
    close();
}

} // namespace fathom
