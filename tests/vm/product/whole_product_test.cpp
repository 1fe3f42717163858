// SPDX-License-Identifier: Apache-2.0
// The whole program from outside, in the virtual machine: a simulated camera on the kernel's own UVC driver,
// fathom's own passes on the software device, forces in the file. No rate is asserted: the machine is
// emulated.
#include "devices/recorded/recorded_camera.h"
#include "devices/v4l2/video_node.h"
#include "tests/rig/run_fathom.h"
#include "tests/support/scratch_folder.h"
#include "tests/vm/uvc_camera.h"
#include "tests/vm/vhci_port.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

using namespace fathom;
using namespace fathom::vm;

namespace {

constexpr uint16_t kWidth = 160, kHeight = 120;

// A block in the middle at 0.5 m in front of a wall at 0.9 m.
bool onBlock(uint32_t x, uint32_t y) {
    return x > 60 && x < 100 && y > 40 && y < 80;
}

void paintDepth(uint32_t, Bytes& image) {
    for (uint32_t i = 0; i < uint32_t{kWidth} * kHeight; ++i) {
        const uint16_t value = onBlock(i % kWidth, i / kWidth) ? 500 : 900;
        image[2 * i] = static_cast<uint8_t>(value);
        image[2 * i + 1] = static_cast<uint8_t>(value >> 8);
    }
}

// The block red, the wall grey.
void paintColour(uint32_t, Bytes& image) {
    for (uint32_t i = 0; i < uint32_t{kWidth} * kHeight; i += 2) {
        const bool red = onBlock(i % kWidth, i / kWidth);
        image[2 * i] = image[2 * i + 2] = red ? 81 : 120;
        image[2 * i + 1] = red ? 90 : 128;
        image[2 * i + 3] = red ? 240 : 128;
    }
}

using CsvRow = std::map<std::string, double>; // numbers only

std::vector<CsvRow> readCsv(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::vector<std::string> names;
    std::vector<CsvRow> rows;
    for (std::string line, word; std::getline(in, line);) {
        std::istringstream words(line);
        CsvRow row;
        for (size_t i = 0; std::getline(words, word, ','); ++i) {
            if (rows.empty() && i == names.size()) {
                names.push_back(word);
            }
            row[names.at(i)] = std::strtod(word.c_str(), nullptr);
        }
        rows.push_back(std::move(row));
    }
    rows.erase(rows.begin()); // the names
    return rows;
}

struct Stage {
    Stage()
        : camera({.width = kWidth, .height = kHeight, .paintDepth = paintDepth, .paintColour = paintColour}) {
        std::ofstream(folder / "lens.json")
            << R"({"width": 160, "height": 120, "fx": 150, "fy": 150, "cx": 80, "cy": 60, "depth_scale_m_per_unit": 0.001})";
        std::ofstream(folder / "scene.yaml")
            << "camera: {source: {v4l2: \"auto,intrinsics=lens.json\"}, near: 0.2, far: 2.0}\n"
               "fixtures:\n  - {name: block, role: forbidden, hue: [340, 20], saturation: [0.5, 1], radius: "
               "0.04}\n"
               "filter: {radius: 0, edge: 0}\nerror_budget: 0\nhold_s: 0\n"
               "contact: {where: cpu}\nhaptics: {rate_hz: 200, stiffness: 300}\n"
               "tool: {spheres: [[0, 0, 0, 0.01]]}\n";
        camera.plug();
        REQUIRE(waitFor([] {
            size_t nodes = 0;
            for (const VideoNode& node : openVideoNodes()) {
                nodes += node.offers(fourccOf("Z16 ")) || node.offers(fourccOf("YUYV")) ? 1 : 0;
            }
            return nodes == 2;
        }));
    }
    std::string file(const char* name) const { return (folder / name).string(); }
    nlohmann::json summary() const {
        return nlohmann::json::parse(std::ifstream(folder / "out/summary.json"));
    }

    testing::ScratchFolder folder;
    UvcCamera camera;
};

} // namespace

