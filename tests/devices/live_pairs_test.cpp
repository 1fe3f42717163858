// SPDX-License-Identifier: Apache-2.0
// Which colour image a live depth image gets, without a network.
#include "devices/ros2/live_pairs.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr double kFramePeriod = 0.1; // [s]

LiveImage imageAt(double stamp) {
    auto message = std::make_shared<RawMessage>();
    message->arrival = stamp;
    return {stamp, message};
}

// Ten pairs first, from which both periods are known.
struct Streams {
    LivePairs pairs{true};
    double now = 1.0;

    Streams() {
        for (int i = 0; i < 10; ++i, now += kFramePeriod) {
            pairs.colour(imageAt(now));
            pairs.depth(imageAt(now));
            CHECK(pairs.next(now));
        }
    }
    // Stamp of the colour image that the oldest depth image gets, after `now`; 0 = it still waits.
    double colourStamp(double after) {
        const auto pair = pairs.next(now + after);
        return pair && pair->colour ? pair->colour->stamp - now : 0.0;
    }
};

} // namespace

TEST_CASE("A depth image gets a colour image up to half a period away, and none that is farther") {
    for (const bool far : {false, true}) {
        CAPTURE(far);
        Streams streams;
        streams.pairs.depth(imageAt(streams.now));
        streams.pairs.colour(imageAt(streams.now + (far ? 0.55 : 0.45) * kFramePeriod));
        CHECK(streams.colourStamp(LivePairs::kPatience) == doctest::Approx(far ? 0.0 : 0.45 * kFramePeriod));
        CHECK(streams.pairs.takeUnpaired() == (far ? 1u : 0u));
    }
}

TEST_CASE("A depth image waits for a colour image that may be nearer, and not for ever") {
    for (const bool comes : {true, false}) {
        CAPTURE(comes);
        Streams streams;
        streams.pairs.colour(imageAt(streams.now - 0.4 * kFramePeriod));
        streams.pairs.depth(imageAt(streams.now));
        CHECK(streams.colourStamp(0.0) == 0.0);
        CHECK(streams.pairs.patience(streams.now, 1.0) == doctest::Approx(LivePairs::kPatience));
        if (comes) {
            streams.pairs.colour(imageAt(streams.now + 0.1 * kFramePeriod));
        } else {
            CHECK(streams.colourStamp(LivePairs::kPatience - 1e-3) == 0.0);
        }
        CHECK(streams.colourStamp(comes ? 0.0 : LivePairs::kPatience + 1e-3) ==
              doctest::Approx((comes ? 0.1 : -0.4) * kFramePeriod));
    }
}

TEST_CASE("Depth images without a topic of colour are ready at once, and of too many the oldest go") {
    LivePairs pairs(false);
    for (int i = 0; i < 20; ++i) {
        pairs.depth(imageAt(1.0 + i * kFramePeriod));
    }
    CHECK(pairs.takeUnpaired() == 4);
    const auto first = pairs.next(1.0);
    REQUIRE(first);
    CHECK(first->depth.stamp == doctest::Approx(1.0 + 4 * kFramePeriod));
    CHECK_FALSE(first->colour);
}
