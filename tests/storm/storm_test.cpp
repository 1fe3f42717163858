// SPDX-License-Identifier: Apache-2.0
// Faults of device, line, processes and processors, half a second apart, while a hand presses and lets go.
// What reached the device is checked against the invariants of the forces and against the record.
#include "tests/rig/cause_check.h"
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"
#include "tests/support/sanitized.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <random>
#include <spawn.h>
#include <sstream>
#include <thread>

extern char** environ;

using namespace fathom;

namespace {

constexpr double kSlewStep = 2.0; // [N] per tick, the default of a scene
constexpr unsigned kLast = 2;     // fathom_door_wrench.flags

void waitMillis(unsigned count) {
    std::this_thread::sleep_for(std::chrono::milliseconds(count));
}

struct WirePacket {
    int connection;
    uint64_t sequence;
    unsigned flags;
    dvec3 force, torque;
};

std::vector<WirePacket> readWire(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line); // names
    std::vector<WirePacket> packets;
    while (std::getline(in, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream fields(line);
        WirePacket p{};
        std::string number[6]; // operator>> does not read "nan"
        fields >> p.connection >> p.sequence >> p.flags;
        for (int i = 0; i < 6; ++i) {
            fields >> number[i];
            (i < 3 ? p.force : p.torque)[i % 3] = std::strtod(number[i].c_str(), nullptr);
        }
        packets.push_back(p);
    }
    return packets;
}

pid_t startBridge(const std::filesystem::path& socket, unsigned seed, const std::filesystem::path& log) {
    std::string words[] = {STORM_BRIDGE, socket.string(), std::to_string(seed), log.string()};
    char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    pid_t bridge = -1;
    REQUIRE(::posix_spawn(&bridge, STORM_BRIDGE, nullptr, nullptr, argv, environ) == 0);
    REQUIRE(testing::eventually([&socket] { return std::filesystem::exists(socket); }));
    return bridge;
}

void starve(unsigned millis) {
    std::atomic<bool> stop{false};
    std::vector<std::thread> busy;
    for (unsigned i = 0; i < 2 * std::thread::hardware_concurrency(); ++i) {
        busy.emplace_back([&stop] {
            while (!stop) {
            }
        });
    }
    waitMillis(millis);
    stop = true;
    for (std::thread& thread : busy) {
        thread.join();
    }
}

// One fault per half second, for two seconds of every four: three losses within a second keep the forces off
// until a second is clean.
void storm(pid_t engine, pid_t bridge, double seconds, unsigned seed) {
    std::mt19937 random(seed);
    for (unsigned slot = 0; 0.5 * slot < seconds; ++slot) {
        const unsigned millis = 10 + static_cast<unsigned>(random() % 290);
        const pid_t victim = random() % 2 == 0 ? engine : bridge;
        switch (slot % 8 < 4 ? random() % 4 : 3) {
        case 0:
            starve(millis);
            break;
        case 1:
        case 2:
            ::kill(victim, SIGSTOP);
            waitMillis(millis);
            ::kill(victim, SIGCONT);
            break;
        default:
            waitMillis(millis);
        }
        waitMillis(500 - millis);
    }
}

// The fault of the first packet that breaks an invariant; empty = none.
std::string faultOf(const std::vector<WirePacket>& packets, const Terms& terms) {
    dvec3 before(0.0);
    int connection = 0;
    for (const WirePacket& p : packets) {
        const std::string where =
            "packet " + std::to_string(p.sequence) + " of connection " + std::to_string(p.connection);
        before = p.connection == connection ? before : dvec3(0.0);
        connection = p.connection;
        if (!isFinite(p.force) || !isFinite(p.torque)) {
            return where + " is not finite";
        }
        if (glm::length(p.force) > terms.forceLimit * (1.0 + 1e-9) ||
            glm::length(p.torque) > terms.torqueLimit * (1.0 + 1e-9)) {
            return where + " is over the limits";
        }
        if (glm::length(p.force) - glm::length(before) > kSlewStep * (1.0 + 1e-9)) {
            return where + " rises from " + std::to_string(glm::length(before)) + " to " +
                   std::to_string(glm::length(p.force)) + " N";
        }
        if ((p.flags & kLast) != 0 && p.force != dvec3(0.0)) {
            return where + " is the last one and not zero";
        }
        before = p.force;
    }
    return "";
}

// Every packet is a row of the record, in the same order.
std::string recordFault(const std::vector<WirePacket>& packets, const std::vector<Tick>& ticks) {
    size_t row = 0;
    for (const WirePacket& p : packets) {
        const auto same = [&p](const Tick& tick) {
            return glm::distance(tick.outForce, p.force) < 1e-9 &&
                   glm::distance(tick.outTorque, p.torque) < 1e-9;
        };
        const size_t from = row;
        while (row < ticks.size() && !same(ticks[row])) {
            ++row;
        }
        const bool zero = p.force == dvec3(0.0) && p.torque == dvec3(0.0);
        if (row == ticks.size() && !zero) {
            return "packet " + std::to_string(p.sequence) + " of connection " + std::to_string(p.connection) +
                   " is in no row";
        }
        row = row == ticks.size() ? from : row + 1;
    }
    return "";
}

} // namespace

