// SPDX-License-Identifier: Apache-2.0
// `replay --realtime` with a live hand on a bridge socket, and an observer on the view socket.
#include "tests/devices/socket_rig.h"
#include "tests/rig/cause_check.h"
#include "tests/rig/played_device.h"
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <chrono>
#include <csignal>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace fathom;

namespace {

const PixelBox kAll{0, 0, kWidth, kHeight};

class Bridge {
public:
    explicit Bridge(const std::filesystem::path& endpoint)
        : id_(::fork()) {
        REQUIRE(id_ >= 0);
        if (id_ == 0) {
            ::execl(EXAMPLE_BRIDGE, "example_bridge", endpoint.c_str(), nullptr);
            ::_exit(99);
        }
        REQUIRE(testing::eventually([&] { return std::filesystem::exists(endpoint); }));
    }
    Bridge(const Bridge&) = delete;
    Bridge& operator=(const Bridge&) = delete;
    ~Bridge() {
        ::kill(id_, SIGTERM);
        ::waitpid(id_, nullptr, 0);
    }

private:
    pid_t id_;
};

// An output that takes no more bytes, as a terminal that was stopped.
class BlockedOutput {
public:
    explicit BlockedOutput(std::filesystem::path path)
        : path_(std::move(path)) {
        REQUIRE(::mkfifo(path_.c_str(), 0600) == 0);
        pipe_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
        REQUIRE(pipe_ >= 0);
        while (::write(pipe_, "x", 1) == 1) {
        }
    }
    BlockedOutput(const BlockedOutput&) = delete;
    BlockedOutput& operator=(const BlockedOutput&) = delete;
    ~BlockedOutput() { ::close(pipe_); } // then whoever writes gets an error
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int pipe_ = -1;
};

// Reads the view socket until the engine closes it.
struct Observer {
    explicit Observer(std::filesystem::path path)
        : thread([this, endpoint = std::move(path)] { look(endpoint); }) {}
    void look(const std::filesystem::path& path) {
        DeviceSocket endpoint;
        testing::eventually([&] { return DeviceSocket::tryConnect(path, endpoint) == 0; });
        union {
            fathom_door_header header;
            fathom_door_state state;
            fathom_door_regions regions;
            fathom_door_fixtures fixtures;
        } packet;
        for (;;) {
            size_t got = 0;
            const SocketEvent event = endpoint.receive(packet.regions, FATHOM_DOOR_REGIONS, &got);
            if (event == SocketEvent::Closed) {
                return;
            }
            if (event == SocketEvent::Empty) {
                std::this_thread::sleep_for(std::chrono::microseconds(200));
            } else if (event == SocketEvent::Packet) {
                parts[packet.regions.generation] += packet.regions.count;
                total[packet.regions.generation] = packet.regions.total;
                radius = packet.regions.count > 0 ? packet.regions.spheres[0].radius : radius;
            } else if (socketFault(packet.header, got, FATHOM_DOOR_STATE, sizeof packet.state).empty()) {
                ++states;
                generations.insert(packet.state.generation);
                lastTool = packet.state.base_T_tool_position[2];
            } else if (socketFault(packet.header, got, FATHOM_DOOR_FIXTURES, sizeof packet.fixtures)
                           .empty()) {
                rows.assign(packet.fixtures.rows, packet.fixtures.rows + packet.fixtures.count);
            } else {
                ++strange;
            }
        }
    }
    std::map<uint64_t, uint32_t> parts, total;
    std::set<uint64_t> generations;
    std::vector<fathom_door_fixture> rows; // in the newest set
    uint64_t states = 0, strange = 0;
    float radius = 0.0f;
    double lastTool = 0.0;
    std::thread thread;
};

} // namespace

