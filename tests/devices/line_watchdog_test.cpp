// SPDX-License-Identifier: Apache-2.0
// The watchdog of an arm whose engine was killed: when it writes, and that the arm understands it wherever
// the engine's last message was cut off.
#include "devices/serial/line_watchdog.h"
#include "devices/simulated/arm_simulator.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

using namespace fathom;

namespace {

constexpr double kPeriod = 0.05;

// Number of writes of the watchdog in from..to [s], checked every millisecond.
int stopWrites(LineWatchdog& watchdog, double from, double to) {
    int count = 0;
    for (int ms = static_cast<int>(from * 1e3); ms < static_cast<int>(to * 1e3); ++ms) {
        count += watchdog.stopDue(1e-3 * ms) ? 1 : 0;
    }
    return count;
}

// The simulated ECA looks for a frame inside what was none; a real one may not, and throws all of it away.
struct SimpleEca : EcaSimulator {
    std::vector<uint8_t> frame;

    void receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) override {
        for (uint8_t byte : bytes) {
            if (frame.empty() && byte != 0xE7) {
                continue;
            }
            frame.push_back(byte);
            if (frame.size() == EcaBytes{}.size()) {
                EcaSimulator::receive(frame, out); // whole, and good or not
                EcaSimulator::receive(std::vector<uint8_t>(frame.size(), 0), out);
                frame.clear();
            }
        }
    }
};

std::vector<uint8_t> reachGo() { // velocity of the base, the first that is stopped
    ReachFrame frame;
    const size_t size = encodeReach(ReachPacket::ofFloat(0x02, 5, 0.25f), frame);
    return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<uint8_t> ecaGo() {
    std::array<EcaDemand, kEcaJoints> demands;
    demands.fill({EcaDemand::Kind::SpeedCcw, 0xE7E7, 0xE7E7, 0xE7E7}); // start bytes in the middle
    const EcaBytes frame = encodeEca(demands);
    return {frame.begin(), frame.end()};
}

template <class Simulator, class Position>
void stopsAfterHalf(const std::vector<uint8_t>& go, const StandStill& still, Position&& position) {
    for (size_t cut = 0; cut <= go.size(); ++cut) {
        CAPTURE(cut);
        Simulator arm;
        if constexpr (std::is_base_of_v<EcaSimulator, Simulator>) {
            arm.upper.fill(10.0);
        }
        std::vector<uint8_t> answers;
        arm.receive(go, answers);
        arm.receive({go.data(), cut}, answers);
        const double before = position(arm);
        arm.step(0.1);
        CHECK(position(arm) > before);
        arm.receive(still.bytes, answers);
        const double stopped = position(arm);
        arm.step(1.0);
        CHECK(position(arm) == stopped);
    }
}

struct Pipe {
    int ends[2] = {-1, -1};
    explicit Pipe(int type = SOCK_STREAM) { REQUIRE(::socketpair(AF_UNIX, type, 0, ends) == 0); }
    ~Pipe() {
        ::close(ends[0]);
        ::close(ends[1]);
    }
    void say(char byte) const { REQUIRE(::send(ends[0], &byte, 1, 0) == 1); }
};

} // namespace

TEST_CASE("The watchdog writes nothing while the engine is alive, before it first was, or after a goodbye") {
    LineWatchdog watchdog(kPeriod);
    CHECK(stopWrites(watchdog, 0.0, 5.0) == 0); // the engine makes ready
    for (int i = 0; i < 100; ++i) {
        watchdog.alive(5.0 + 0.1 * i);
        CHECK(stopWrites(watchdog, 5.0 + 0.1 * i, 5.1 + 0.1 * i) == 0);
    }
    watchdog.goodbye();
    watchdog.close();
    CHECK(stopWrites(watchdog, 15.0, 17.0) == 0);
    CHECK(watchdog.over(15.0));
    LineWatchdog unused(kPeriod);
    unused.close(); // nothing was ever commanded
    CHECK(stopWrites(unused, 0.0, 1.0) == 0);
    CHECK(unused.over(0.0));
}

