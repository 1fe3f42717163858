// SPDX-License-Identifier: Apache-2.0
// Two threads share a device that either of them loses again and again: neither uses a lost device.
#include "engine/run/device_handover.h"

#include <doctest/doctest.h>
#include <memory>
#include <thread>

using namespace fathom;

namespace {

constexpr int kLosses = 200;

// Plain numbers: what is not ordered by the handover is a race, and what is used after its end a fault.
struct FakeDevice {
    int passes = 0, images = 0;
};

// Both threads as a run has them: passes here, frames on the window's thread.
struct Shared {
    DeviceHandover handover;
    std::unique_ptr<FakeDevice> device = std::make_unique<FakeDevice>();
    std::atomic<bool> stop{false}, windowOver{false};
    int opened = 1, drawn = 0, foundByPasses = 0, foundByWindow = 0;

    void camera() {
        for (int i = 1; opened <= kLosses; ++i) {
            if (!handover.lost()) {
                ++device->passes;
                if (i % 7 != 0) {
                    continue;
                }
                handover.lose("passes");
                ++foundByPasses;
            }
            while (true) {
                REQUIRE(handover.awaitRelease(stop));
                device.reset();
                device = std::make_unique<FakeDevice>();
                ++opened;
                if (handover.offer(stop)) {
                    break;
                }
            }
        }
        windowOver.store(true);
    }

    // Refuses every fifth device, and loses every third frame.
    void window() {
        FakeDevice* mine = device.get();
        for (int frame = 1, offers = 0; !windowOver.load(); ++frame) {
            if (mine != nullptr) {
                ++mine->images;
                ++drawn;
                handover.accept();
                if (frame % 3 == 0) {
                    handover.lose("window");
                    ++foundByWindow;
                }
            } else if (handover.offered()) {
                if (++offers % 5 == 0) {
                    handover.lose("refused");
                } else {
                    mine = device.get();
                }
            }
            if (handover.wanted()) {
                mine = nullptr;
                handover.release();
            }
            std::this_thread::yield();
        }
    }
};

} // namespace

TEST_CASE("A device that either thread loses is destroyed after both are off it, and another one is shared") {
    Shared shared;
    std::thread window([&] { shared.window(); });
    shared.camera();
    window.join();
    CHECK(shared.opened > kLosses);
    CHECK(shared.drawn > 0);
    CHECK(shared.foundByPasses > 0);
    CHECK(shared.foundByWindow > 0);
}

TEST_CASE("A run that is to stop waits for no window, and the device that it leaves is the one it found") {
    DeviceHandover handover;
    const std::atomic<bool> stop{true};
    handover.lose("first");
    handover.lose("second");
    CHECK(handover.why() == "first");
    CHECK(handover.lost());
    CHECK_FALSE(handover.awaitRelease(stop)); // the window has not let go
    CHECK(handover.wanted());
    handover.release();
    CHECK_FALSE(handover.wanted());
    CHECK_FALSE(handover.offer(stop));
    CHECK(handover.offered()); // of use to a run that follows
    CHECK_FALSE(handover.lost());
    CHECK(handover.gone());
    handover.accept();
    CHECK_FALSE(handover.gone());
    handover.accept();
    handover.release(); // nothing to do
    CHECK_FALSE(handover.gone());
}
