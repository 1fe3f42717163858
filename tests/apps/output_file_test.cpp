// SPDX-License-Identifier: Apache-2.0
#include "engine/types/output_file.h"

#include "apps/output/fixtures_ply.h"
#include "apps/output/haptics_csv.h"
#include "apps/output/output_folder.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"
#include "tests/rig/file_size_limit.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

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
        return refusalOf<Error>(action).find(name) != std::string::npos;
    };
    CHECK(named("gone/a.csv", [&] { OutputFile(folder.path() / "gone" / "a.csv"); }));
    std::filesystem::create_directories(folder.path() / "taken" / "inside");
    CHECK(named("taken", [&] {
        OutputFile file(folder.path() / "taken");
        file.commit();
    }));
    const FileSizeLimit small(3);
    CHECK(named("full.csv", [&] {
        OutputFile file(folder.path() / "full.csv");
        file.write("text");
        file.commit();
    }));
}

TEST_CASE("A temporary name that is a link is not followed, and the link's target stays as it was") {
    const ScratchFolder folder;
    put(folder.path() / "victim", "mine");
    std::filesystem::create_symlink(folder.path() / "victim", folder.path() / "a.csv.partial");
    OutputFile file(folder.path() / "a.csv");
    file.write("new");
    file.commit();
    CHECK(textOf(folder.path() / "victim") == "mine");
    CHECK(textOf(folder.path() / "a.csv") == "new");
    CHECK_FALSE(std::filesystem::is_symlink(folder.path() / "a.csv"));
}

TEST_CASE("Of two writers of one file, the first one fails and the second one's file is whole") {
    const ScratchFolder folder;
    OutputFile first(folder.path() / "a.csv");
    first.write("first");
    OutputFile second(folder.path() / "a.csv");
    second.write("second");
    CHECK_THROWS_AS(first.commit(), Error);
    second.commit();
    CHECK(textOf(folder.path() / "a.csv") == "second");
}

TEST_CASE("Files that belong together are replaced all or not at all") {
    const ScratchFolder folder;
    const auto write = [&](const std::string& text) {
        OutputFile first(folder.path() / "a.csv"), last(folder.path() / "b.json");
        first.write("new");
        last.write(text);
        OutputFile* const files[] = {&first, &last};
        commitTogether(files);
    };
    const auto texts = [&] {
        return textOf(folder.path() / "a.csv") + " " + textOf(folder.path() / "b.json");
    };
    put(folder.path() / "a.csv", "old");
    put(folder.path() / "b.json", "old");
    {
        const FileSizeLimit small(3);
        CHECK_THROWS_AS(write("more"), Error);
    }
    CHECK(texts() == "old old");
    CHECK(folder.files() == 2);
    write("more");
    CHECK(texts() == "new more");
    CHECK(folder.files() == 2);
}

TEST_CASE(
    "Files that belong together are not replaced if the old version of the last one cannot be removed") {
    const ScratchFolder folder;
    put(folder.path() / "a.csv", "old");
    {
        OutputFile first(folder.path() / "a.csv"), last(folder.path() / "b.json");
        first.write("new");
        std::filesystem::create_directory(folder / "b.json"); // which unlink() refuses
        OutputFile* const files[] = {&first, &last};
        CHECK_THROWS_WITH_AS(commitTogether(files), doctest::Contains("b.json: cannot replace"), Error);
    }
    CHECK(textOf(folder.path() / "a.csv") == "old");
    CHECK(folder.files() == 2);
}

TEST_CASE("A file that was read is not replaced, under its own name or by a link") {
    const ScratchFolder folder;
    put(folder.path() / "in.txt", "input");
    REQUIRE(readFileAtMost(folder.path() / "in.txt", 100));
    std::filesystem::create_symlink(folder.path() / "in.txt", folder.path() / "link");
    std::filesystem::create_hard_link(folder.path() / "in.txt", folder.path() / "same");
    for (const char* name : {"in.txt", "link", "same"}) {
        CAPTURE(name);
        CHECK_THROWS_AS(OutputFile(folder.path() / name), BadInput);
    }
    put(folder.path() / "other", "input");
    CHECK_NOTHROW(OutputFile(folder.path() / "other").commit());
    CHECK(textOf(folder.path() / "in.txt") == "input");
}