TEST_CASE(
    "When the engine has ended, the watchdog stops the arm at once, repeats it every period, and exits") {
    LineWatchdog watchdog(kPeriod);
    watchdog.alive(1.0);
    watchdog.close();
    CHECK(watchdog.stopDue(1.01));
    CHECK_FALSE(watchdog.over(1.02));
    CHECK(stopWrites(watchdog, 1.02, 3.0) == 9);
    CHECK(watchdog.over(3.0));
    CHECK(watchdog.failures() == 1);
}

TEST_CASE("The watchdog stops the arm after a silence, releases the line when the engine is back, and "
          "watches for the next one") {
    LineWatchdog watchdog(kPeriod);
    watchdog.alive(1.0);
    CHECK(LineWatchdog::kSilence == 0.2); // docs/robustness.md, and what the arm's own movement is bounded by
    CHECK(stopWrites(watchdog, 1.0, 1.2) == 0);
    CHECK(stopWrites(watchdog, 1.2, 1.21) == 1);
    CHECK(stopWrites(watchdog, 1.21, 1.32) > 1);
    watchdog.alive(1.32);
    CHECK(stopWrites(watchdog, 1.32, 1.5) == 0);
    CHECK(stopWrites(watchdog, 1.5, 9.0) > 5);
    CHECK(stopWrites(watchdog, 9.0, 20.0) > 200); // as long as the engine hangs
    CHECK_FALSE(watchdog.over(20.0));
    watchdog.close();
    CHECK(stopWrites(watchdog, 20.0, 22.0) > 5);
    CHECK(watchdog.over(22.0));
    CHECK(watchdog.failures() == 3);
}

TEST_CASE("The watchdog stops an arm even when the engine's last telegram was truncated") {
    stopsAfterHalf<ReachSimulator>(reachGo(), reachStandStill(),
                                   [](const ReachSimulator& arm) { return arm.position[5]; });
    stopsAfterHalf<EcaSimulator>(ecaGo(), ecaStandStill(),
                                 [](const EcaSimulator& arm) { return arm.angle[2]; });
    stopsAfterHalf<SimpleEca>(ecaGo(), ecaStandStill(), [](const SimpleEca& arm) { return arm.angle[2]; });
}

TEST_CASE(
    "The watchdog process reports that it is ready, and writes when the engine's end of the pipe closes") {
    for (const bool goodbye : {false, true}) {
        CAPTURE(goodbye);
        const StandStill still = ecaStandStill();
        Pipe line(SOCK_SEQPACKET); // a packet a write
        Pipe pipe;
        int found = -1;
        std::thread serving([&] { found = watchLine(pipe.ends[1], line.ends[1], still); });
        char byte = 0;
        CHECK(::recv(pipe.ends[0], &byte, 1, 0) == 1);
        CHECK(byte == kWatchdogReady);
        pipe.say(kWatchdogAlive);
        if (goodbye) {
            pipe.say(kWatchdogGoodbye);
        }
        ::shutdown(pipe.ends[0], SHUT_WR);
        serving.join();
        CHECK(found == (goodbye ? 0 : 1));
        int writes = 0;
        std::vector<uint8_t> got(256);
        for (ssize_t size = 0; (size = ::recv(line.ends[0], got.data(), got.size(), MSG_DONTWAIT)) > 0;
             ++writes) {
            CHECK(std::vector<uint8_t>(got.begin(), got.begin() + size) == still.bytes);
        }
        CHECK(goodbye == (writes == 0));
    }
}

TEST_CASE("The watchdog of a Bravo 7 stops each of its seven axes") {
    ReachSimulator arm(ReachKind::Bravo7);
    std::vector<uint8_t> answers;
    for (uint8_t device = 1; device <= 7; ++device) {
        ReachFrame frame;
        const size_t size = encodeReach(ReachPacket::ofFloat(ReachArm::kVelocity, device, 0.5f), frame);
        arm.receive({frame.data(), size}, answers);
    }
    arm.step(0.1);
    const auto moved = arm.position;
    CHECK(std::count_if(moved.begin(), moved.end(), [](double q) { return q > 0.0; }) == 7);
    arm.receive(reachStandStill(ReachKind::Bravo7).bytes, answers);
    arm.step(1.0);
    CHECK(arm.position == moved);
}
