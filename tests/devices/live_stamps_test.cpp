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

namespace {

// A message that arrives `delay` [s] after its stamp [s].
struct Delivered {
    double stamp;
    RawMessage message;

    Delivered(double at, double delay)
        : stamp(1.7e9 + at) {
        message.arrival = 100.0 + at + delay;
        message.arrivalUtc = stamp + delay;
    }
    double age(LiveStamps& stamps) const { return message.arrival - stamps.captureTime(stamp, message); }
};

} // namespace

TEST_CASE("A message of a clock that agreed is as old as its stamp says, however late it comes") {
    LiveStamps stamps("/camera/depth");
    const testing::Listening log;
    double at = 0.0;
    for (const double delay : {0.03, 0.5, 0.98, 1.02, 1.5, 3.0}) {
        at += 4.0;
        CHECK(Delivered(at, delay).age(stamps) == doctest::Approx(delay).epsilon(1e-5));
    }
    CHECK(log.count("1.020 s after its stamp (logged once)") == 1);
    CHECK(log.count("dated by their arrival") == 0);
    CHECK(Delivered(30.0, -0.5).age(stamps) == doctest::Approx(0.0)); // its clock is ahead
}

TEST_CASE("A clock that never agreed, or was set back since, is no measure of age") {
    LiveStamps stamps("/camera/depth");
    CHECK(Delivered(0.0, 5000.0).age(stamps) == doctest::Approx(0.0));
    CHECK(stamps.forward(Delivered(6000.0, 0.1).stamp));
    CHECK(Delivered(6000.0, 0.1).age(stamps) == doctest::Approx(0.1).epsilon(1e-5));
    for (uint32_t i = 1; i <= LiveStamps::kMaxBackward; ++i) {
        CHECK(stamps.forward(Delivered(10.0 * i, 6000.0).stamp) == (i == LiveStamps::kMaxBackward));
    }
    CHECK(stamps.restarted());
    CHECK(Delivered(50.0, 6000.0).age(stamps) == doctest::Approx(0.0));
}

TEST_CASE("A message with the stamp of the one before never counts, however often it comes") {
    LiveStamps stamps("/camera/depth");
    const testing::Listening log;
    CHECK(stamps.forward(1.7e9));
    for (int i = 0; i < 40; ++i) {
        CHECK_FALSE(stamps.forward(1.7e9));
    }
    CHECK_FALSE(stamps.restarted());
    CHECK(log.count("was set back") == 0);
    CHECK(stamps.forward(1.7e9 + 0.1));
}

TEST_CASE("No message is dated after its arrival, or before a message that came earlier") {
    LiveStamps stamps("/camera/depth");
    CHECK(Delivered(4.0, 0.03).age(stamps) == doctest::Approx(0.03).epsilon(1e-5));
    const Delivered ahead(5.0, -0.003); // clocks of machines in step
    CHECK(ahead.age(stamps) == 0.0);
    Delivered late(5.03, 0.01);
    late.message.arrivalUtc += 0.2; // this machine's clock was set
    const double before = stamps.captureTime(ahead.stamp, ahead.message);
    CHECK(stamps.captureTime(late.stamp, late.message) == before);
}
