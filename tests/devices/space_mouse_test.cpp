// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/space_mouse_hand.h"

#include "tests/devices/socket_rig.h"

#include <array>
#include <atomic>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <vector>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Report = std::vector<uint8_t>;

void put(Report& report, int value) {
    report.push_back(static_cast<uint8_t>(value));
    report.push_back(static_cast<uint8_t>(value >> 8));
}

Report motion(uint8_t id, const std::vector<int>& values) {
    Report report{id};
    for (const int value : values) {
        put(report, value);
    }
    return report;
}

// A hand on one end of a socket that keeps reports apart, as hidraw does.
struct Cap {
    Cap() {
        int ends[2];
        REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends) == 0);
        device = ends[0];
        hand = std::make_unique<SpaceMouseHand>(ends[1], "test mouse", SpaceMouseOptions{});
    }
    ~Cap() { unplug(); }
    void report(const Report& bytes) {
        REQUIRE(::send(device, bytes.data(), bytes.size(), 0) == std::ssize(bytes));
    }
    void unplug() {
        if (device >= 0) {
            ::close(device);
        }
        device = -1;
    }
    // Reads 1000 times per second until `seconds` are over; `held` is reported every 8 ms.
    HandSample run(double seconds, const std::vector<Report>& held = {}) {
        HandSample sample;
        for (int i = 0; i < std::lround(seconds * 1000); ++i) {
            for (const Report& r : held) {
                if (i % 8 == 0) {
                    report(r);
                }
            }
            t += 0.001;
            sample = hand->read(t);
        }
        return sample;
    }
    double t = 0.0;
    int device = -1;
    std::unique_ptr<SpaceMouseHand> hand;
};

} // namespace

TEST_CASE(
    "Reports of both layouts give shift, rotation and buttons; other and short reports change nothing") {
    SpaceMouseState state;
    CHECK(takeSpaceMouseReport(motion(1, {350, -350, 7}), state));
    CHECK(state.shift == std::array<int16_t, 3>{350, -350, 7});
    CHECK(takeSpaceMouseReport(motion(2, {-1, 256, -256}), state));
    CHECK(state.rotation == std::array<int16_t, 3>{-1, 256, -256});
    CHECK(takeSpaceMouseReport(motion(1, {1, 2, 3, 4, 5, 6}), state));
    CHECK(state.shift == std::array<int16_t, 3>{1, 2, 3});
    CHECK(state.rotation == std::array<int16_t, 3>{4, 5, 6});
    CHECK(takeSpaceMouseReport(Report{3, 5, 1}, state));
    CHECK(state.buttons == 0x105);
    const SpaceMouseState before = state;
    for (const Report& bad : {Report{}, Report{1}, motion(1, {9, 9}), motion(2, {9, 9}), Report{3},
                              Report{0x17, 80}, Report{9, 1, 2, 3, 4, 5, 6}}) {
        CHECK_FALSE(takeSpaceMouseReport(bad, state));
    }
    CHECK(state.shift == before.shift);
    CHECK(state.rotation == before.rotation);
    CHECK(state.buttons == before.buttons);
}

TEST_CASE("Axes are x right, y away, z up, one at full deflection and zero within the dead zone") {
    CHECK(spaceMouseAxes({350, 350, 350}) == dvec3(1.0, -1.0, -1.0));
    CHECK(spaceMouseAxes({-500, -500, -500}) == dvec3(-1.0, 1.0, 1.0));
    CHECK(glm::length(spaceMouseAxes({8, -8, 5})) == 0.0);
    CHECK(spaceMouseAxes({179, 0, 0}).x == doctest::Approx(0.5));
}

TEST_CASE("Known models are distinguished from other devices of the same vendors") {
    CHECK(isSpaceMouse(0x046d, 0xc626));
    CHECK(isSpaceMouse(0x256f, 0xc635));
    CHECK_FALSE(isSpaceMouse(0x046d, 0xc52b)); // a receiver of ordinary mice
    CHECK_FALSE(isSpaceMouse(0x256f, 0xc650)); // CadMouse
    CHECK_FALSE(isSpaceMouse(0x1234, 0xc626));
}