TEST_CASE("A live camera gives regions that push back; forces fade when it is unplugged, and the run resumes "
          "when it is back") {
    Stage stage;
    // Down onto the block from above, and 20 mm into its region.
    std::ofstream(stage.folder / "press.csv") << "t_s,x,y,z,qw,qx,qy,qz\n0,0,0,0.35,1,0,0,0\n"
                                                 "2,0,0,0.47,1,0,0,0\n10,0,0,0.47,1,0,0,0\n";
    std::thread pull([&stage] {
        waitFor([&stage] { return std::filesystem::exists(stage.folder / "view.door"); }, // turns begin
                std::chrono::seconds(90));
        std::this_thread::sleep_for(std::chrono::seconds(3));
        stage.camera.unplug();
        std::this_thread::sleep_for(std::chrono::seconds(1));
        stage.camera.plug();
    });
    const ProgramRun run = runFathom({"replay", stage.file("scene.yaml"), "--realtime", "--device",
                                      "llvmpipe", "--operator", stage.file("press.csv"), "--view-door",
                                      stage.file("view.door"), "--out", stage.file("out")});
    pull.join();
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
    const auto summary = stage.summary();
    CHECK(summary["frames"]["count"].get<int>() > 5);
    CHECK(summary["frames"]["exposure_to_published_ms"]["p50"].get<double>() > 0.0);
    CHECK(summary["haptic"]["max_penetration_m"].get<double>() <= 1e-5);
    CHECK(summary["fixtures"][0]["points_mean"].get<double>() == doctest::Approx(39 * 39).epsilon(0.1));
    CHECK(summary["lockstep"] == false);
    // The block is at 0.5 m, its region 40 mm, the tool 10 mm: it is held at 0.45 m although the hand is at
    // 0.47 m.
    const auto rows = readCsv(stage.folder / "out/haptics.csv");
    CHECK(std::any_of(rows.begin(), rows.end(), [](const CsvRow& r) { return r.at("contacts") > 0.0; }));
    for (const CsvRow& row : rows) {
        const bool seen = row.at("frame") >= 0.0;
        CHECK((!seen || row.at("tool_z") < 0.4502));
    }
    CHECK(rows.back().at("dev_z") == doctest::Approx(0.47));
    // Forces act while frames are fresh. An emulated machine may be too slow; then a message reports it.
    const bool fresh = std::any_of(rows.begin(), rows.end(), [](const CsvRow& r) {
        return r.at("contacts") > 0.0 && r.at("scene_age_s") < 0.1;
    });
    if (fresh) {
        CHECK(summary["haptic"]["max_force_N"].get<double>() > 0.0);
    } else {
        MESSAGE("this machine is too slow for forces: no frame became a region within 100 ms");
    }
    // Depth was read in the kernel driver's buffers, before and after the unplugging.
    const size_t inPlace = run.out.find(" read where the camera left them");
    REQUIRE(inPlace != std::string::npos);
    const size_t number = run.out.rfind(' ', inPlace - 1) + 1;
    CHECK(std::stoi(run.out.substr(number, inPlace - number)) > summary["frames"]["count"].get<int>() / 2);
    CHECK(run.err.find("camera is gone") != std::string::npos);
    CHECK(run.err.find("camera is back") != std::string::npos);
    CHECK(run.err.find("forces fade") != std::string::npos);
    MESSAGE(run.out);
}

TEST_CASE(
    "The list of devices shows depth and colour of a camera with the source option, and no metadata node") {
    Stage stage;
    const ProgramRun run = runFathom({"devices"});
    INFO(run.err);
    MESSAGE(run.out);
    CHECK(run.exitCode == 0);
    const auto count = [&run](const std::string& part) {
        size_t found = 0;
        for (size_t at = run.out.find(part); at != std::string::npos; at = run.out.find(part, at + 1)) {
            ++found;
        }
        return found;
    };
    CHECK(count("camera  /dev/video") == 2); // of four nodes
    CHECK(count("1209:d3d3 at usb ") == 2);
    CHECK(count("\n          depth Z16 160x120; --source v4l2:/dev/video") == 1);
    CHECK(count("\n          colour only: YUYV 160x120; --source v4l2:DEPTH,colour=/dev/video") == 1);
}

TEST_CASE("A live camera in lockstep is rejected") {
    Stage stage;
    const ProgramRun run = runFathom({"replay", stage.file("scene.yaml"), "--out", stage.file("out")});
    CHECK(run.exitCode == 2);
    CHECK(run.err.find("--realtime with a live camera") != std::string::npos);
}

TEST_CASE("A recording of a live camera has every frame at 30 per second") {
    Stage stage;
    const ProgramRun record = runFathom({"record", stage.file("scene.yaml"), "--source",
                                         "v4l2:auto,frames=60,rate=30,intrinsics=" + stage.file("lens.json"),
                                         "--out", stage.file("rec")});
    INFO(record.err);
    CHECK(record.out.find("60 frames") != std::string::npos);
    CHECK(record.exitCode == 0);
    CHECK(record.out.find("0 skipped, 0 lost") != std::string::npos);
    MESSAGE(record.out);
    RecordedCamera camera(stage.folder / "rec");
    Bytes wanted(2 * kWidth * kHeight);
    paintDepth(0, wanted);
    int count = 0;
    while (const auto frame = camera.next()) {
        CHECK(std::memcmp((*frame)->depth.data(), wanted.data(), wanted.size()) == 0);
        ++count;
    }
    CHECK(count == 60);
}
