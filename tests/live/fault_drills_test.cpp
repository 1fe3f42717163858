// SPDX-License-Identifier: Apache-2.0
// Causes faults while the hand presses on a region, and checks the forces in the files of the run.
#include "tests/rig/cause_check.h"
#include "tests/rig/played_device.h"
#include "tests/rig/stage.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <thread>

using namespace fathom;

namespace {

const PixelBox kWholeWall{0, 0, kWidth, kHeight};
constexpr double kSlewStep = 2.0; // [N] largest change of a force per tick: the default of a scene
using Clock = std::chrono::steady_clock;

void waitMillis(int count) {
    std::this_thread::sleep_for(std::chrono::milliseconds(count));
}

// Waits as an observer on the view socket for a tick with more than this force [N] on the hand.
bool awaitForce(const std::filesystem::path& path, double force) {
    DeviceSocket endpoint;
    union {
        fathom_door_header header;
        fathom_door_state state;
        fathom_door_regions regions;
    } packet;
    for (int i = 0; i < 60000; ++i) {
        size_t got = 0;
        if (!endpoint.open() && DeviceSocket::tryConnect(path, endpoint) != 0) {
            waitMillis(1);
            continue;
        }
        switch (endpoint.receive(packet.regions, FATHOM_DOOR_REGIONS, &got)) {
        case SocketEvent::Closed:
            return false;
        case SocketEvent::Empty:
            waitMillis(1);
            break;
        default:
            if (socketFault(packet.header, got, FATHOM_DOOR_STATE, sizeof packet.state).empty() &&
                std::abs(packet.state.force[2]) > force) {
                return true;
            }
        }
    }
    return false;
}

// A red wall 0.6 m away, and a hand that presses 20 mm deeper than the tool can go.
void setUpPressing(const Stage& stage, size_t images, double seconds) {
    stage.recording(std::vector<Image>(images, Image(kWidth, kHeight, 600).paint(kWholeWall, kRed)));
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.3, {0.0, 0.0, 0.57}}, {seconds, {0.0, 0.0, 0.57}}});
}

// Except to zero: a device that is gone renders nothing at once.
double largestStep(const std::vector<Tick>& ticks) {
    double largest = 0.0;
    for (size_t i = 1; i < ticks.size(); ++i) {
        const bool ends = ticks[i].force == dvec3(0.0);
        largest = std::max(largest, ends ? 0.0 : glm::distance(ticks[i].force, ticks[i - 1].force));
    }
    return largest;
}

// Start and end [s] of the longest stretch of ticks that are off, on the run's clock.
std::pair<double, double> longestOff(const std::vector<Tick>& ticks) {
    std::pair<double, double> longest{0.0, 0.0};
    std::optional<double> off;
    for (const Tick& tick : ticks) {
        off = tick.state == "off" ? off.value_or(tick.t) : std::optional<double>();
        if (off && tick.t - *off > longest.second - longest.first) {
            longest = {*off, tick.t};
        }
    }
    return longest;
}

std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files[entry.path().filename().string()] = readWhole(entry.path());
    }
    return files;
}

} // namespace

TEST_CASE("A hand path with a position that no hand has is rejected before the run, with its line") {
    Stage stage;
    setUpPressing(stage, 2, 2.0);
    stage.hand({{0.0, {0.0, 0.0, 0.5}}, {0.3, {0.0, 0.0, 1e308}}, {2.0, {0.0, 0.0, 0.57}}});
    const ProgramRun run = runFathom(stage.command({"--realtime"}));
    CHECK(run.exitCode == 2);
    CHECK(run.err.find("hand.csv: line 3, z: '1e+308'") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(stage / "out" / "summary.json"));
}

TEST_CASE("A device that is unplugged while it presses gets no force, the tool stays, and the force returns "
          "with it") {
    Stage stage;
    setUpNearWall(stage);
    std::optional<PlayedDevice> device;
    device.emplace(stage / "hand.door");
    const pid_t engine = startFathom(
        stage.command({"--realtime", "--hand-device", (stage / "hand.door").string(), "--seconds", "60"}),
        stage / "said");
    REQUIRE(device->awaitWrench());
    bool felt = device->pushUntil(-8.0 - 1e-9, -4.0);
    const auto unplugged = Clock::now();
    felt = felt && device->fz < -1.0; // in contact until the end
    device.reset();
    waitMillis(600);
    const auto plugged = Clock::now();
    device.emplace(stage / "hand.door");
    felt = device->pushUntil(-8.0 - 1e-9, -4.0) && felt;
    const bool hopeless = device->hopeless();
    ::kill(engine, SIGINT);
    CHECK(exitCodeOf(engine) == 0);
    const Replay replay = readReplay(stage / "out", {});
    checkForces(replay.ticks, {}, 1e-5, true);
    REQUIRE(!replay.ticks.empty());
    // Off for at least as long as it was unplugged, minus the 0.2 s that the loss may take. Only the length
    // is compared, because the clocks of test and run have different origins.
    const auto [off, on] = longestOff(replay.ticks);
    CHECK(on - off >= std::chrono::duration<double>(plugged - unplugged).count() - 0.2);
    std::optional<dvec3> held;
    Tick before{};
    size_t turns = 0;
    double moved = 0.0, strongest = 0.0;
    for (const Tick& tick : replay.ticks) {
        if (tick.t < off && tick.state != "fading") {
            before = tick; // the last tick with the full force
        }
        if (tick.t < off || tick.t > on) {
            continue;
        }
        held = held ? held : std::optional(tick.tool.position);
        moved = std::max(moved, glm::distance(tick.tool.position, *held));
        strongest = std::max(strongest, glm::length(tick.force));
        ++turns;
    }
    CHECK(turns > 100);
    CHECK(strongest == 0.0);
    CHECK(moved < 1e-5);
    CHECK(glm::distance(before.tool.position, *held) < 1e-5);
    CHECK(largestStep(replay.ticks) <= kSlewStep * (1.0 + 1e-9));
    CHECK(replay.haptic().at("max_penetration_m").get<double>() <= 1e-5);
    if (hopeless) {
        MESSAGE("SKIPPED: the device was lost over and over, its force was not looked for");
    } else {
        CHECK(felt);
        CHECK(glm::length(before.force) > 1.0);
        CHECK(glm::length(replay.ticks.back().force) > 1.0);
    }
}

