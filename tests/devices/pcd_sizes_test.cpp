// SPDX-License-Identifier: Apache-2.0
// Sizes that the header of a PCD file states, compared with those of the file before memory is allocated.
#include "devices/pcd/pcd_file.h"

#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

// 63 points of 16 bytes.
constexpr const char* kSmallCloud = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 9\n"
                                    "HEIGHT 7\nDATA ";
// 3840x2160 points of 4092 bytes.
constexpr const char* kLargeCloud =
    "FIELDS x y z a\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1020\nWIDTH 3840\n"
    "HEIGHT 2160\nDATA ";

std::string refusalOfCloud(const std::string& text) {
    const ScratchFile file("cloud.pcd", text);
    return refusalOf([&] { readPcd(file.path()); });
}

void checkRefused(const std::string& text, const std::string& part) {
    const std::string message = refusalOfCloud(text);
    CAPTURE(message);
    CHECK(message.find(part) != std::string::npos);
}

} // namespace

TEST_CASE("An ASCII cloud with fewer bytes than its values need is rejected before it is read") {
    std::string text = std::string(kSmallCloud) + "ascii\n1";
    for (int i = 1; i < 4 * 63; ++i) {
        text += " 1";
    }
    CHECK(refusalOfCloud(text) == "");
    text.pop_back();
    checkRefused(text, "DATA: 502 bytes (allowed: at least 503: WIDTH x HEIGHT points)");
    checkRefused(std::string(kLargeCloud) + "ascii\n1 2 3", "DATA: 5 bytes (allowed: at least 16970342399: ");
    text.replace(text.rfind("1 "), 1, "1000"); // enough bytes, but one value too few
    checkRefused(text, "DATA: ends at point 62 (allowed: WIDTH x HEIGHT points)");
}

TEST_CASE("A compressed cloud of more bytes than its file states or can contain is rejected") {
    checkRefused(std::string(kLargeCloud) + "binary_compressed\n" + std::string(100, '\1'),
                 "DATA: 16843009 bytes unpacked (allowed: 33940684800, undamaged)");
    const std::string sizes("\x64\0\0\0\xf0\x03\0\0", 8); // 100 bytes packed, 1008 unpacked
    checkRefused(std::string(kSmallCloud) + "binary_compressed\n" + sizes,
                 "DATA: 1008 bytes unpacked (allowed: 1008, undamaged)");
}

TEST_CASE("A compressed cloud of equal bytes, which LZF packs most, is unpacked") {
    // A zero, then matches of 264, 264, 264 and 215 bytes from 1 back: 1008 bytes.
    const std::string packed("\0\0\xe0\xff\0\xe0\xff\0\xe0\xff\0\xe0\xce\0", 14);
    const std::string sizes("\x0e\0\0\0\xf0\x03\0\0", 8);
    CHECK(refusalOfCloud(std::string(kSmallCloud) + "binary_compressed\n" + sizes + packed) == "");
}
