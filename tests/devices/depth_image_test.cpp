// SPDX-License-Identifier: Apache-2.0
// Depth images in the files of other programs: NumPy, tifffile, Pillow, netpbm and OpenEXR wrote those of the
// corpus. Their values: 1000 + 10 x + 100 y, or that in metres; OpenEXR: 1 + 0.01 x + 0.1 (y % 5).
#include "devices/images/depth_image.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"

#include <doctest/doctest.h>
#include <fstream>
#include <sys/stat.h>

using namespace fathom;

namespace {

namespace fs = std::filesystem;

const fs::path kMade = "tests/fuzz/corpus/depth_image";

std::vector<uint16_t> depthOf(const std::string& name, bool metres, PngSize size = {7, 5}) {
    const DepthHeader head = depthImageHeader(kMade / name);
    CAPTURE(name);
    CHECK(head.fault == "");
    CHECK(head.size == size);
    CHECK(head.metres == metres);
    std::vector<uint16_t> depth(size.width * size.height, 9);
    uint64_t beyond = 0;
    CHECK(readDepthImage(kMade / name, size, {metres, 0.001}, depth, beyond) == "");
    CHECK(beyond == 0);
    return depth;
}

// From the third pixel on: NaN, infinity and -1 begin the images of metres.
void checkValues(const std::vector<uint16_t>& depth, size_t from) {
    for (size_t i = from; i < depth.size(); ++i) {
        CHECK(depth[i] == 1000 + 10 * (i % 7) + 100 * (i / 7 % 5));
    }
    for (size_t i = 0; i < from; ++i) {
        CHECK(depth[i] == 0);
    }
}

std::string faultOf(const std::string& name) {
    std::vector<uint16_t> depth(35);
    uint64_t beyond = 0;
    const DepthHeader head = depthImageHeader(kMade / name);
    CHECK(readDepthImage(kMade / name, {7, 5}, {}, depth, beyond) == head.fault);
    return head.fault;
}

// A recording of one frame whose depth image is this file.
void writeRecording(const TemporaryFolder& folder, const std::string& name, const std::string& ending,
                    const std::string& scale = R"(, "depth_scale_m_per_unit": 0.001)") {
    fs::create_directories(folder.path() / "depth");
    fs::copy_file(kMade / name, folder.path() / ("depth/0" + ending));
    folder.write("depth.txt", "0 depth/0" + ending + "\n");
    folder.write("intrinsics.json",
                 R"({"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2, "has_color": false)" +
                     scale + "}");
}

} // namespace

TEST_CASE("Depth of 16 bits is read from PGM, TIFF and NPY as other programs write them") {
    for (const char* name : {"pgm_u2", "npy_u2", "npy_u2_big", "npy_i4", "tiff_u2", "tiff_u2_big",
                             "tiff_u2_lzw", "tiff_u2_packbits", "tiff_bigtiff"}) {
        CAPTURE(name);
        checkValues(depthOf(name, false), 0);
    }
    checkValues(depthOf("pgm_comment", false), 0);
    CHECK(depthOf("pgm_9999", false)[0] == 153); // netpbm scaled it to its maximum: as stored
}

TEST_CASE("Float depth is read from TIFF, NPY and EXR; NaN and infinity mean no depth") {
    for (const char* name : {"npy_f4", "npy_f4_big", "npy_f8", "npy_f8_big", "npy_version3", "tiff_f4",
                             "tiff_f4_deflate", "tiff_f8"}) {
        CAPTURE(name);
        checkValues(depthOf(name, true), 3);
    }
    for (const char* name : {"exr_z_zip", "exr_rgb_none", "exr_v_zip", "exr_z_zips_half"}) {
        CAPTURE(name);
        const auto depth = depthOf(name, true, {7, 37});
        CHECK(depth[0] == 0);
        CHECK(depth[1] == 0);
        for (size_t i = 2; i < depth.size(); ++i) {
            CHECK(std::abs(depth[i] - static_cast<double>(1000 + 10 * (i % 7) + 100 * (i / 7 % 5))) <=
                  1.0); // half: 1 mm
        }
    }
}