TEST_CASE("An output folder is locked by one process; the lock of a dead one and a file left behind do not "
          "count") {
    const ScratchFolder folder;
    const auto refused = [&] { return refusalOf([&] { prepareReplayFolder(folder.path(), false); }); };
    {
        const OutputLock lock = prepareReplayFolder(folder.path(), false);
        CHECK(refused().find("in use by process " + std::to_string(::getpid())) != std::string::npos);
    }
    CHECK(folder.files() == 0); // the lock file is gone
    put(folder.path() / ".fathom.lock", "1");
    CHECK(refused().empty());
    const pid_t child = ::fork();
    if (child == 0) {
        const OutputLock lock = prepareReplayFolder(folder.path(), false);
        ::_exit(0); // without a destructor, as if killed
    }
    ::waitpid(child, nullptr, 0);
    CHECK(std::filesystem::exists(folder.path() / ".fathom.lock"));
    CHECK(refused().empty());
    put(folder.path() / "victim", "mine");
    std::filesystem::create_symlink(folder.path() / "victim", folder.path() / ".fathom.lock");
    CHECK_THROWS_AS(prepareReplayFolder(folder.path(), false), Error);
    CHECK(textOf(folder.path() / "victim") == "mine");
}

TEST_CASE("Fixture files of an earlier run are not deleted through a link") {
    const ScratchFolder folder, other;
    put(other.path() / "000001.ply", "mine");
    std::filesystem::create_directory_symlink(other.path(), folder.path() / "fixtures");
    CHECK_THROWS_AS(prepareReplayFolder(folder.path(), true), Error);
    CHECK_THROWS_AS(prepareReplayFolder(folder.path(), false), Error);
    CHECK(textOf(other.path() / "000001.ply") == "mine");
}

TEST_CASE("An output folder is made with its parents and loses the frame and fault files of an earlier run, "
          "nothing else") {
    const ScratchFolder folder;
    const auto out = folder.path() / "x" / "y";
    prepareReplayFolder(out, true);
    const std::string faults = std::string(HapticsCsv::kHeader) + "\n";
    writeFixturesPly(out / "fixtures" / "000007.ply", {});
    writeFixturesPly(out / "fixtures" / "1234567.ply", {});
    writeFixturesPly(out / "fixtures" / "mine.ply", {});
    put(out / "fixtures" / "notes.txt", "mine");
    put(out / "fault-12.345.csv", faults);
    put(out / "fault-notes.csv", faults);
    put(out / "fault-.csv", faults);
    put(out / "summary.json", "old");
    prepareReplayFolder(out, false);
    CHECK(!std::filesystem::exists(out / "fixtures" / "000007.ply"));
    CHECK(!std::filesystem::exists(out / "fixtures" / "1234567.ply"));
    CHECK(std::filesystem::exists(out / "fixtures" / "mine.ply"));
    CHECK(textOf(out / "fixtures" / "notes.txt") == "mine");
    CHECK(!std::filesystem::exists(out / "fault-12.345.csv"));
    CHECK(textOf(out / "fault-notes.csv") == faults);
    CHECK(textOf(out / "fault-.csv") == faults);
    CHECK(textOf(out / "summary.json") == "old");
    put(folder.path() / "file", "");
    CHECK_THROWS_AS(prepareReplayFolder(folder.path() / "file", false), Error);
}

TEST_CASE("Files of other programs in an output folder are kept, also under names that a replay gives") {
    const ScratchFolder out;
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
    out.write("fixtures/000000.ply", ply);
    out.write("fixtures/000001.ply", "");
    out.write("fault-1.csv", "fault,date\n");
    std::filesystem::create_directory(out / "fault-2.csv");
    prepareReplayFolder(out.path(), true);
    CHECK(out.read("fixtures/000000.ply") == ply);
    CHECK(std::filesystem::exists(out / "fixtures/000001.ply"));
    CHECK(out.read("fault-1.csv") == "fault,date\n");
    CHECK(std::filesystem::is_directory(out / "fault-2.csv"));
}
