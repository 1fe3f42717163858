// SPDX-License-Identifier: Apache-2.0
// The whole product in the virtual machine: a simulated camera on the kernel's UVC driver, a simulated Falcon
// on its USB stack behind its bridge process, and the engine between them. Checks the motor commands that
// reach the device.
#include "devices/usb/falcon_drive.h"
#include "devices/usb/falcon_kinematics.h"
#include "devices/v4l2/video_node.h"
#include "tests/devices/socket_rig.h"
#include "tests/vm/haptic/falcon_device.h"
#include "tests/vm/uvc_camera.h"
#include "tests/vm/vhci_port.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include <fcntl.h>

using namespace fathom;
using namespace fathom::testing;
using fathom::vm::FalconDevice;
using fathom::vm::UvcCamera;

namespace {

using Motors = std::array<int16_t, 3>;
constexpr Motors kStill{};
constexpr uint16_t kWidth = 16, kHeight = 12;     // little work for an emulated processor
constexpr double kOpen = 0.100, kPressed = 0.135; // [m] of the knob along z

// A wall at 0.5 m: all of it is forbidden.
void paintWall(uint32_t, vm::Bytes& image) {
    for (uint32_t i = 0; i < uint32_t{kWidth} * kHeight; ++i) {
        image[2 * i] = static_cast<uint8_t>(500 & 255);
        image[2 * i + 1] = static_cast<uint8_t>(500 >> 8);
    }
}

// The program, with its messages in a file.
int runProgram(const std::filesystem::path& log, std::vector<std::string> words) {
    const int out = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(out, 1);
    ::dup2(out, 2);
    words.insert(words.begin(), "fathom");
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    return ::execv(FATHOM_PROGRAM, arguments.data());
}

// Each leg in the direction of the force, with a substantial part of a newton.
bool pushes(const Motors& motors, const Motors& newton) {
    for (size_t leg = 0; leg < motors.size(); ++leg) {
        if (motors[leg] * newton[leg] <= 0 || std::abs(motors[leg]) < std::abs(newton[leg]) / 2) {
            return false;
        }
    }
    return true;
}

// Number of Falcons on the kernel's buses. A port is free a moment before its device is removed.
size_t falconsOnBus() {
    const auto holds = [](const std::filesystem::path& file, const char* id) {
        std::string text;
        return std::ifstream(file) >> text && text == id;
    };
    const std::filesystem::directory_iterator devices("/sys/bus/usb/devices");
    return static_cast<size_t>(std::count_if(begin(devices), end(devices), [&](const auto& device) {
        return holds(device.path() / "idVendor", "0403") && holds(device.path() / "idProduct", "cb48");
    }));
}

struct Stage {
    Stage()
        : camera({.width = kWidth, .height = kHeight, .colour = false, .paintDepth = paintWall}) {
        std::ofstream(file("lens.json"))
            << R"({"width": 16, "height": 12, "fx": 15, "fy": 15, "cx": 8, "cy": 6, "depth_scale_m_per_unit": 0.001, "has_color": false})";
        std::ofstream(file("scene.yaml"))
            << "camera: {source: {v4l2: \"auto,intrinsics=lens.json\"}, near: 0.2, far: 2.0}\n"
               "fixtures: [{name: wall, role: forbidden, radius: 0.08}]\n"
               "filter: {radius: 0, edge: 0}\nerror_budget: 0\nhold_s: 0\ncontact: {where: cpu}\n"
               "hand: {path: start.csv}\nhaptics: {rate_hz: 200, stiffness: 300}\ntool: {spheres: [[0, 0, 0, "
               "0.01]]}\n";
        // The wall's region ends at 0.42 m, so the tool's centre rests at 0.41 m.
        std::ofstream(file("start.csv")) << "t_s,x,y,z,qw,qx,qy,qz\n0,0,0,0.39,1,0,0,0\n";
        moveKnob(kOpen);
        falcon.leastMs = 3; // slower than 1 kHz, to reduce the load of an emulated processor
        REQUIRE(eventually([] { return falconsOnBus() == 0; }));
        falcon.plug();
        camera.plug();
        REQUIRE(eventually([] { return falconsOnBus() == 1; }));
        REQUIRE(eventually([] {
            const auto nodes = openVideoNodes();
            return std::any_of(nodes.begin(), nodes.end(),
                               [](const VideoNode& n) { return n.offers(fourccOf("Z16 ")); });
        }));
    }
    std::string file(const char* name) const { return (folder.path() / name).string(); }
    std::string text(const char* name) const {
        std::ifstream in(file(name));
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void moveKnob(double z) { falcon.setEncoders(encodersAt(z)); }
    static Motors encodersAt(double z) {
        return FalconKinematics::encoderOf(*FalconKinematics::inverse({0.0, 0.0, z}));
    }

    void push(double from, double to) {
        for (int i = 1; i <= 35; ++i) {
            moveKnob(from + (to - from) * i / 35.0);
            pauseMs(10);
        }
    }
    // Motor commands of the bridge's drive for a force there.
    static Motors motorsFor(const dvec3& force, double z) {
        FalconDrive drive;
        HandSample sample;
        FalconState state;
        state.encoder = encodersAt(z);
        state.homed = 7;
        REQUIRE(drive.place(state, sample));
        return drive.motors(force);
    }

    SocketFolder folder;
    UvcCamera camera;
    FalconDevice falcon;
};

// The bridge process with its socket open.
struct BridgeProcess {
    explicit BridgeProcess(const Stage& stage)
        : process([&] {
            return runProgram(stage.file("guard.log"),
                              {"guard", "falcon", "--door", stage.folder.endpoint().string()});
        }) {
        const bool endpoint =
            eventually([&] { return std::filesystem::exists(stage.folder.endpoint()); }, 60);
        INFO(stage.text("guard.log"));
        REQUIRE(endpoint);
    }
    Child process;
};

} // namespace

TEST_CASE("A surface in the camera's view pushes a Falcon's knob back, and the wrench at the device ends "
          "with the run") {
    Stage stage;
    BridgeProcess bridge(stage);
    Child engine([&] {
        return runProgram(stage.file("replay.log"),
                          {"replay", stage.file("scene.yaml"), "--realtime", "--device", "llvmpipe",
                           "--hand-device", stage.folder.endpoint().string(), "--seconds", "600",
                           "--view-door", stage.file("view.door"), "--out", stage.file("out")});
    });
    const bool ticks = eventually([&] { return std::filesystem::exists(stage.file("view.door")); }, 300);
    INFO(stage.text("replay.log"));
    REQUIRE(ticks);
    const uint64_t commands = stage.falcon.commands;
    REQUIRE(eventually([&] { return stage.falcon.commands > commands + 50; }, 60));
    CHECK(stage.falcon.motors() == kStill); // 20 mm before the region: no force
    stage.push(kOpen, kPressed);
    // Matches the mechanism's Jacobian for a force along -z: towards the pilot, out of the wall.
    const Motors away = Stage::motorsFor({0.0, 0.0, -1.0}, kPressed);
    const bool pushed = eventually([&] { return pushes(stage.falcon.motors(), away); }, 60);
    INFO(stage.text("replay.log"));
    CHECK(pushed);
    const Motors felt = stage.falcon.motors();
    MESSAGE("motor commands at the device: " << felt[0] << " " << felt[1] << " " << felt[2] << ", of "
                                             << away[0] << " " << away[1] << " " << away[2] << " for 1 N");
    stage.push(kPressed, kOpen); // outside again the force is gone, while the run continues
    CHECK(eventually([&] { return stage.falcon.motors() == kStill; }, 60));
    stage.push(kOpen, kPressed);
    CHECK(eventually([&] { return pushes(stage.falcon.motors(), away); }, 60));
    engine.signal(SIGINT);
    CHECK(engine.wait() == 0);
    CHECK(eventually([&] { return stage.falcon.motors() == kStill; }));
    const auto summary = nlohmann::json::parse(std::ifstream(stage.file("out/summary.json")));
    CHECK(summary["haptic"]["max_penetration_m"].get<double>() <= 1e-5);
    CHECK(summary["haptic"]["max_force_N"].get<double>() > 1.0);
    CHECK(summary["frames"]["count"].get<int>() > 3);
    bridge.process.signal(SIGINT);
    CHECK(bridge.process.wait() == 0);
}

TEST_CASE("A recording with a live hand has every frame at 30 per second and the knob's path, without forces "
          "at the knob") {
    Stage stage;
    BridgeProcess bridge(stage);
    Child record([&] {
        return runProgram(stage.file("record.log"),
                          {"record", stage.file("scene.yaml"), "--source",
                           "v4l2:auto,frames=90,rate=30,intrinsics=" + stage.file("lens.json"),
                           "--hand-device", stage.folder.endpoint().string(), "--out", stage.file("rec")});
    });
    const bool begun = eventually(
        [&] {
            return std::filesystem::exists(stage.folder.path() / "rec/associations.txt") ||
                   std::filesystem::exists(stage.folder.path() / "rec/depth.txt");
        },
        60);
    INFO(stage.text("record.log"));
    REQUIRE(begun);
    bool still = true;
    for (int i = 1; i <= 35; ++i) { // 0.35 s of the 3 s
        stage.moveKnob(kOpen + (kPressed - kOpen) * i / 35.0);
        pauseMs(10);
        still = still && stage.falcon.motors() == kStill;
    }
    CHECK(still);
    CHECK(record.wait() == 0);
    const std::string said = stage.text("record.log");
    INFO(said);
    CHECK(said.find("90 frames") != std::string::npos);
    CHECK(said.find("0 skipped, 0 lost") != std::string::npos);
    // The hand's path: from the knob's start to its pushed position, in time order, as long as the frames.
    std::ifstream rows(stage.file("rec/hand.csv"));
    std::string line;
    std::getline(rows, line);
    CHECK(line == "t_s,x,y,z,qw,qx,qy,qz,button");
    double t = -1.0, first = 0.0, z = 0.0;
    int count = 0;
    while (std::getline(rows, line)) {
        double now = 0.0, x = 0.0, y = 0.0;
        REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &now, &x, &y, &z) == 4);
        CHECK(now > t);
        t = now;
        first = count++ == 0 ? z : first;
    }
    CHECK(count > 90);
    CHECK(t == doctest::Approx(3.0).epsilon(0.05)); // lockstep: frame j is at j / 30 s
    CHECK(std::abs(z - first - (kPressed - kOpen)) < 0.002);
    bridge.process.signal(SIGTERM);
    CHECK(bridge.process.wait() == 0);
}