TEST_CASE("Depth images that are not read name the field, its value and what is allowed") {
    const auto holds = [](const std::string& text, const std::string& part) {
        CAPTURE(text);
        CHECK(text.find(part) != std::string::npos);
    };
    holds(faultOf("npy_fortran"), "fortran_order: True (allowed: False");
    holds(faultOf("npy_flat"), "shape: (35,) (allowed: (height, width)");
    holds(faultOf("pgm_8bit"), "maximum value 255 (allowed: 256 to 65535");
    holds(faultOf("tiff_rgb"), "SamplesPerPixel: 3 (allowed: 1)");
    holds(faultOf("tiff_tiles"), "tiles (allowed: strips)");
    holds(faultOf("exr_z_piz"), "compression: PIZ (allowed: none, ZIPS, ZIP)");
    holds(faultOf("exr_ab"), "channels: A, B (allowed: Z, depth");
    std::vector<uint16_t> depth(259);
    uint64_t beyond = 0;
    holds(readDepthImage(kMade / "exr_colours", {7, 37}, {true, 0.001}, depth, beyond), "a colour image");
}

TEST_CASE("Arrays of every size of integers, and of half floats, hold depth as np.save of a scaled array "
          "writes it") {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a.npy";
    const auto readAs = [&](const std::string& descr, const std::string& values,
                            std::vector<uint16_t>& depth) {
        std::string head = "{'descr': '" + descr + "', 'fortran_order': False, 'shape': (1, 2), }";
        head.resize(118, ' ');
        std::ofstream(file, std::ios::binary) << std::string("\x93NUMPY\x01\x00v\x00", 10) << head << values;
        const DepthHeader found = depthImageHeader(file);
        uint64_t beyond = 0;
        return found.fault.empty() ? readDepthImage(file, {2, 1}, {found.metres, 0.001}, depth, beyond)
                                   : found.fault;
    };
    using namespace std::string_literals;
    const std::string zeros6(6, '\0'), ones6(6, '\xff');
    for (const auto& given : {std::pair("<i2"s, "\xe8\x03\xff\xff"s),
                              {">i2"s, "\x03\xe8\xff\xff"s},
                              {"<i4"s, "\xe8\x03\0\0\xff\xff\xff\xff"s},
                              {"<u4"s, "\xe8\x03\0\0\0\0\0\0"s},
                              {"<i8"s, "\xe8\x03"s + zeros6 + "\xff\xff"s + ones6},
                              {">u8"s, zeros6 + "\x03\xe8\0\0"s + zeros6},
                              {"<f2"s, "\0\x3c\0\xbc"s}}) { // 1.0 and -1.0
        const auto &descr = given.first, &values = given.second;
        INFO(descr);
        std::vector<uint16_t> depth(2, 9);
        CHECK(readAs(descr, values, depth) == "");
        CHECK(depth == std::vector<uint16_t>{1000, 0});
    }
    std::vector<uint16_t> depth(2);
    CHECK(readAs("<u4", "\0\0\x01\0\0\0\0\0"s, depth) == "NPY: a value of 65536 (allowed: up to 65535)");
    CHECK(readAs("<u8", zeros6 + "\0\x80"s + std::string(8, '\0'), depth).find("9223372036854775808") !=
          std::string::npos);
    for (const char* other : {"|u1", "<c8", "<b2", "|O8", "<f16"}) {
        CHECK(readAs(other, "", depth).find("descr: '"s + other + "' (allowed: integers or floating") !=
              std::string::npos);
    }
}

TEST_CASE("Depth in a format that is not read is named as such, and a PGM may end in a line end") {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a";
    std::vector<uint16_t> depth(2);
    uint64_t beyond = 0;
    for (const char* text : {"P2\n2 1\n65535\n1 2\n", "Pf\n2 1\n-1.0\n12345678", ""}) {
        std::ofstream(file) << text;
        CHECK(readDepthImage(file, {2, 1}, {}, depth, beyond) == "not PNG, PGM (P5), TIFF, NPY or EXR");
    }
    const std::string pgm = "P5\n2 1\n65535\nabcd";
    for (const char* end : {"", "\n"}) {
        std::ofstream(file) << pgm << end;
        CHECK(readDepthImage(file, {2, 1}, {}, depth, beyond) == "");
        CHECK(depth[1] == ('c' << 8 | 'd'));
    }
    std::ofstream(file) << pgm << "\n\n";
    CHECK(readDepthImage(file, {2, 1}, {}, depth, beyond) == "PGM: 6 bytes of pixels, not 4");
}

