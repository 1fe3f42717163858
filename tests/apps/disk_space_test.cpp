// SPDX-License-Identifier: Apache-2.0
// The free space for a recording, and how sizes and times are written.
#include "apps/operate/disk_space.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

TEST_CASE("A disk with less than 100 MB left is a problem that names what is left, an unknown one is not") {
    std::optional<uint64_t> left = 2'100'000'000;
    int measured = 0;
    DiskSpace disk([&](const std::filesystem::path&) {
        ++measured;
        return left;
    });
    CHECK(disk.problem().empty());
    disk.look("here", 1.0);
    CHECK(disk.left() == 2'100'000'000);
    CHECK(disk.problem().empty());
    left = 98'400'000;
    disk.look("here", 1.4); // too early for another look
    CHECK(disk.problem().empty());
    disk.look("here", 1.6);
    CHECK(disk.problem() == "only 98 MB of the disk left");
    CHECK(measured == 2);
    left.reset();
    disk.look("here", 9.0);
    CHECK(disk.problem().empty());
}

TEST_CASE("The free space of a folder that does not exist yet is that of its disk") {
    const ScratchFolder scratch;
    const auto there = freeSpace(scratch.path()), later = freeSpace(scratch.path() / "a" / "b");
    REQUIRE(there);
    REQUIRE(later);
    CHECK(*there > 0);
    CHECK(freeSpace("/proc/self/nothing").has_value());
}

TEST_CASE("Sizes and times are short") {
    CHECK(byteText(0) == "0.0 kB");
    CHECK(byteText(3'440'000) == "3.4 MB");
    CHECK(byteText(120'400'000'000) == "120 GB");
    CHECK(byteText(999'800'000) == "1.0 GB");
    CHECK(byteText(uint64_t{12'345} * 1'000'000'000'000) == "12345 TB");
    CHECK(clockText(7.9) == "0:07");
    CHECK(clockText(62.0) == "1:02");
    CHECK(clockText(3723.0) == "1:02:03");
    CHECK(clockText(-1.0) == "0:00");
}
