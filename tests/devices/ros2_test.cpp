// SPDX-License-Identifier: Apache-2.0
// Recordings of ROS 2. The files were written by the npm packages @mcap/core and
// @foxglove/rosmsg2-serialization, by zstd and lz4js, and by SQLite: three pairs of 8 x 6 images, 0.5, 0.6
// and 0.7 m, red with green 0, 1 and 2.
#include "devices/bag/bag_camera.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <spdlog/spdlog.h>

using namespace fathom;

namespace {

const std::filesystem::path kFiles = "tests/fuzz/corpus";

uint32_t rosPairs(const std::filesystem::path& file) {
    BagCamera camera(file);
    CHECK(camera.info().registered);
    CHECK(camera.info().depth.fx == 7.0);
    uint32_t used = 0;
    while (const auto frame = camera.next()) {
        CHECK((*frame)->depth[47] == 500 + 100 * used);
        CHECK(coloursOf(**frame)[47] == (0xff0000c8u | used << 8));
        CHECK((*frame)->captureTime == doctest::Approx(1.0 + 0.1 * used));
        ++used;
    }
    return used;
}

std::string rosBytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string rosRefusal(const std::filesystem::path& file) {
    return testing::refusalOf([&] { BagCamera camera(file); });
}

} // namespace

TEST_CASE("MCAP with every compression, with and without chunks and indexes, gives the same frames") {
    for (const char* name : {"none", "lz4", "zstd", "unchunked", "unindexed"}) {
        CHECK_MESSAGE(rosPairs(kFiles / "mcap" / name) == 3, name);
    }
}

TEST_CASE("An MCAP file that was not finished is played to its last whole chunk") {
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    CHECK(rosPairs(kFiles / "mcap" / "unfinished") >= 1);
    spdlog::set_level(level);
}

TEST_CASE("A ROS 2 database gives its frames, and its views are not evaluated") {
    CHECK(rosPairs(kFiles / "database" / "small") == 3);
    CHECK(rosRefusal(kFiles / "database" / "view").find("topics and messages") != std::string::npos);
}

TEST_CASE("A folder of ROS 2 files is played as one recording, in the order of their numbers") {
    const TemporaryFolder folder;
    folder.write("metadata.yaml", "rosbag2_bagfile_information: {}\n");
    folder.write("rec_0.mcap", rosBytes(kFiles / "mcap" / "zstd"));
    folder.write("._rec_0.mcap", "x"); // of an archive of macOS
    CHECK(rosPairs(folder.path()) == 3);
    folder.write("rec_0.mcap.zstd", "x");
    CHECK(rosRefusal(folder.path()).find("compression") != std::string::npos);
}

namespace {

// metadata.yaml that lists these files.
void listFiles(const TemporaryFolder& folder, const std::string& names) {
    folder.write("metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths: [" +
                                      names + "]\n  files: []\n");
}

size_t depthMessages(const std::filesystem::path& folder) {
    return openMessageFile(folder)->find("/camera/depth_registered/image_raw")->messages.size();
}

} // namespace

TEST_CASE("Only the files that metadata.yaml lists are played, wherever it says that their folder is") {
    const TemporaryFolder folder;
    const std::string recording = rosBytes(kFiles / "mcap" / "zstd");
    folder.write("rec_0.mcap", recording);
    folder.write("rec_0 (copy).mcap", recording);
    folder.write("rec_0.db3", rosBytes(kFiles / "database" / "small"));
    folder.write("rec_0.mcap.zstd", "x");
    for (const char* names :
         {"rec_0.mcap", "old_name/rec_0.mcap", "../rec_0.mcap, rec_0.mcap", "rec_0.mcap.zstd"}) {
        listFiles(folder, names);
        CHECK_MESSAGE(rosPairs(folder.path()) == 3, names);
        CHECK(openMessageFile(folder.path())->warnings().empty());
    }
    listFiles(folder, "other_0.mcap, rec_0.db3");
    CHECK(rosPairs(folder.path()) == 3);
    folder.write("other_0.mcap.zstd", "x");
    CHECK(rosRefusal(folder.path()).find("other_0.mcap.zstd: compression") != std::string::npos);
}

TEST_CASE("A listed file that is missing or damaged is named, and the others are played") {
    const TemporaryFolder folder;
    folder.write("rec_0.mcap", rosBytes(kFiles / "mcap" / "zstd"));
    folder.write("rec_1.DB3", rosBytes(kFiles / "database" / "small"));
    folder.write("empty_2.db3", "");
    listFiles(folder, "rec_0.mcap, rec_1.DB3, gone_2.mcap");
    CHECK(depthMessages(folder.path()) == 6);
    CHECK(BagCamera(folder.path()).warnings().at(0) == "metadata.yaml lists gone_2.mcap, which is missing");
    listFiles(folder, "empty_2.db3, rec_0.mcap");
    CHECK(rosPairs(folder.path()) == 3);
    const std::string damaged = openMessageFile(folder.path())->warnings().at(0);
    CHECK(damaged.find("a part is not played: ") == 0);
    CHECK(damaged.find("empty_2.db3: tables") != std::string::npos);
    listFiles(folder, "empty_2.db3");
    CHECK(rosRefusal(folder.path()).find("empty_2.db3: tables") != std::string::npos);
}

TEST_CASE("Without a list of files that are there, a folder's files are played if they are of one kind") {
    const TemporaryFolder folder;
    folder.write("renamed_0.MCAP", rosBytes(kFiles / "mcap" / "zstd"));
    for (const char* metadata : {"rosbag2_bagfile_information: {relative_file_paths: [rec_0.mcap]}\n",
                                 "rosbag2_bagfile_information: {relative_file_paths: [", "- 1\n", ""}) {
        folder.write("metadata.yaml", metadata);
        CHECK_MESSAGE(rosPairs(folder.path()) == 3, metadata);
    }
    folder.write("renamed_0.db3", rosBytes(kFiles / "database" / "small"));
    CHECK(rosRefusal(folder.path()).find("files of one kind") != std::string::npos);
}

TEST_CASE("A damaged MCAP chunk loses its own images only, and no byte crashes the reader") {
    const TemporaryFolder folder;
    const auto level = spdlog::get_level();
    spdlog::set_level(spdlog::level::off);
    for (const char* name : {"mcap/zstd", "mcap/unchunked", "database/small"}) {
        const std::string whole = rosBytes(kFiles / name);
        for (size_t at = 8; at < whole.size(); at += 23) {
            std::string changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ 0x5a);
            folder.write("x", changed);
            try {
                BagCamera camera(folder.path() / "x");
                while (camera.next()) {
                }
            } catch (const Error&) {
            }
            folder.write("x", whole.substr(0, at));
            CHECK_FALSE((rosRefusal(folder.path() / "x").empty() && at < 100));
        }
    }
    spdlog::set_level(level);
}
