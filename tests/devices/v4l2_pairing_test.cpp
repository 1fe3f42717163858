// SPDX-License-Identifier: Apache-2.0
// Pairing of depth and colour streams by time stamp, without a camera.
#include "devices/v4l2/frame_pairing.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;

namespace {

constexpr double kPeriod = 1.0 / 30.0;

CapturedBuffer at(double stamp, uint32_t index = 0) {
    CapturedBuffer buffer;
    buffer.stamp = stamp;
    buffer.index = index;
    return buffer;
}

struct PairedImage {
    bool depth;
    double stamp;
    double arrival;
};

// Feeds two streams in order of arrival; the distances in time of all pairs.
struct Run {
    std::vector<double> distances;
    size_t unpaired = 0, mostHeld = 0;
};
Run run(FramePairing& pairing, std::vector<PairedImage> events) {
    std::stable_sort(events.begin(), events.end(),
                     [](const PairedImage& a, const PairedImage& b) { return a.arrival < b.arrival; });
    Run result;
    size_t held = 0;
    for (const PairedImage& e : events) {
        e.depth ? pairing.depth(at(e.stamp)) : pairing.colour(at(e.stamp));
        ++held;
        result.mostHeld = std::max(result.mostHeld, held);
        while (const auto pair = pairing.next()) {
            result.distances.push_back(pair->depth.stamp - pair->colour->stamp);
            --held;
        }
        const size_t unpaired = pairing.unpairedDepth().size();
        result.unpaired += unpaired;
        held -= unpaired + pairing.usedColour().size();
    }
    return result;
}

std::vector<PairedImage> streams(double phase, double depthRate, double colourRate, double colourDelay,
                                 int seconds) {
    std::vector<PairedImage> events;
    for (int i = 0; i < seconds * depthRate; ++i) {
        events.push_back({true, i / depthRate, i / depthRate + 0.005});
    }
    for (int i = 0; i < seconds * colourRate; ++i) {
        const double t = phase + i / colourRate;
        events.push_back({false, t, t + colourDelay});
    }
    return events;
}

} // namespace

TEST_CASE("Every depth frame is paired with its nearest colour frame, at any phase of the streams") {
    for (const double phase : {0.0, 0.004, 0.012, 0.0166, 0.0167, 0.02, 0.033}) {
        FramePairing pairing(kPeriod);
        const Run result = run(pairing, streams(phase, 30, 30, 0.005, 4));
        CHECK(result.distances.size() >= 118);
        CHECK(result.unpaired <= 1);
        for (size_t i = 1; i < result.distances.size(); ++i) { // before the first there may be no colour yet
            CHECK(std::abs(result.distances[i]) <= 0.56 * kPeriod);
        }
        CHECK(result.mostHeld <= 5); // of eight buffers
    }
}

TEST_CASE("A slower colour stream is reused for several depth frames, a faster one is thinned") {
    for (const double rate : {15.0, 60.0}) {
        FramePairing pairing(1.0 / rate);
        const Run result = run(pairing, streams(0.003, 30, rate, 0.005, 4));
        CHECK(result.distances.size() >= 116);
        for (const double d : result.distances) {
            CHECK(std::abs(d) <= 1.0 / rate);
        }
    }
}

TEST_CASE("Colour that arrives two frames late still finds its depth frame") {
    FramePairing pairing(kPeriod);
    const Run result = run(pairing, streams(0.002, 30, 30, 0.06, 4));
    CHECK(result.distances.size() >= 110);
    for (const double d : result.distances) {
        CHECK(std::abs(d) <= kPeriod);
    }
}

TEST_CASE("Without a colour frame close in time a depth frame is released, and at most two wait") {
    FramePairing pairing(kPeriod);
    pairing.colour(at(0.0));
    for (int i = 0; i < 10; ++i) {
        pairing.depth(at(1.0 + i * kPeriod));
    }
    CHECK_FALSE(pairing.next());
    CHECK(pairing.unpairedDepth().size() == 8);
    CHECK(pairing.unpairedDepth().empty()); // returned once
    pairing.clear();
    CHECK_FALSE(pairing.next());
}

TEST_CASE("Without a colour stream each depth frame is delivered at once and in order") {
    FramePairing pairing(0.0);
    pairing.depth(at(1.0, 1));
    pairing.depth(at(2.0, 2));
    const auto first = pairing.next(), second = pairing.next();
    REQUIRE(first);
    REQUIRE(second);
    CHECK(first->depth.index == 1);
    CHECK_FALSE(first->colour);
    CHECK(second->depth.index == 2);
    CHECK_FALSE(pairing.next());
}

TEST_CASE("Streams with jitter and dropped frames lose no more pairs than frames") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(0.0, 0.004);
    FramePairing pairing(kPeriod);
    std::vector<PairedImage> events = streams(0.010, 30, 30, 0.008, 20);
    size_t kept = 0, depth = 0;
    for (size_t i = 0; i < events.size(); ++i) {
        events[i].stamp += jitter(random);
        events[i].arrival = std::max(events[i].arrival, events[i].stamp);
        if (random() % 20 != 0) {
            depth += events[i].depth ? 1 : 0;
            events[kept++] = events[i];
        }
    }
    events.resize(kept);
    const Run result = run(pairing, events);
    CHECK(result.distances.size() + result.unpaired >= depth - 2);
    CHECK(result.unpaired <= depth / 20);
}

TEST_CASE("Frames missing between two sequence numbers are counted across the 32-bit wrap") {
    CHECK(missingBetween(7, 8) == 0);
    CHECK(missingBetween(7, 11) == 3);
    CHECK(missingBetween(0xffffffffu, 0) == 0);
    CHECK(missingBetween(0xfffffffeu, 1) == 2);
    CHECK(missingBetween(0xffffffffu, 2) == 2);
    CHECK(missingBetween(7, 7) == 0);
    CHECK(missingBetween(9, 0) == 0); // started anew
}

TEST_CASE("A driver's stamp that is ahead of the clock is the time of arrival") {
    CHECK(usableStamp(99.5, 100.0) == 99.5);
    CHECK(usableStamp(100.004, 100.0) == 100.004);
    CHECK(usableStamp(100.006, 100.0) == 100.0);
    CHECK(usableStamp(5000.0, 100.0) == 100.0);
}
