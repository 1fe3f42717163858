// SPDX-License-Identifier: Apache-2.0
#include "engine/types/stand_in.h"

#include "engine/types/read_file.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <tuple>

using namespace fathom;
using namespace std::string_literals;

TEST_CASE(
    "A file that holds a pointer, a web page or an archive in place of its content is refused as such") {
    const testing::ScratchFolder scratch;
    const std::string tar = std::string(257, 'x') + "ustar\0"s;
    for (const auto& given :
         {std::tuple("version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 12345\n"s,
                     "git lfs pull"),
          std::tuple("/annex/objects/SHA256E-s123--ab.png\n"s, "git annex get"),
          std::tuple("\n<!DOCTYPE html><html lang=en>"s, "web page"), std::tuple("<HTML>"s, "web page"),
          std::tuple("PK\x03\x04"s, "ZIP"), std::tuple("\x1f\x8b\x08"s, "gzip"),
          std::tuple("\x28\xb5\x2f\xfd"s, "zstd -d"), std::tuple("\xfd"s + "7zXZ\0"s, "xz"),
          std::tuple("BZh9"s, "bzip2"), std::tuple("7z\xbc\xaf\x27\x1c"s, "7z"),
          std::tuple("Rar!\x1a"s, "RAR"), std::tuple(tar, "tar archive")}) {
        const std::string &begin = std::get<0>(given), what = std::get<1>(given);
        scratch.write("a", begin);
        INFO(what);
        CHECK(standInOf(scratch / "a").find(what) != std::string::npos);
        const std::string refusal =
            testing::refusalOf([&] { readWholeFile(scratch / "a", 1u << 20, "a lens"); });
        CHECK(refusal.find(": content: ") != std::string::npos);
        CHECK(refusal.find(what) != std::string::npos);
        CHECK(refusal.find("(allowed: a lens)") != std::string::npos);
        CHECK(testing::refusalOf([&] { refuseStandIn(scratch / "a", "a lens"); }) == refusal);
    }
}

TEST_CASE("Other files, empty ones and missing ones are no stand-in") {
    const testing::ScratchFolder scratch;
    for (const std::string& text : {""s, "{}"s, "   "s, "<robot name='a'/>"s, "version 1"s, "# html"s,
                                    std::string(256, 'x') + "ustar"s, "\x89PNG"s}) {
        scratch.write("a", text);
        CAPTURE(text);
        CHECK(standInOf(scratch / "a") == "");
    }
    CHECK(standInOf(scratch / "none") == "");
    CHECK(standInOf(scratch.path()) == "");
}