TEST_CASE("A live hand on a bridge socket drives a realtime replay, and an observer gets poses, wrench and "
          "fixtures") {
    Stage stage;
    const PixelBox corner{2, 2, 10, 10};
    stage.recording(
        std::vector<Image>(5, Image(kWidth, kHeight, 600).paint(kAll, kRed).paint(corner, kYellow)));
    SceneText scene;
    scene.fixtures = {SceneText::kForbidRed, SceneText::kGuideYellow,
                      "name: pipe, role: keep_in, shape: cylinder, base_T_shape: {xyz: [0, 0, 0.5]}, size: "
                      "[0.5, 3, 0]"};
    stage.scene(scene);
    const Bridge bridge(stage / "hand.door");
    Observer observer(stage / "view.door");
    const ProgramRun run =
        runFathom(stage.command({"--realtime", "--hand-device", (stage / "hand.door").string(), "--view-door",
                                 (stage / "view.door").string(), "--seconds", "1"}));
    observer.thread.join();
    CHECK_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.out.find("example bridge at") != std::string::npos);
    CHECK(run.out.find("(preset falcon): x y z sensed, x y z driven; torque is shown, not felt") !=
          std::string::npos);
    const Replay replay = readReplay(stage / "out", run);
    checkForces(replay.ticks, {}, 1e-5, true);
    REQUIRE(replay.ticks.size() > 100);
    CHECK(replay.ticks.back().t > 0.9);
    double moved = 0.0;
    for (const Tick& tick : replay.ticks) {
        moved = std::max(moved, glm::distance(tick.device.position, replay.ticks.front().device.position));
    }
    CHECK(moved > 0.005); // the example bridge moves its handle at 15 mm/s
    CHECK(moved < 0.05);  // starts where the scene's path starts, without a jump

    CHECK(observer.states > 50);
    CHECK(observer.strange == 0);
    CHECK(observer.radius >= 0.04f);
    REQUIRE_FALSE(observer.total.empty());
    bool whole = false;
    for (const auto& [generation, spheres] : observer.total) {
        whole = whole || (spheres > 0 && observer.parts.at(generation) % spheres == 0);
    }
    CHECK(whole);
    REQUIRE(observer.rows.size() == 2);
    const fathom_door_fixture &pipe = observer.rows[0], &yellow = observer.rows[1];
    CHECK(pipe.kind == FATHOM_DOOR_CYLINDER);
    CHECK(pipe.flags == FATHOM_DOOR_KEEP_IN);
    CHECK(pipe.fixture == 2);
    CHECK(pipe.size[1] == 3.0);
    CHECK(yellow.kind == FATHOM_DOOR_TARGET);
    CHECK(yellow.fixture == 1);
    CHECK(yellow.flags == FATHOM_DOOR_SEEN);
    CHECK(yellow.points > 10);
    CHECK(std::abs(yellow.base_T_position[2] - 0.6) < 0.15); // surface, or standoff before it
    CHECK(yellow.base_T_position[0] < 0.0);                  // in the left half of the image
    CHECK_FALSE(std::filesystem::exists(stage / "view.door"));
}

