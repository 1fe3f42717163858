// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/recorded_folder.h"

#include "devices/recorded/recorded_camera.h"
#include "tests/support/refusal.h"

#include <array>
#include <cstdio>
#include <doctest/doctest.h>
#include <png.h>
#include <stdexcept>

namespace fathom {

const std::string kSmallIntrinsics = R"({"width": 7, "height": 5, "fx": 6.5, "fy": 6.25,
 "cx": 3, "cy": 2,
 "distortion_model": "none", "distortion": [], "depth_scale_m_per_unit": 0.001, "registered_to_color": true})";

bool haveRecording(const std::string& name) {
    if (std::filesystem::is_directory(kRecordings / name)) {
        return true;
    }
    MESSAGE("SKIPPED: there is no recording ", (kRecordings / name).string());
    return false;
}

void writePng(const std::filesystem::path& file, uint32_t width, uint32_t height, int bits, int colourType,
              const std::vector<uint8_t>& bytes, bool interlaced) {
    std::filesystem::create_directories(file.parent_path());
    std::FILE* out = std::fopen(file.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    if (out == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        throw std::runtime_error("the test cannot write its image");
    }
    png_init_io(png, out);
    png_set_IHDR(png, info, width, height, bits, colourType,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    const std::array<png_color, 3> palette{{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}};
    if (colourType == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
    }
    png_write_info(png, info);
    std::vector<png_bytep> rows;
    for (uint32_t v = 0; v < height; ++v) {
        rows.push_back(const_cast<png_bytep>(bytes.data() + bytes.size() / height * v));
    }
    png_write_image(png, rows.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(out);
}

void writeDepth(const std::filesystem::path& file, uint32_t width, uint32_t height, uint16_t value) {
    std::vector<uint8_t> bytes;
    for (uint32_t i = 0; i < width * height; ++i) {
        bytes.push_back(static_cast<uint8_t>(value >> 8));
        bytes.push_back(static_cast<uint8_t>(value & 255));
    }
    writePng(file, width, height, 16, PNG_COLOR_TYPE_GRAY, bytes);
}

void writeColour(const std::filesystem::path& file, uint32_t width, uint32_t height, uint8_t r, uint8_t g,
                 uint8_t b) {
    std::vector<uint8_t> bytes;
    for (uint32_t i = 0; i < width * height; ++i) {
        bytes.insert(bytes.end(), {r, g, b});
    }
    writePng(file, width, height, 8, PNG_COLOR_TYPE_RGB, bytes);
}

void writeSmallRecording(const TemporaryFolder& folder, uint32_t frames) {
    std::string index = "# t_rgb rgb t_depth depth\n";
    for (uint32_t i = 0; i < frames; ++i) {
        const std::string name = std::to_string(i) + ".png", stamp = std::to_string(0.1 * i);
        writeDepth(folder.path() / "depth" / name, kSmallWidth, kSmallHeight,
                   static_cast<uint16_t>(1000 + i));
        writeColour(folder.path() / "rgb" / name, kSmallWidth, kSmallHeight, static_cast<uint8_t>(i), 20, 30);
        index += stamp + " rgb/" + name + " " + stamp + " depth/" + name + "\n\n";
    }
    folder.write("associations.txt", index);
    folder.write("intrinsics.json", kSmallIntrinsics);
}

void addPair(const TemporaryFolder& folder, const std::string& depth, const std::string& colour,
             uint16_t value) {
    writeDepth(folder.path() / depth, kSmallWidth, kSmallHeight, value);
    writeColour(folder.path() / colour, kSmallWidth, kSmallHeight, 200, 10, 10);
}

std::vector<uint16_t> playedDepths(const std::filesystem::path& folder, const SourceOptions& options) {
    RecordedCamera camera(folder, options);
    std::vector<uint16_t> depths;
    while (const auto frame = camera.next()) {
        depths.push_back((*frame)->depth[0]);
    }
    return depths;
}

std::string recordingRefusal(const std::filesystem::path& folder, const SourceOptions& options) {
    return testing::refusalOf([&] {
        RecordedCamera camera(folder, options);
        while (camera.next()) {
        }
    });
}

} // namespace fathom
