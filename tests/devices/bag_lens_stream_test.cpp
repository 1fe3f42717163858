// SPDX-License-Identifier: Apache-2.0
// Recordings of ROS 2 as drivers make them: each image comes with a lens, which is read between the image and
// its pixels.
#include "devices/bag/bag_camera.h"
#include "devices/bag/mcap_records.h"
#include "devices/bag/mcap_writer.h"
#include "devices/bag/ros2_messages.h"
#include "engine/types/colour_copy.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/database_maker.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

#include <map>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr uint32_t kLensWide = 50, kLensHigh = 3;
constexpr uint64_t kLensTick = 100'000'000; // [ns]

std::string textOfBytes(const std::vector<uint8_t>& bytes) {
    return {bytes.begin(), bytes.end()};
}

// Frame i has depth 500 + i and colour (200, 10, i) in all pixels. Lenses come behind their images.
std::vector<DatabaseMessage> lensStream(uint8_t frames) {
    Intrinsics lens;
    lens.width = kLensWide;
    lens.height = kLensHigh;
    lens.fx = lens.fy = 30.0;
    lens.cx = 19.5;
    lens.cy = 1.0;
    std::vector<DatabaseMessage> all;
    const auto addImage = [&](const std::string& camera, int64_t time, const std::string& encoding,
                              const std::string& pixels) {
        const auto step = static_cast<uint32_t>(pixels.size() / kLensHigh);
        all.push_back({camera + "/image_raw", "sensor_msgs/msg/Image", time,
                       imageCdr(time, {"camera", encoding, kLensWide, kLensHigh, step, pixels})});
        const ros2::Header head{static_cast<uint64_t>(time), "camera"};
        all.push_back({camera + "/camera_info", "sensor_msgs/msg/CameraInfo", time + 1000,
                       textOfBytes(ros2::cameraInfo(head, lens))});
    };
    for (uint8_t i = 0; i < frames; ++i) {
        const int64_t time = (i + 1) * static_cast<int64_t>(kLensTick);
        addImage("/c/depth", time, "16UC1", filled(static_cast<uint16_t>(500 + i), kLensWide * kLensHigh));
        addImage("/c/rgb", time + 2000, "rgb8", filledColour(200, 10, i, kLensWide * kLensHigh));
    }
    return all;
}

// Every message in a chunk of its own, so that images and lenses never share one.
void writeChunks(const std::filesystem::path& file, const std::vector<DatabaseMessage>& all) {
    McapWriter writer(file, 1);
    std::map<std::string, uint16_t> channels;
    for (const DatabaseMessage& message : all) {
        if (!channels.contains(message.topic)) {
            channels[message.topic] = writer.addChannel(message.topic, message.type, "");
        }
        const auto* bytes = reinterpret_cast<const uint8_t*>(message.bytes.data());
        writer.add(channels[message.topic], static_cast<uint64_t>(message.time),
                   {bytes, message.bytes.size()});
    }
    writer.finish();
}

// An MCAP file without chunks and summary.
std::string unchunked(const std::vector<DatabaseMessage>& all) {
    const std::string magic(mcap::kMagic.begin(), mcap::kMagic.end());
    Out out{magic};
    const auto record = [&](uint8_t kind, const Out& content) {
        out.put(kind).put(uint64_t{content.bytes.size()}).bytes += content.bytes;
    };
    record(1, Out().text("").text(""));
    std::map<std::string, uint16_t> channels;
    for (const DatabaseMessage& message : all) {
        const auto [channel, isNew] =
            channels.emplace(message.topic, static_cast<uint16_t>(channels.size() + 1));
        if (isNew) {
            record(mcap::kSchema,
                   Out().put(channel->second).text(message.type).text("ros2msg").put(uint32_t{0}));
            record(mcap::kChannel, Out()
                                       .put(channel->second)
                                       .put(channel->second)
                                       .text(message.topic)
                                       .text("cdr")
                                       .put(uint32_t{0}));
        }
        Out content;
        content.put(channel->second).put(uint32_t{0}).put(message.time).put(message.time);
        content.bytes += message.bytes;
        record(mcap::kMessage, content);
    }
    record(mcap::kFooter, Out().put(uint64_t{0}).put(uint64_t{0}).put(uint32_t{0}));
    return out.bytes + magic;
}