TEST_CASE("A device pressed into a region gets at most its force limit, and no force after the program ends "
          "or is killed") {
    Stage stage;
    setUpNearWall(stage);
    std::signal(SIGHUP, SIG_DFL); // the parent process may ignore it
    PlayedDevice device(stage / "hand.door");
    std::optional<BlockedOutput> blocked;
    int signal = 0;
    SUBCASE("Ctrl-C") {
        signal = SIGINT;
    }
    SUBCASE("Ctrl-C while its output is blocked") {
        signal = SIGINT;
        blocked.emplace(stage / "output");
    }
    SUBCASE("the terminal is closed") {
        signal = SIGHUP;
    }
    SUBCASE("killed") {
        signal = SIGKILL;
    }
    SUBCASE("crashed") {
        signal = SIGSEGV;
    }
    const pid_t engine = startFathom(stage.command({"-v", "--realtime", "--hand-device",
                                                    (stage / "hand.door").string(), "--seconds", "60"}),
                                     blocked ? blocked->path() : std::filesystem::path());
    REQUIRE(device.awaitWrench());
    CHECK(std::abs(device.fz) < 1e-9);
    const bool full = device.pushUntil(-8.0 - 1e-9, -7.9); // 15 mm at 3000 N/m, limited to the preset's 8 N
    device.push(0.0);
    CHECK(device.feels(-1e-3, 1e-3));
    const bool again = device.pushUntil(-8.0 - 1e-9, -4.0);
    if (device.hopeless()) {
        MESSAGE("SKIPPED: the device was lost over and over, its full force was not looked for");
    } else {
        CHECK(full);
        CHECK(again);
    }
    CHECK(device.strongest >= -8.0 - 1e-9);
    ::kill(engine, signal);
    // 10 ms of silence at most, plus time for a busy machine. A run that ends by itself may take longer, and
    // so may a crash under a sanitizer, which writes its report while other threads continue.
    const bool atOnce = signal == SIGKILL || (signal == SIGSEGV && !kSanitized);
    CHECK(device.feels(0.0, 0.0, atOnce ? 200 : 20000));
    const bool quiet = blocked.has_value(); // it then ends by SIGPIPE where it prints
    blocked.reset();
    int status = 0;
    ::waitpid(engine, &status, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK(device.fz == 0.0);
    if (quiet) {
        CHECK_FALSE((WIFSIGNALED(status) && WTERMSIG(status) != SIGPIPE));
    } else if (signal == SIGINT || signal == SIGHUP) {
        CHECK(WIFEXITED(status));
        CHECK(WEXITSTATUS(status) == 0);
        const auto summary = nlohmann::json::parse(stage.read("out/summary.json"));
        CHECK(summary["haptic"]["max_penetration_m"].get<double>() <= 1e-5);
    } else {
        CHECK((WIFSIGNALED(status) || (kSanitized && signal == SIGSEGV))); // sanitizers exit then
    }
}

TEST_CASE("The log reports when a device disconnects during a run and when it is back") {
    Stage stage;
    stage.recording(std::vector<Image>(3, Image(kWidth, kHeight, 600).paint(kAll, kRed)));
    stage.scene({});
    std::optional<PlayedDevice> device;
    device.emplace(stage / "hand.door");
    const pid_t engine = startFathom(
        stage.command({"--realtime", "--hand-device", (stage / "hand.door").string(), "--seconds", "300"}),
        stage / "said");
    const auto says = [&](const char* words) {
        return testing::eventually([&] { return stage.read("said").find(words) != std::string::npos; });
    };
    REQUIRE(device->awaitWrench());
    device.reset();
    CHECK(says("gone or silent: forces fade out, the tool stays"));
    device.emplace(stage / "hand.door");
    CHECK(says("back; the tool resumes from its position"));
    CHECK(exitCodeOf(engine, SIGINT) == 0);
}

TEST_CASE(
    "--seconds ends a run that waits for its hand, after a line that says why its samples are refused") {
    Stage stage;
    setUpNearWall(stage);
    DeviceSocket endpoint = DeviceSocket::listen(stage / "hand.door", 1), engine;
    std::atomic<bool> stop{false};
    std::thread bridge([&] {
        for (uint64_t sequence = 1; !stop; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
            engine = engine.open() ? std::move(engine) : endpoint.accept();
            fathom_door_hand packet = testing::handPacket(sequence++, 0.0);
            packet.orientation[0] = 0.0; // it is 0 0 0 0
            std::string("falcon").copy(packet.preset, sizeof packet.preset);
            engine.send(packet);
        }
    });
    const ProgramRun run = runFathom(
        stage.command({"--realtime", "--hand-device", (stage / "hand.door").string(), "--seconds", "2"}));
    stop = true;
    bridge.join();
    CHECK(run.exitCode == 3);
    const size_t cause = run.err.find("samples refused: orientation 0 0 0 0 (allowed: ");
    CHECK_MESSAGE(cause < run.err.find("waiting for a usable sample of "), run.err);
    CHECK(run.err.find("no usable sample in --seconds 2") != std::string::npos);
}

TEST_CASE("A live hand without --realtime, with a path or without a bridge is rejected in one line") {
    Stage stage;
    stage.recording({Image(kWidth, kHeight, 600).paint(kAll, kRed)});
    stage.scene({});
    const auto refused = [&](const std::vector<std::string>& more, const std::string& part) {
        const ProgramRun run = runFathom(stage.command(more));
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK_MESSAGE(run.errorLines()[0].find(part) != std::string::npos, run.errorLines()[0]);
    };
    refused({"--hand-device", "falcon"}, "--hand-device: falcon (allowed: together with --realtime)");
    refused({"--view-door", "x"}, "--view-door: x (allowed: together with --realtime)");
    refused({"--realtime", "--hand-device", (stage / "no.door").string()}, "no bridge listens");
    refused({"--realtime", "--hand-device", "spacemouse:/dev/hidraw250"}, "no SpaceMouse");
    refused({"--realtime", "--hand", "--hand-device", "falcon"}, "--hand");
}
