// SPDX-License-Identifier: Apache-2.0
// `fathom inspect`: what is printed of streams, lenses, times, depth and colour.
#include "apps/binding/open_recording.h"
#include "apps/inspect/frame_study.h"
#include "apps/inspect/stream_report.h"
#include "engine/types/error.h"
#include "tests/devices/bag_maker.h"
#include "tests/support/mentions.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <sstream>
#include <tuple>

using namespace fathom;
using fathom::testing::mentions;

namespace {

std::vector<MessageEntry> messagesAt(const std::vector<double>& seconds) {
    std::vector<MessageEntry> messages;
    for (const double t : seconds) {
        messages.push_back({1'700'000'000'000'000'000u + static_cast<uint64_t>(t * 1e9), 0, 0});
    }
    return messages;
}

// Frames of one depth and one colour.
class PlainCamera final : public Camera {
public:
    PlainCamera(uint32_t frames, uint16_t depth, uint32_t colour)
        : frames_(frames)
        , depth_(35, depth)
        , colour_(35, colour) {
        info_.depth = {7, 5, 10.0, 10.0, 3.0, 2.0, {}, false, LensModel::Polynomial, {}};
        info_.colour = info_.depth;
        depth_[0] = 0;
    }
    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override {
        if (next_ == frames_) {
            return std::nullopt;
        }
        Frame::Content content;
        content.index = next_;
        content.captureTime = 100.0 + 0.1 * next_++;
        content.depth = depth_;
        content.colour = colour_;
        return Frame(content, [] {});
    }
    uint32_t skipped() const override { return 2; }
    std::string description() const override { return "plain"; }

private:
    CameraInfo info_;
    uint32_t frames_, next_ = 0;
    std::vector<uint16_t> depth_;
    std::vector<uint32_t> colour_;
};

std::string reportOf(Camera& camera, const std::optional<std::filesystem::path>& folder = {}) {
    std::ostringstream out;
    FrameStudy(camera, folder).write(out);
    return out.str();
}

} // namespace

TEST_CASE("The rate of a stream is that of its intervals, and a gap is an interval over 1.5 medians") {
    const Rate steady = Rate::of(messagesAt({0.0, 0.1, 0.2, 0.3}));
    CHECK(steady.perSecond == doctest::Approx(10.0));
    CHECK(steady.gaps == 0);
    const Rate torn = Rate::of(messagesAt({0.0, 0.1, 0.2, 1.2, 1.3}));
    CHECK(torn.gaps == 1);
    CHECK(torn.longestGap == doctest::Approx(1.0));
    CHECK(torn.at == doctest::Approx(0.2));
    CHECK(Rate::of(messagesAt({})).perSecond == 0.0);
    CHECK(Rate::of(messagesAt({5.0})).perSecond == 0.0);
    CHECK(Rate::of(messagesAt({5.0, 5.0})).perSecond == 0.0); // two messages at one time
}

TEST_CASE("Streams of a bag are listed with type, count, encoding, size, frame and lens, also unread ones") {
    testing::BagMaker maker;
    testing::ImageMessage depth;
    depth.pixels.assign(8 * 6 * 2, '\1');
    for (int i = 0; i < 3; ++i) {
        maker.add("/camera/depth/image_raw", "sensor_msgs/Image", 1.0 + 0.5 * i,
                  testing::imageMessage(1.0 + 0.5 * i, depth));
        maker.add("/odd", "std_msgs/String", 1.0, testing::Out().text("x").bytes);
    }
    const testing::ScratchFolder folder;
    std::ofstream(folder.path() / "a.bag", std::ios::binary) << maker.bag();
    std::ostringstream out;
    writeStreams(*openMessageFile(folder.path() / "a.bag"), "", out);
    mentions(out.str(), "/camera/depth/image_raw");
    mentions(out.str(), "sensor_msgs/Image");
    mentions(out.str(), "2/s");
    mentions(out.str(), "8x6 16UC1, frame 'camera', lens: ");
    mentions(out.str(), "/odd");
    CHECK(out.str().find("camera_info") != std::string::npos); // why there is no lens
}

