// SPDX-License-Identifier: Apache-2.0
// How much of a long MCAP file is read to open it and to play a part.
#include "devices/bag/mcap_file.h"
#include "devices/bag/mcap_records.h"
#include "devices/bag/mcap_writer.h"
#include "engine/types/error.h"
#include "tests/devices/bag_maker.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>
#include <random>
#include <spdlog/spdlog.h>

using namespace fathom;

namespace {

constexpr size_t kSeekMessages = 600, kSeekBytes = 4000;
constexpr uint64_t kSeekPeriod = 33'000'000; // [ns]

// Messages of random bytes, which no compression shrinks, four or five per chunk.
void writeSeekable(const std::filesystem::path& file) {
    McapWriter writer(file, 16'000);
    const uint16_t channel = writer.addChannel("/depth/image_raw", "sensor_msgs/msg/Image", "uint8[] data");
    std::mt19937 random(1);
    for (size_t i = 0; i < kSeekMessages; ++i) {
        std::vector<uint8_t> message(kSeekBytes);
        for (uint8_t& byte : message) {
            byte = static_cast<uint8_t>(random());
        }
        std::memcpy(message.data(), &i, sizeof i);
        writer.add(channel, i * kSeekPeriod, message);
    }
    writer.finish();
}

void checkLate(McapFile& file, double mostOfFile, uint64_t size) {
    const uint64_t opened = file.bytesRead();
    CHECK(static_cast<double>(opened) < mostOfFile * static_cast<double>(size));
    const MessageTopic* topic = file.find("/depth/image_raw");
    REQUIRE(topic != nullptr);
    for (size_t i = topic->messages.size() - 30; i < topic->messages.size() - 10; ++i) {
        size_t number = 0;
        std::memcpy(&number, file.bytes(topic->messages[i]).view.data(), sizeof number);
        CHECK(number == i);
    }
    // Twenty messages are in at most seven chunks, each read once.
    CHECK(file.bytesRead() - opened < 7 * 22'000);
}

std::string mcapRecord(uint8_t kind, const std::string& content) {
    return testing::Out().put(kind).put(uint64_t{content.size()}).bytes + content;
}

// A chunk that describes its channel and holds one message, with its index. sum: 0 = not checked.
std::string describedChunk(uint64_t time, uint32_t sum) {
    using testing::Out;
    const std::string inside =
        mcapRecord(mcap::kSchema,
                   Out().put(uint16_t{1}).text("sensor_msgs/msg/Image").text("").text("").bytes) +
        mcapRecord(mcap::kChannel,
                   Out().put(uint16_t{5}).put(uint16_t{1}).text("/depth").text("cdr").text("").bytes);
    const Out message = Out().put(uint16_t{5}).put(uint32_t{0}).put(time).put(time).put(uint64_t{77});
    const std::string records = inside + mcapRecord(mcap::kMessage, message.bytes);
    const Out chunk = Out()
                          .put(time)
                          .put(time)
                          .put(uint64_t{records.size()})
                          .put(sum)
                          .text("")
                          .put(uint64_t{records.size()});
    const Out index = Out().put(uint16_t{5}).put(uint32_t{16}).put(time).put(uint64_t{inside.size()});
    return mcapRecord(mcap::kChunk, chunk.bytes + records) + mcapRecord(mcap::kMessageIndex, index.bytes);
}

} // namespace

TEST_CASE("A damaged first chunk of an MCAP file without a summary does not lose the others") {
    const TemporaryFolder folder;
    const std::string magic(mcap::kMagic.begin(), mcap::kMagic.end());
    const std::string end = mcapRecord(mcap::kFooter, std::string(20, '\0')) + magic; // no summary
    folder.write("x.mcap",
                 magic + describedChunk(10, 1) + describedChunk(20, 0) + describedChunk(30, 0) + end);
    McapFile file(folder.path() / "x.mcap");
    REQUIRE(file.topics().size() == 1);
    const MessageTopic& topic = file.topics()[0];
    CHECK(topic.type == "sensor_msgs/Image");
    REQUIRE(topic.messages.size() == 3);
    CHECK(file.bytes(topic.messages[1]).view.size() == 8);
    CHECK_THROWS_WITH_AS(file.bytes(topic.messages[0]), "a chunk whose checksum is wrong", Error);
}

TEST_CASE("A long MCAP file is opened from its summary, and only the chunks that are played are read") {
    const TemporaryFolder folder;
    const auto path = folder.path() / "long.mcap";
    writeSeekable(path);
    const uint64_t size = std::filesystem::file_size(path);
    McapFile file(path);
    CHECK(file.topics()[0].messages.size() == kSeekMessages);
    checkLate(file, 0.02, size);
}

TEST_CASE("A long MCAP file without a summary, or with a wrong one, is read by the heads of its records") {
    const TemporaryFolder folder;
    writeSeekable(folder.path() / "long.mcap");
    const std::string whole = folder.read("long.mcap");
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    std::string bad = whole; // the summary counts a message less
    const std::string count(reinterpret_cast<const char*>(&kSeekMessages), sizeof kSeekMessages);
    bad[bad.rfind(count)] = static_cast<char>(bad[bad.rfind(count)] - 1);
    std::string early = whole; // the footer points to the end of the first chunk
    uint64_t place = 30'000;
    std::memcpy(early.data() + early.size() - 28, &place, sizeof place);
    for (const std::string& text : {whole.substr(0, whole.size() - 40), bad, early}) {
        folder.write("x.mcap", text);
        McapFile file(folder.path() / "x.mcap");
        CHECK(file.topics()[0].messages.size() + 5 >= kSeekMessages);
        checkLate(file, text == early ? 1.1 : 0.05, text.size());
    }
    spdlog::set_level(level);
}

TEST_CASE("Chunks of a summary that overlap, repeat or point behind themselves are not taken from it") {
    const TemporaryFolder folder;
    writeSeekable(folder.path() / "long.mcap");
    const std::string whole = folder.read("long.mcap");
    uint64_t summary = 0;
    std::memcpy(&summary, whole.data() + whole.size() - 28, sizeof summary);
    const size_t first = whole.find(std::string("\x08", 1) + std::string("\x4e\0\0\0\0\0\0\0", 8), summary);
    REQUIRE(first != std::string::npos); // a chunk index of 78 bytes
    for (const uint64_t place : {uint64_t{0}, summary, UINT64_MAX, summary + 100}) {
        std::string changed = whole;
        std::memcpy(changed.data() + first + 9 + 16, &place, sizeof place); // the chunk's place
        folder.write("x.mcap", changed);
        McapFile file(folder.path() / "x.mcap");
        CHECK(file.topics()[0].messages.size() == kSeekMessages);
        CHECK(file.bytes(file.topics()[0].messages[3]).view.size() == kSeekBytes);
    }
}
