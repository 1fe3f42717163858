// SPDX-License-Identifier: Apache-2.0
#include "engine/types/replaceable.h"

#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

TEST_CASE("A file may replace a file or a free name, but not a folder, a device or a system name") {
    const testing::ScratchFolder folder;
    const std::filesystem::path file = folder.path() / "file", link = folder.path() / "link";
    std::ofstream(file) << "old";
    std::filesystem::create_symlink(file, link);
    CHECK(isReplaceable(file));
    CHECK(isReplaceable(link));
    CHECK(isReplaceable(folder.path() / "new"));
    CHECK(isReplaceable("new"));
    CHECK(!isReplaceable(folder.path()));
    for (const char* name : {"/dev/full", "/dev/stdout", "/dev/no_such_device", "/proc/self/fd/1"}) {
        CHECK_MESSAGE(!isReplaceable(name), name);
    }
    std::filesystem::create_directory_symlink("/dev", folder.path() / "dev");
    CHECK(!isReplaceable(folder.path() / "dev/stdout"));
    CHECK(isReplaceable("/dev/shm/fathom-test-trace.json")); // an ordinary folder of files
}