TEST_CASE("A realtime replay that is killed leaves the files of the run before unchanged, and the next one "
          "succeeds") {
    Stage stage;
    setUpPressing(stage, 3, 0.4);
    REQUIRE(runFathom(stage.command({"--realtime"})).exitCode == 0);
    const auto before = filesOf(stage / "out");
    CHECK(before.count("haptics.csv") == 1);
    setUpPressing(stage, 3, 60.0);
    const pid_t engine = startFathom(
        stage.command({"--realtime", "--view-door", (stage / "view.door").string()}), stage / "said");
    CHECK(awaitForce(stage / "view.door", 1.0));
    ::kill(engine, SIGKILL);
    CHECK(exitCodeOf(engine) == -1);
    size_t partial = 0;
    for (const auto& file : filesOf(stage / "out")) {
        const std::string& name = file.first; // lambdas cannot capture structured bindings
        CAPTURE(name);
        if (before.count(name) == 1) {
            CHECK((file.second == before.at(name)));
        } else {
            const bool isLock = std::filesystem::path(name).filename() == ".fathom.lock"; // of a dead process
            CHECK((isLock || std::filesystem::path(name).extension() == ".partial"));
            partial += isLock ? 0 : 1;
        }
    }
    CHECK(partial > 0);
    setUpPressing(stage, 3, 0.4);
    const ProgramRun run = runFathom(stage.command({"--realtime"}));
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    const auto after = filesOf(stage / "out");
    CHECK(after.size() == before.size());
    CHECK((after.at("haptics.csv") != before.at("haptics.csv")));
}

TEST_CASE("A realtime replay that is stopped for 1.2 s while it presses counts the periods, logs the age of "
          "the scene, and no force steps beyond the slew limit") {
    Stage stage;
    setUpPressing(stage, 70, 3.2);
    const pid_t engine = startFathom(
        stage.command({"--realtime", "--view-door", (stage / "view.door").string()}), stage / "said");
    CHECK(awaitForce(stage / "view.door", 5.0));
    ::kill(engine, SIGSTOP);
    waitMillis(1200);
    ::kill(engine, SIGCONT);
    CHECK(exitCodeOf(engine) == 0);
    const Replay replay = readReplay(stage / "out", {});
    checkForces(replay.ticks, {}, 1e-5, true);
    const std::vector<Tick>& ticks = replay.ticks;
    REQUIRE(ticks.size() > 100);
    double longest = 0.0, resumed = 0.0;
    bool stale = false;
    for (size_t i = 1; i < ticks.size(); ++i) {
        stale = stale || ticks[i].sceneAge > 0.1;
        if (ticks[i].t - ticks[i - 1].t > longest) {
            longest = ticks[i].t - ticks[i - 1].t;
            resumed = ticks[i].t;
        }
    }
    CHECK(longest > 1.1);
    CHECK(largestStep(ticks) <= kSlewStep * (1.0 + 1e-9));
    CHECK(replay.haptic().at("max_penetration_m").get<double>() <= 1e-5);
    const std::string said = stage.read("said");
    const size_t count = said.find(" periods without one");
    REQUIRE(count != std::string::npos);
    const size_t number = said.rfind(' ', count - 1);
    const double missed = std::stod(said.substr(number));
    CHECK(missed >= 1100);
    // Every period is a tick or is counted as missed, from the first tick to the last.
    CHECK(static_cast<double>(ticks.size()) + missed >= 0.99 * ticks.back().t * 1000.0);
    // On a busy machine the frame may come first; then no tick has an old scene.
    CHECK((said.find("ms old: forces fade") != std::string::npos) == stale);
    CHECK(glm::length(replay.at(resumed + 1.0).force) > 3.0); // it returns as the stiffness rises again
}