TEST_CASE(
    "Full deflection for a second moves 50 mm and rotates half a radian; after release the pose stays") {
    Cap cap;
    HandSample sample = cap.run(1.001, {motion(1, {350, 0, -350}), motion(2, {0, 0, -350})});
    CHECK(sample.deviceThandle.position.x == doctest::Approx(0.05));
    CHECK(sample.deviceThandle.position.y == 0.0);
    CHECK(sample.deviceThandle.position.z == doctest::Approx(0.05));
    CHECK(rotationLog(sample.deviceThandle.rotation).z == doctest::Approx(0.5));
    cap.report(motion(1, {0, 0, 0}));
    cap.report(motion(2, {0, 0, 0}));
    const Pose there = cap.run(0.5).deviceThandle;
    CHECK(there.position == sample.deviceThandle.position);
    cap.hand->write({{5.0, 0.0, 0.0}, {}}, 0.001);
    CHECK(cap.run(0.1).deviceThandle.position == there.position);
    CHECK(cap.hand->preset() == "none");
}

TEST_CASE("A turned hand still rotates about the axes of the device, not about its own") {
    Cap cap;
    const dquat tipped = cap.run(3.0, {motion(2, {350, 0, 0})}).deviceThandle.rotation;
    cap.report(motion(2, {0, 0, 0}));
    REQUIRE(rotationLog(tipped).x == doctest::Approx(1.5).epsilon(0.01));
    const dquat turned = cap.run(1.0, {motion(2, {0, 0, -350})}).deviceThandle.rotation;
    const dvec3 since = rotationBetween(tipped, turned);
    CHECK(since.z == doctest::Approx(0.5).epsilon(0.01));
    CHECK(std::hypot(since.x, since.y) < 1e-9);
}

TEST_CASE("A cap that is silent while deflected counts as released, and a late tick causes no jump") {
    Cap cap;
    cap.run(0.2, {motion(1, {350, 0, 0})});
    const double x = cap.run(1.0).deviceThandle.position.x;
    CHECK(x < 0.05 * (0.2 + 0.11));
    CHECK(x > 0.05 * 0.2);
    cap.report(motion(1, {350, 0, 0}));
    cap.t += 30.0; // the machine slept
    CHECK(cap.hand->read(cap.t).deviceThandle.position.x <= x + 0.05 * SpaceMouseHand::kMaxStep + 1e-12);
}

TEST_CASE("A cap that falls silent while a new run begins at 0 counts as released, too") {
    Cap cap;
    cap.run(5.0);
    cap.run(0.2, {motion(1, {350, 0, 0})});
    cap.t = 0.0;
    const double before = cap.run(0.2).deviceThandle.position.x;
    CHECK(cap.run(1.0).deviceThandle.position.x == before);
}

TEST_CASE("Buttons are guidance and dead-man; an unplugged cap is an open dead-man and a clutch") {
    Cap cap;
    CHECK(cap.run(0.01).buttons == 0);
    cap.report({3, 1});
    CHECK(cap.run(0.01).buttons == 1);
    cap.report({3, 2});
    CHECK(cap.run(0.01).buttons == 2);
    cap.report({3, 0});
    cap.report(motion(1, {350, 0, 0}));
    const double x = cap.run(0.01).deviceThandle.position.x;
    CHECK(cap.hand->alive());
    cap.unplug();
    const HandSample sample = cap.run(0.2);
    CHECK(sample.buttons == 6);
    CHECK(sample.deviceThandle.position.x == x);
    CHECK_FALSE(cap.hand->alive());
    CHECK(cap.hand->figures().losses == 1);
}

TEST_CASE("A cap that is plugged in again resumes from its last pose, every time") {
    std::atomic<int> next{-1}; // device that the next plug-in creates
    int ends[2];
    REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends) == 0);
    SpaceMouseHand hand(ends[1], "test mouse", {}, [&] { return next.exchange(-1); });
    double t = 0.0;
    const auto read = [&] { return hand.read(t += 0.001); };
    for (uint32_t times = 1; times <= 3; ++times) {
        const Report push = motion(1, {350, 0, 0});
        REQUIRE(::send(ends[0], push.data(), push.size(), 0) == std::ssize(push));
        read();
        const double x = read().deviceThandle.position.x;
        CHECK(x > 0.0);
        ::close(ends[0]);
        CHECK(read().buttons == 6);
        CHECK_FALSE(hand.alive());
        CHECK(hand.figures().losses == times);
        REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends) == 0);
        next = ends[1];
        REQUIRE(eventually([&] { return read().buttons == 0 && hand.alive(); }));
        CHECK(read().deviceThandle.position.x == x); // the push before is forgotten
    }
    ::close(ends[0]);
}
