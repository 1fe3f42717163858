// SPDX-License-Identifier: Apache-2.0
// Bags whose recorder was stopped before it wrote the index.
#include "devices/bag/bag_file.h"
#include "tests/devices/played_bag.h"
#include "tests/realtime/listening.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;
using testing::Listening;

namespace {

BagMaker threeDepths(uint16_t value, double from) {
    BagMaker maker;
    addStream(maker, "/c/depth", depthImage(value), {}, {from, from + 0.1, from + 0.2});
    return maker;
}

// The depths that are played, with the note of the file.
std::vector<uint16_t> depthsOf(const TemporaryFolder& folder, const std::string& bag,
                               const std::string& note) {
    folder.write("a.bag", bag);
    const Listening log;
    BagCamera camera(folder.path() / "a.bag");
    CHECK(log.count(note) == 1);
    CHECK(log.count("rosbag reindex") == 1);
    REQUIRE(camera.warnings().size() == 1);
    mentions(camera.warnings()[0], note);
    std::vector<uint16_t> depths; // [mm]
    while (const auto frame = camera.next()) {
        depths.push_back((*frame)->depth[0]);
    }
    CHECK(camera.skipped() == 0);
    return depths;
}

} // namespace

TEST_CASE("A bag without an index is read chunk by chunk, with one note") {
    const TemporaryFolder folder;
    const std::vector<uint16_t> first(3, 500), both{500, 500, 500, 700, 700, 700};
    for (const char* compression : {"none", "bz2", "lz4"}) {
        CAPTURE(compression);
        const std::string chunks = threeDepths(500, 1.0).chunks(compression),
                          more = threeDepths(700, 1.3).chunks(compression, false);
        CHECK(depthsOf(folder, chunks + more, "no index: 2 chunks") == both);
        const std::vector<uint16_t> all{500, 500, 500, 700, 700};
        const bool plain = std::string(compression) == "none"; // the others need all of their bytes
        CHECK(depthsOf(folder, chunks + more.substr(0, more.size() - 5),
                       plain ? "no index: 2 chunks are searched"
                             : "no index: 1 chunk is searched for messages, 1 damaged chunk is skipped") ==
              (plain ? all : first));
        CHECK(depthsOf(folder, threeDepths(500, 1.0).bag(compression, false), "no index: 1 chunk") == first);
    }
}

TEST_CASE("The chunk that a recorder had begun is read to its last whole message") {
    const TemporaryFolder folder;
    const std::string begun = threeDepths(500, 1.0).chunks("none") + threeDepths(700, 1.3).begunChunk();
    CHECK(depthsOf(folder, begun, "no index: 2 chunks") ==
          std::vector<uint16_t>{500, 500, 500, 700, 700, 700});
    CHECK(depthsOf(folder, begun.substr(0, begun.size() - 20), "no index: 2 chunks") ==
          std::vector<uint16_t>{500, 500, 500, 700, 700});
    const std::string only = BagMaker().chunks("none").substr(0, BagMaker().headSize());
    CHECK(depthsOf(folder, only + threeDepths(700, 1.0).begunChunk(), "no index: 1 chunk").size() == 3);
}

TEST_CASE("A bag with a damaged index is read chunk by chunk, and each chunk once") {
    const TemporaryFolder folder;
    const std::string whole = threeDepths(500, 1.0).bag();
    CHECK(depthsOf(folder, whole.substr(0, whole.size() - 40), "damaged index (truncated): 1 chunk").size() ==
          3);
    const size_t last = whole.rfind(Out().text("op=\x06").bytes) - 4;
    CHECK(depthsOf(folder, whole + whole.substr(last), "names a chunk twice").size() == 3);
}

TEST_CASE("Chunks behind a damaged place of a bag without a good index are found and played") {
    const TemporaryFolder folder;
    const std::vector<uint16_t> both{500, 500, 500, 700, 700, 700};
    for (const char* compression : {"none", "bz2", "lz4"}) {
        CAPTURE(compression);
        const std::string first = threeDepths(500, 1.0).chunks(compression),
                          second = threeDepths(700, 1.3).chunks(compression, false);
        const std::string place =
            "a damaged place is skipped, at byte " + std::to_string(first.size()) + "; rosbag";
        for (const std::string& hole : {std::string(700, '\0'), std::string("\x9f\x12\xfe\x31garbage")}) {
            CHECK(depthsOf(folder, first + hole + second, place) == both);
        }
        std::string lost = first; // the size that the first chunk states
        const size_t stated = 4 + 8 + 16 + std::string(compression).size() + 13;
        lost.replace(threeDepths(500, 1.0).headSize() + stated, 4, raw(0x3ffffffu));
        const std::vector<uint16_t> only(3, 700);
        CHECK(depthsOf(folder, lost + second, "1 chunk is searched") == only);
        CHECK(depthsOf(folder, first + std::string(50, '\0'), "the last 50 bytes are not read").size() == 3);
    }
}

TEST_CASE("A bag with a damaged index and chunk keeps the topics that only its index names") {
    const TemporaryFolder folder;
    std::string bag = threeDepths(500, 1.0).bag();
    for (int topic = 0; topic < 2; ++topic) {
        bag[bag.find("op=\x07") + 3] = '\x09';
    }
    bag.replace(bag.find("conn=", bag.find("op=\x04")), 1, "x");
    CHECK(depthsOf(folder, bag, "damaged index (a header without 'conn'): 1 chunk is searched").size() == 3);
}

TEST_CASE("A bag without an index and without a message is rejected with the fault of its index") {
    const TemporaryFolder folder;
    folder.write("a.bag", BagMaker().chunks("none"));
    mentions(testing::refusalOf([&] { BagCamera(folder.path() / "a.bag"); }),
             "a.bag: index: no index: the bag was not closed, and no whole chunk holds a message (allowed: ");
}

TEST_CASE("An empty bag and one of an older version are refused as what they are") {
    const TemporaryFolder folder;
    const auto refusal = [&](const std::string& bytes) {
        folder.write("a.bag", bytes);
        return testing::refusalOf([&] { BagFile(folder.path() / "a.bag"); });
    };
    const std::string allowed = " (allowed: a ROS 1 bag of version 2.0)";
    mentions(refusal(""), "a.bag: format: empty" + allowed);
    mentions(refusal("#ROSBAG V1.2\nmore"),
             "a.bag: format: a bag of version 1.2, which rosbag fix of ROS 1 converts" + allowed);
    mentions(refusal("#ROSRECORD V1.1\n"), "a.bag: format: no bag" + allowed);
    mentions(refusal("x"), "a.bag: format: no bag" + allowed);
}