TEST_CASE("Recordings of cameras' SDKs are recognised by their first bytes, and listed with their lenses") {
    const std::filesystem::path corpus = "tests/fuzz/corpus";
    for (const auto& [file, image, lens] :
         {std::tuple("bag/orbbec", "5x3 mono16, frame '', lens: 5x3, fx 4.5", "/cam/streamProfileType_3"),
          std::tuple("database/realsense", "5x3 mono16, frame 'Depth', lens: 5x3, fx 4.5",
                     "/device_0/sensor_0/Depth_0/camera_info"),
          std::tuple("matroska/libmatroska", "16x9 bgra8, frame 'COLOR', lens: 16x9, fx 8 fy 6 cx 7.5 cy 4",
                     "COLOR/camera_info")}) {
        const auto messages = openMessages((corpus / file).string());
        REQUIRE(messages != nullptr);
        std::ostringstream out;
        writeStreams(*messages, "", out);
        mentions(out.str(), image);
        mentions(out.str(), lens);
    }
}

TEST_CASE("A recording that is a pointer of Git LFS or an archive is refused as such, whatever its name") {
    const testing::ScratchFolder folder;
    for (const char* name : {"a.bag", "a.mcap", "a.db3", "a.mkv", "a.pcd", "a.ply", "a.zip"}) {
        for (const auto& [begin, what] :
             {std::pair("version https://git-lfs.github.com/spec/v1\n", "Git LFS"),
              {"PK\x03\x04", "ZIP archive"}}) {
            folder.write(name, begin);
            CAPTURE(name);
            CHECK_THROWS_WITH_AS(openRecording({(folder / name).string(), {}}), doctest::Contains(what),
                                 BadInput);
        }
    }
}

TEST_CASE("A metadata.yaml marks a recording of ROS 2 by its content or by the files of its folder, not by "
          "its name") {
    const testing::ScratchFolder folder;
    const auto write = [&](const char* name, const std::string& text) {
        testing::put(folder.path() / name, text);
    };
    write("camera_intrinsic.json", "{}");
    write("metadata.yaml", "name: kitchen\nlicense: CC-BY\n"); // of a data set of images
    CHECK(openMessages(folder.path().string()) == nullptr);
    write("metadata.yaml", "rosbag2_bagfile_information: {relative_file_paths: [a_0.mcap]}\n");
    CHECK_THROWS_WITH_AS(openMessages(folder.path().string()), doctest::Contains("files: none"), BadInput);
    std::filesystem::copy("tests/fuzz/corpus/mcap/zstd", folder.path() / "a_0.mcap");
    CHECK(openMessages(folder.path().string()) != nullptr);
    write("metadata.yaml", ""); // lost with the power
    CHECK(openMessages(folder.path().string()) != nullptr);
}

TEST_CASE("The frames of a camera are counted, timed and measured, and its first frame is saved") {
    const testing::ScratchFolder folder;
    PlainCamera camera(11, 500, 0xff0000ff);
    const std::string text = reportOf(camera, folder.path() / "pictures");
    mentions(text, "11 read; 2 skipped; 0 with the camera's pose");
    mentions(text, "from 100.000 s, 1.000 s long, 10.00 frames/s; longest gap 0.100 s");
    mentions(text, "97.1 % of the pixels measured; 0.500 m nearest, 0.500 m median, 0.500 m farthest");
    mentions(text, "100.0 % of the pixels have a saturation over 0.1");
    CHECK(std::filesystem::file_size(folder.path() / "pictures/depth.png") > 0);
    CHECK(std::filesystem::file_size(folder.path() / "pictures/colour.png") > 0);
}

TEST_CASE("A camera without a frame, without depth and without colour is described, too") {
    PlainCamera none(0, 500, 0);
    mentions(reportOf(none), "0 read");
    PlainCamera blind(1, 0, 0xff808080);
    const std::string text = reportOf(blind);
    mentions(text, "0.0 % of the pixels measured\n");
    mentions(text, "0.0 % of the pixels have a saturation over 0.1");
    PlainCamera more(FrameStudy::kMaxFrames + 1, 65535, 0);
    mentions(reportOf(more), "300 read, the first ones");
}
