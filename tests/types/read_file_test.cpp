// SPDX-License-Identifier: Apache-2.0
#include "engine/types/cache_folder.h"
#include "engine/types/read_file.h"

#include "engine/types/inside.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <sys/stat.h>

using namespace fathom;

TEST_CASE("A file is read to its end or to one byte beyond the limit") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "file";
    for (size_t size : {size_t{0}, size_t{1}, size_t{99}, size_t{100}, size_t{101}, size_t{200'000}}) {
        std::string content(size, 'a');
        for (size_t i = 0; i < size; ++i) {
            content[i] = static_cast<char>(i % 251);
        }
        std::ofstream(file, std::ios::binary) << content;
        CHECK(readFileAtMost(file, 100) == content.substr(0, 101));
        CHECK(readFileAtMost(file, 1'000'000) == content);
    }
    std::filesystem::remove(file);
    CHECK_FALSE(readFileAtMost(file, 100));
    CHECK_FALSE(readFileAtMost(scratch.path(), 100));
}

TEST_CASE("A file larger than its reader's limit is rejected with both sizes") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "file";
    const auto refusal = [](const std::filesystem::path& path) -> std::string {
        return testing::refusalOf([&] { readWholeFile(path, 2u << 20, "a readable text"); });
    };
    std::ofstream(file, std::ios::binary) << std::string(2u << 20, 'x');
    CHECK(refusal(file) == "");
    CHECK(readWholeFile(file, 2u << 20, "") == std::string(2u << 20, 'x'));
    std::ofstream(file, std::ios::binary | std::ios::app) << 'x';
    CHECK(refusal(file) ==
          file.string() + ": file: 2097153 bytes (allowed: a readable text of at most 2 MiB)");
    std::filesystem::remove(file);
    CHECK(refusal(file) == file.string() + ": file: no such file (allowed: a readable text)");
    CHECK(refusal("/dev/zero") == "/dev/zero: file: a pipe or device (allowed: a readable text)");
}

TEST_CASE("A pipe, a device or a folder is not readable as a file, and a link counts as its target") {
    const testing::ScratchFolder scratch;
    const auto& folder = scratch.path();
    std::ofstream(folder / "file") << "x";
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    std::filesystem::create_symlink("file", folder / "to-file");
    std::filesystem::create_symlink("pipe", folder / "to-pipe");
    CHECK(readFileAtMost(folder / "to-file", 10) == "x");
    for (const std::filesystem::path& path :
         {folder / "pipe", folder / "to-pipe", std::filesystem::path("/dev/zero")}) {
        CAPTURE(path);
        CHECK_FALSE(isRegularFile(path));
        CHECK_FALSE(readFileAtMost(path, 10)); // does not wait for a writer
        CHECK(whyUnreadable(path) == "a pipe or device");
    }
    CHECK_FALSE(isRegularFile(folder));
    CHECK(whyUnreadable(folder) == "a folder");
    CHECK_FALSE(isRegularFile(folder / "none"));
    CHECK(whyUnreadable(folder / "none") == "no such file");
}

TEST_CASE("A file is inside a folder when the links on its path stay there, whatever its name") {
    const testing::ScratchFolder scratch;
    const auto& above = scratch.path();
    std::filesystem::create_directories(above / "rec/rgb");
    std::ofstream(above / "secret") << "x";
    std::ofstream(above / "rec/rgb/0.png") << "x";
    std::filesystem::create_symlink("../../secret", above / "rec/rgb/out.png");
    std::filesystem::create_symlink("0.png", above / "rec/rgb/in.png");
    std::filesystem::create_symlink("..", above / "rec/up");
    std::filesystem::create_symlink("loop", above / "rec/loop");
    std::filesystem::create_symlink("rec", above / "again");
    for (const auto& folder : {above / "rec", above / "again", above / "rec/"}) {
        CAPTURE(folder);
        for (const char* inside :
             {"rgb/0.png", "rgb/in.png", "rgb/../rgb/0.png", "none", "loop", "up/rec/rgb"}) {
            CAPTURE(inside);
            CHECK(liesInside(folder / inside, folder));
        }
        for (const char* outside : {"rgb/out.png", "up/secret", "up", "up/none"}) {
            CAPTURE(outside);
            CHECK_FALSE(liesInside(folder / outside, folder));
        }
    }
    CHECK(liesInside("tests", ""));
}

TEST_CASE("A path stays inside when it is relative and never leads above its start") {
    for (const char* inside : {"", "a", "./a", "a/../b", "a/b/../../c", "...", "..a", "rgb/0.png"}) {
        CAPTURE(inside);
        CHECK(staysInside(inside));
    }
    for (const char* outside : {"..", "../a", "/", "/a", "a/../..", "a/../../b", "./../a", "//x"}) {
        CAPTURE(outside);
        CHECK_FALSE(staysInside(outside));
    }
}

TEST_CASE("The folder for caches is absolute, or there is none") {
    const auto folderWith = [](const char* cache, const char* home) {
        for (const auto& [name, value] : {std::pair("XDG_CACHE_HOME", cache), std::pair("HOME", home)}) {
            value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
        }
        return cacheFolder().string();
    };
    const std::string home = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
    CHECK(folderWith("/c", "/h") == "/c/fathom");
    CHECK(folderWith("", "/h") == "/h/.cache/fathom");
    CHECK(folderWith("c", "/h") == "/h/.cache/fathom");
    CHECK(folderWith(nullptr, "/h") == "/h/.cache/fathom");
    CHECK(folderWith(nullptr, "") == "");
    CHECK(folderWith(nullptr, nullptr) == "");
    ::setenv("HOME", home.c_str(), 1);
}
