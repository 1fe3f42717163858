// SPDX-License-Identifier: Apache-2.0
#include "engine/types/read_file.h"

#include "engine/types/inside.h"

#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;

TEST_CASE("A file is read to its end or one byte past the bound, and one that never ends only so far") {
    const auto file = std::filesystem::temp_directory_path() / "fathom-read-file-test";
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
    CHECK(readFileAtMost("/dev/zero", 70'000)->size() == 70'001);
    CHECK_FALSE(readFileAtMost(file, 100));
    CHECK_FALSE(readFileAtMost(std::filesystem::temp_directory_path(), 100));
}

TEST_CASE("A path stays inside when it is relative and never goes above where it starts") {
    for (const char* inside : {"", "a", "./a", "a/../b", "a/b/../../c", "...", "..a", "rgb/0.png"}) {
        CAPTURE(inside);
        CHECK(staysInside(inside));
    }
    for (const char* outside : {"..", "../a", "/", "/a", "a/../..", "a/../../b", "./../a", "//x"}) {
        CAPTURE(outside);
        CHECK_FALSE(staysInside(outside));
    }
}
