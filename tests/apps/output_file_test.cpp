// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/output_file.h"

#include "engine/types/error.h"
#include "tests/apps/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A file appears under its name only when committed, and replaces the old file as a whole") {
    const ScratchFolder folder;
    const auto path = folder.path() / "a.csv";
    put(path, "before");
    {
        OutputFile file(path);
        file.write("after");
        CHECK(textOf(path) == "before");
        file.commit();
    }
    CHECK(textOf(path) == "after");
    CHECK(folder.files() == 1);
}

TEST_CASE("A file without commit leaves the old one unchanged and no temporary file") {
    const ScratchFolder folder;
    const auto path = folder.path() / "a.csv";
    put(path, "before");
    { OutputFile(path).write("half"); }
    CHECK(textOf(path) == "before");
    CHECK(folder.files() == 1);
}

TEST_CASE("Writes of any size keep their order: none, one byte, beyond the buffer, and after a move") {
    const ScratchFolder folder;
    std::string expected;
    OutputFile first(folder.path() / "a.bin");
    OutputFile file(std::move(first));
    for (const size_t size :
         {size_t{0}, size_t{1}, size_t{1048575}, size_t{3}, size_t{2097157}, size_t{11}}) {
        const std::string chunk(size, static_cast<char>('a' + size % 23));
        file.write(chunk);
        expected += chunk;
    }
    file.commit();
    CHECK((textOf(folder.path() / "a.bin") == expected));
    OutputFile(folder.path() / "empty").commit();
    CHECK(textOf(folder.path() / "empty").empty());
}

TEST_CASE("A missing folder, a folder in the file's place and a full disk are errors that name the file") {
    const ScratchFolder folder;
    const auto named = [](const std::string& name, auto&& action) {
        try {
            action();
        } catch (const Error& error) {
            return std::string(error.what()).find(name) != std::string::npos;
        }
        return false;
    };
    CHECK(named("gone/a.csv", [&] { OutputFile(folder.path() / "gone" / "a.csv"); }));
    std::filesystem::create_directories(folder.path() / "taken" / "inside");
    CHECK(named("taken", [&] {
        OutputFile file(folder.path() / "taken");
        file.commit();
    }));
    if (std::filesystem::exists("/dev/full")) {
        // The temporary name is a link to a device that is always full.
        std::filesystem::create_symlink("/dev/full", folder.path() / "full.csv.partial");
        CHECK(named("full.csv", [&] {
            OutputFile file(folder.path() / "full.csv");
            file.write("text");
            file.commit();
        }));
    } else {
        MESSAGE("no device that is always full here: that error is not tried");
    }
}

TEST_CASE("An output folder is made with its parents and loses the frame and fault files of an earlier run, "
          "nothing else") {
    const ScratchFolder folder;
    const auto out = folder.path() / "x" / "y";
    prepareOutputFolder(out, true);
    put(out / "fixtures" / "000007.ply", "old");
    put(out / "fixtures" / "1234567.ply", "old");
    put(out / "fixtures" / "notes.txt", "mine");
    put(out / "fault-12.345.csv", "old");
    put(out / "fault-notes.csv", "mine");
    put(out / "fault-.csv", "mine");
    put(out / "summary.json", "old");
    prepareOutputFolder(out, false);
    CHECK(!std::filesystem::exists(out / "fixtures" / "000007.ply"));
    CHECK(!std::filesystem::exists(out / "fixtures" / "1234567.ply"));
    CHECK(textOf(out / "fixtures" / "notes.txt") == "mine");
    CHECK(!std::filesystem::exists(out / "fault-12.345.csv"));
    CHECK(textOf(out / "fault-notes.csv") == "mine");
    CHECK(textOf(out / "fault-.csv") == "mine");
    CHECK(textOf(out / "summary.json") == "old");
    put(folder.path() / "file", "");
    CHECK_THROWS_AS(prepareOutputFolder(folder.path() / "file", false), Error);
}
