// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_target.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <spdlog/spdlog.h>
#include <string_view>

#include <unistd.h>

namespace fathom::testing {

namespace {

constexpr std::array kTargets{
    FuzzTarget{"bag", readBag},
    FuzzTarget{"database", readDatabase},
    FuzzTarget{"depth_image", readDepthFile},
    FuzzTarget{"descriptors", readDescriptors},
    FuzzTarget{"eca", readEca},
    FuzzTarget{"falcon", readFalcon},
    FuzzTarget{"firmware", readFirmware},
    FuzzTarget{"haply", readHaply},
    FuzzTarget{"index", readIndexFile},
    FuzzTarget{"intrinsics", readIntrinsicsFile},
    FuzzTarget{"jpeg", readJpegImage},
    FuzzTarget{"kinect_calibration", readKinectCalibration},
    FuzzTarget{"matroska", readMatroska},
    FuzzTarget{"mcap", readMcap},
    FuzzTarget{"mesh", readMesh, 20}, // a process each
    FuzzTarget{"message", readMessage},
    FuzzTarget{"message_image", readMessageImage},
    FuzzTarget{"pairs", readPairs},
    FuzzTarget{"pcd", readPcdFile},
    FuzzTarget{"pixels", readPixels},
    FuzzTarget{"ply", readPlyFile},
    FuzzTarget{"png", readPng},
    FuzzTarget{"reach", readReach},
    FuzzTarget{"ros2_hand", readRos2Hand},
    FuzzTarget{"scene", readScene},
    FuzzTarget{"sdk_messages", readSdkMessages},
    FuzzTarget{"socket", readEndpoint},
    FuzzTarget{"source", readSourceText},
    FuzzTarget{"space_mouse", readSpaceMouse},
    FuzzTarget{"sph", readSphFile},
    FuzzTarget{"spheres_yaml", readSpheresYaml},
    FuzzTarget{"ticks", readTicks},
    FuzzTarget{"tracks", readTracks},
    FuzzTarget{"urdf", readUrdfFile, 20}, // a process each
    FuzzTarget{"urdf_packet", readUrdfPacket},
};

// Removed at process exit.
class Folder {
public:
    Folder() {
        const std::filesystem::path memory = "/dev/shm";
        const auto above =
            ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
        path_ = above / ("fathom-fuzz-" + std::to_string(::getpid()));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

[[noreturn]] void finding(const FuzzTarget& target, const char* what) {
    std::fprintf(stderr, "finding: target %s: %s\n", target.name, what);
    std::abort();
}

} // namespace

std::span<const FuzzTarget> fuzzTargets() {
    return kTargets;
}

std::filesystem::path fuzzFile(const std::string& name, Bytes content) {
    static const Folder kFolder;
    const auto file = kFolder.path() / name;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    return file;
}

bool runFuzzTarget(const FuzzTarget& target, Bytes input) {
    spdlog::set_level(spdlog::level::off);
    try {
        target.read(input);
        return true;
    } catch (const Error& e) {
        const std::string_view line = e.what();
        if (line.empty() || std::ranges::any_of(line, [](unsigned char c) { return std::iscntrl(c) != 0; })) {
            finding(target, (std::string("a refusal that is not one line: ") + e.what()).c_str());
        }
    } catch (const std::exception& e) {
        finding(target, (std::string("an exception that is no refusal: ") + e.what()).c_str());
    }
    return false;
}

void need(bool holds) {
    if (!holds) {
        std::abort();
    }
}

} // namespace fathom::testing