void checkLensStream(const std::filesystem::path& file, uint8_t frames) {
    CAPTURE(file);
    BagCamera camera(file);
    for (uint8_t i = 0; i < frames; ++i) {
        const auto frame = camera.next();
        REQUIRE(frame);
        for (size_t pixel = 0; pixel < size_t{kLensWide} * kLensHigh; ++pixel) {
            REQUIRE((*frame)->depth[pixel] == 500 + i);
            REQUIRE(coloursOf(**frame)[pixel] == (0xff000ac8u | uint32_t{i} << 16));
        }
    }
    CHECK_FALSE(camera.next());
    CHECK(camera.skipped() == 0);
}

} // namespace

TEST_CASE(
    "Images keep all their pixels where each comes with its lens, in every kind of recording of ROS 2") {
    constexpr uint8_t kFrames = 4;
    const auto all = lensStream(kFrames);
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return folder.path() / name; };
    writeDatabase(path("a.db3"), all);
    writeDatabase(path("packed.db3"), packedOneByOne(all));
    writeChunks(path("chunks.mcap"), all);
    writeChunks(path("packed_chunks.mcap"), packedOneByOne(all));
    folder.write("unchunked.mcap", unchunked(all));
    folder.write("packed.mcap", unchunked(packedOneByOne(all)));
    for (const char* name :
         {"a.db3", "packed.db3", "chunks.mcap", "packed_chunks.mcap", "unchunked.mcap", "packed.mcap"}) {
        checkLensStream(path(name), kFrames);
    }
    std::filesystem::create_directory(path("split"));
    folder.write("split/metadata.yaml", "rosbag2_bagfile_information: {}\n");
    writeDatabase(path("split/a_0.db3"), all);
    checkLensStream(path("split"), kFrames);
}

TEST_CASE("The bytes of a message stay valid while others are read from its file") {
    const auto all = lensStream(10);
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return folder.path() / name; };
    writeDatabase(path("a.db3"), all);
    writeChunks(path("chunks.mcap"), all);
    folder.write("unchunked.mcap", unchunked(all));
    for (const char* name : {"a.db3", "chunks.mcap", "unchunked.mcap"}) {
        CAPTURE(name);
        const auto file = openMessageFile(path(name));
        const MessageEntry first = file->topics()[0].messages[0];
        const MessageBytes held = file->bytes(first);
        const std::vector<uint8_t> before(held.view.begin(), held.view.end());
        for (const MessageTopic& topic : file->topics()) {
            for (const MessageEntry& entry : topic.messages) {
                CHECK(file->bytes(entry).view.size() > 100);
            }
        }
        CHECK(std::equal(before.begin(), before.end(), held.view.begin(), held.view.end()));
    }
}

TEST_CASE("Depth that is aligned to colour has colour's lens where none of its own was recorded") {
    const TemporaryFolder folder;
    for (const bool oneFrame : {true, false}) {
        BagMaker maker;
        addStream(maker, "/camera/color/image_raw", redImage("color"), {.frame = "color", .k = {6, 6, 3, 2}});
        for (const double t : {1.0, 1.1, 1.2}) {
            maker.add("/camera/aligned_depth_to_color/image_raw", "sensor_msgs/Image", t,
                      imageMessage(t, depthImage(500, oneFrame ? "color" : "depth")));
        }
        if (!oneFrame) {
            mentions(streamRefusal(folder, maker), "info=/camera/color/camera_info");
            continue;
        }
        const BagCamera camera = playStreams(folder, maker);
        CHECK(camera.info().registered);
        CHECK(camera.info().depth.fx == 6.0);
        CHECK(camera.info().colour.cy == 2.0);
        mentions(camera.streams(), "lens of /camera/color/image_raw");
    }
}
