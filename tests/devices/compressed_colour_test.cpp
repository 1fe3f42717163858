// SPDX-License-Identifier: Apache-2.0
// Colour images in JPEG and PNG: mosaics of Bayer cameras, grey, and red and blue in either order.
#include "devices/bag/compressed_colour.h"
#include "tests/devices/encoded_images.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A mosaic that was compressed as one component is read in colour, and other such images are grey") {
    const TemporaryFolder folder;
    const char* const kOrders[] = {"rggb", "grbg", "gbrg", "bggr"}; // by the place of red
    for (uint32_t at = 0; at < 4; ++at) {
        const std::string encoding = std::string("bayer_") + kOrders[at], cells = mosaic(at, 1);
        std::string wide; // as PNG has it: the high byte first
        for (const char cell : cells) {
            wide += std::string(1, cell) + '\x12';
        }
        checkRed(packedImage(encoding + "8; jpeg compressed ", encodedJpeg(cells, true)), encoding + " JPEG");
        checkRed(packedImage(encoding + "8; png compressed ", greyPng(folder, cells, 8)), encoding + " PNG");
        checkRed(packedImage(encoding + "16; png compressed ", greyPng(folder, wide, 16)),
                 encoding + "16 PNG");
    }
    checkRed(packedImage("bayer_rggb8; jpeg compressed bgr8", encodedJpeg(255, 0, 0)), "converted before");
    const std::string grey(kAcross * kDown, '\x50');
    for (const char* format : {"jpeg", "mono8; jpeg compressed ", "rgb8; jpeg compressed bgr8"}) {
        CHECK(ros::content(packedImage(format, encodedJpeg(grey, true))) == ros::Content::Grey);
    }
    CHECK(ros::content(packedImage("mono16; png compressed ", greyPng(folder, grey + grey, 16))) ==
          ros::Content::Depth);
    const std::string cut = encodedJpeg(mosaic(0, 1), true);
    std::vector<uint32_t> out(kAcross * kDown);
    const std::string head = cut.substr(0, cut.size() / 2);
    CHECK_FALSE(readRows(packedImage("bayer_rggb8; jpeg compressed ", head), out).empty());
}

TEST_CASE(
    "Compressed colours are read as compressed_image_transport reads them, by the text of their format") {
    const TemporaryFolder folder;
    writeColour(folder.path() / "blue.png", kAcross, kDown, 0, 0, 255);
    const std::string blueJpeg = encodedJpeg(0, 0, 255), bluePng = folder.read("blue.png"),
                      redJpeg = encodedJpeg(255, 0, 0);
    for (const std::string encoding : {"rgb8", "bgr8", "bgra8"}) {
        checkRed(packedImage(encoding + "; jpeg compressed rgb8", blueJpeg), encoding + " JPEG");
        checkRed(packedImage(encoding + "; png compressed rgb8", bluePng), encoding + " PNG");
        checkRed(packedImage(encoding + "; jpeg compressed bgr8", redJpeg), encoding + " as usual");
        checkRed(packedImage(encoding + "; jpeg compressed ", redJpeg), encoding + " in doubt");
    }
    checkRed(packedImage("jpeg", redJpeg), "no encoding");
    CHECK(redAndBlueWarning("rgb8; jpeg compressed bgr8").empty());
    CHECK(redAndBlueWarning("rgb8; jpeg compressed ").find("may be swapped") != std::string::npos);
    CHECK(redAndBlueWarning("bayer_rggb8; jpeg compressed ").empty());
    CHECK(redAndBlueWarning("jpeg").empty());
}