TEST_CASE("A depth image that is not there, a folder and a pipe are named as such") {
    const TemporaryFolder folder;
    REQUIRE(::mkfifo((folder.path() / "pipe").c_str(), 0600) == 0);
    std::vector<uint16_t> depth(2);
    uint64_t beyond = 0;
    for (const auto& [name, why] : {std::pair("none", "no such file"), std::pair("", "a folder"),
                                    std::pair("pipe", "a pipe or device")}) {
        CHECK(depthImageHeader(folder.path() / name).fault == why);
        CHECK(readDepthImage(folder.path() / name, {2, 1}, {}, depth, beyond) == why);
    }
}

TEST_CASE("A depth image that is cut off anywhere is a fault") {
    const TemporaryFolder folder;
    for (const char* name : {"pgm_u2", "npy_f8", "tiff_u2", "exr_z_zip", "exr_rgb_none"}) {
        CAPTURE(name);
        fs::copy_file(kMade / name, folder.path() / name);
        const PngSize size = depthImageHeader(kMade / name).size;
        const bool metres = depthImageHeader(kMade / name).metres;
        std::vector<uint16_t> depth(size.width * size.height);
        for (uintmax_t bytes = fs::file_size(kMade / name); bytes-- > 0;) {
            fs::resize_file(folder.path() / name, bytes);
            uint64_t beyond = 0;
            CHECK(readDepthImage(folder.path() / name, size, {metres, 0.001}, depth, beyond) != "");
        }
    }
}

TEST_CASE("Metres of a folder stay metres, whatever depth scale is stated, and get a fine unit") {
    for (const char* scale :
         {"", R"(, "depth_scale_m_per_unit": 1.0)", R"(, "depth_scale_m_per_unit": 0.001)"}) {
        const TemporaryFolder folder;
        writeRecording(folder, "npy_f4", ".npy", scale);
        RecordedCamera camera(folder.path());
        CHECK(camera.info().metresPerUnit == doctest::Approx(1e-4));
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[34] * camera.info().metresPerUnit == doctest::Approx(1.46));
        CHECK((*frame)->depth[0] == 0);
    }
    const TemporaryFolder folder;
    writeRecording(folder, "tiff_f8", ".tif", "");
    RecordedCamera camera(folder.path(), {.scale = 10.0}); // tens of metres
    const auto frame = camera.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[34] * camera.info().metresPerUnit == doctest::Approx(14.6).epsilon(1e-4));
    CHECK(camera.warnings().empty());
    const RecordedCamera far(folder.path(), {.scale = 100.0});
    REQUIRE(far.warnings().size() == 1); // no camera sees so far
    CHECK(far.warnings()[0].find("scale=0.01 ") != std::string::npos);
}

TEST_CASE("Sixteen bits of a folder need a scale in every format, and one folder holds one kind") {
    for (const auto& [name, ending] :
         {std::pair("pgm_u2", ".pgm"), std::pair("tiff_u2", ".TIF"), std::pair("npy_u2_big", ".npy")}) {
        const TemporaryFolder folder;
        writeRecording(folder, name, ending, "");
        CHECK_THROWS_WITH_AS(RecordedCamera{folder.path()},
                             doctest::Contains("depth_scale_m_per_unit: missing"), BadInput);
        fs::remove_all(folder.path() / "depth");
        writeRecording(folder, name, ending);
        fs::copy_file(kMade / "npy_f4", folder.path() / "depth/1.npy");
        folder.write("depth.txt", std::string("0 depth/0") + ending + "\n1 depth/1.npy\n");
        RecordedCamera camera(folder.path());
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[34] == 1460);
        CHECK_FALSE(camera.next());
        CHECK(camera.skipped() == 1);
        CHECK(camera.warnings().at(0).find("floating point, not 16-bit values") != std::string::npos);
    }
}
