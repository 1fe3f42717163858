// SPDX-License-Identifier: Apache-2.0
#include "engine/types/cache_file.h"

#include "engine/types/error.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <iterator>
#include <string>

using namespace fathom;

TEST_CASE("A cache file is stored in a new folder, replaced whole, and no temporary file remains") {
    const testing::ScratchFolder scratch;
    const auto folder = scratch / "new" / "covers";
    for (const std::string& bytes : {std::string("one\0two", 7), std::string(200'000, 'x'), std::string()}) {
        storeCacheFile(folder / "file", bytes);
        CHECK(testing::textOf(folder / "file") == bytes);
        CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
    }
}

TEST_CASE("A cache file that cannot be stored leaves the old one unchanged and no temporary file") {
    const testing::ScratchFolder scratch;
    const auto file = scratch / "file";
    storeCacheFile(file, "old");
    std::string refusal;
    {
        const FileSizeLimit full(5000);
        refusal = testing::refusalOf<Error>([&] { storeCacheFile(file, std::string(100'000, 'x')); });
    }
    CHECK(refusal == file.string() + ": cannot be written whole");
    CHECK(scratch.read("file") == "old");
    std::filesystem::create_directories(scratch / "folder" / "not empty");
    CHECK_THROWS_AS(storeCacheFile(scratch / "folder", "x"), Error);
    CHECK_THROWS_AS(storeCacheFile(file / "below a file", "x"), Error);
    CHECK(scratch.files() == 2);
}

TEST_CASE("The hash of cache files is FNV-1a of 64 bits, also in parts") {
    CHECK(fnv1a("") == 0xcbf29ce484222325u); // test vectors of the authors
    CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cu);
    CHECK(fnv1a("foobar") == 0x85944171f73967e8u);
    CHECK(fnv1a("bar", fnv1a("foo")) == fnv1a("foobar"));
    CHECK(fnv1a("\xff") != fnv1a("\x7f")); // bytes above 127 are not negative
    CHECK(fnv1a("\xff") == 0xaf64724c8602eb6eu);
    CHECK(fnv1a("foobar", 1) != fnv1a("foobar"));
}
