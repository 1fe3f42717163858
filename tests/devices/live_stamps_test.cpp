// SPDX-License-Identifier: Apache-2.0
// Stamps of live messages, without a network.
#include "devices/ros2/live_stamps.h"

#include "tests/realtime/listening.h"

#include <doctest/doctest.h>

using namespace fathom;

TEST_CASE("Messages without stamps are dated by their arrival, all of them, with one warning") {
    LiveStamps stamps("/camera/depth");
    const testing::Listening log;
    RawMessage message;
    for (int i = 0; i < 12; ++i) {
        message.arrival = 100.0 + 0.1 * i;
        message.arrivalUtc = 1.7e9 + 0.1 * i;
        const double stamp = stamps.stampOf(0.0, message);
        CHECK(stamp == message.arrivalUtc);
        CHECK(stamps.forward(stamp));
        CHECK(stamps.captureTime(stamp, message) == doctest::Approx(message.arrival).epsilon(1e-9));
    }
    CHECK_FALSE(stamps.restarted());
    CHECK(log.count("headers have no stamps") == 1);
    CHECK(stamps.stampOf(1.7e9 + 2.0, message) == 1.7e9 + 2.0);
}
