// SPDX-License-Identifier: Apache-2.0
// Two threads share a device that each of them loses repeatedly; neither uses a lost device.
#include "engine/run/device_handover.h"

#include <doctest/doctest.h>
#include <memory>
#include <thread>

using namespace fathom;

namespace {

constexpr int kLosses = 200;

// Plain integers: a missing synchronisation is a data race, and a use after destruction a fault that
// sanitizers find.
struct FakeDevice {
    int passes = 0, images = 0;
};

// Both threads of a run: passes here, drawing on the window's thread.
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

    // Rejects every fifth device, and loses it at every third frame.
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

TEST_CASE(
    "A device that either thread loses is destroyed after both have left it, and another one is shared") {
    Shared shared;
    std::thread window([&] { shared.window(); });
    shared.camera();
    window.join();
    CHECK(shared.opened > kLosses);
    CHECK(shared.drawn > 0);
    CHECK(shared.foundByPasses > 0);
    CHECK(shared.foundByWindow > 0);
}

TEST_CASE("A run that is to stop does not wait for the window, and leaves its device to the next run") {
    DeviceHandover handover;
    const std::atomic<bool> stop{true};
    handover.lose("first");
    handover.lose("second");
    CHECK(handover.why() == "first");
    CHECK(handover.lost());
    CHECK_FALSE(handover.awaitRelease(stop)); // the window has not released it
    CHECK(handover.wanted());
    handover.release();
    CHECK_FALSE(handover.wanted());
    CHECK_FALSE(handover.offer(stop));
    CHECK(handover.offered()); // for a later run
    CHECK_FALSE(handover.lost());
    CHECK(handover.notInUse());
    handover.accept();
    CHECK_FALSE(handover.notInUse());
    handover.accept();
    handover.release(); // no effect
    CHECK_FALSE(handover.notInUse());
}