TEST_CASE("Under a storm of faults every wrench on the wire has a cause, a limit and a row in the record") {
    Stage stage;
    stage.recording(std::vector<Image>(3, Image(kWidth, kHeight, 600).paint({0, 0, kWidth, kHeight}, kRed)));
    SceneText scene;
    scene.hand = "path: start.csv"; // the tool starts 20 mm before the region
    scene.contact = "delay: 20";
    stage.scene(scene);
    stage.write("start.csv", handCsv({{0.0, {0.0, 0.0, 0.53}}}));
    const pid_t bridge = startBridge(stage / "hand.door", 20261126, stage / "wire.csv");
    const pid_t engine = startFathom(
        stage.command({"--realtime", "--hand-device", (stage / "hand.door").string(), "--seconds", "3600"}),
        stage / "said");
    waitMillis(3000);
    storm(engine, bridge, 60.0, 31);
    const int ended = exitCodeOf(engine, SIGINT);
    INFO(readWhole(stage / "said"));
    REQUIRE(ended == 0);
    waitMillis(100);
    REQUIRE(exitCodeOf(bridge, SIGTERM) == 0);

    const std::vector<WirePacket> packets = readWire(stage / "wire.csv");
    const Replay replay = readReplay(stage / "out", {});
    REQUIRE(!packets.empty());
    Terms terms;
    CHECK(faultOf(packets, terms) == "");
    CHECK(recordFault(packets, replay.ticks) == "");
    CHECK(packets.back().force == dvec3(0.0));
    checkForces(replay.ticks, terms, 1e-5, true);
    double on = 0.0; // ticks since the forces were off; they return by their limit within 200
    for (const Tick& tick : replay.ticks) {
        on = tick.state == "off" ? 0.0 : on + 1.0;
        REQUIRE(glm::length(tick.force) <= terms.forceLimit * on / 200.0 + 1e-9);
    }
    double strongest = 0.0;
    size_t pressed = 0;
    for (const WirePacket& p : packets) {
        strongest = std::max(strongest, glm::length(p.force));
        pressed += glm::length(p.force) > 0.5 ? 1 : 0;
    }
    // Else the storm kept the hand away, and nothing was tried.
    const bool tried = strongest > 3.0 && pressed > replay.ticks.size() / 20;
    if (!tried && kSanitized) {
        MESSAGE("SKIPPED: other tests left the sanitized engine no time to press");
    } else {
        CHECK(tried);
    }
    CHECK(replay.haptic().at("max_penetration_m").get<double>() <= 1e-5);
}
