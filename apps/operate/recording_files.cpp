// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recording_files.h"

#include "engine/types/error.h"

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <png.h>
#include <vector>

namespace fathom::operate {

namespace {

using nlohmann::json;

// rows: pointers to the raw rows, big-endian when 16 bits.
void writeRows(const std::filesystem::path& file, uint32_t width, uint32_t height, int bits, int kind,
               std::vector<png_bytep> rows) {
    const std::unique_ptr<FILE, int (*)(FILE*)> out(std::fopen(file.c_str(), "wb"), std::fclose);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    bool good = out && info != nullptr;
    if (good && setjmp(png_jmpbuf(png)) == 0) {
        png_init_io(png, out.get());
        png_set_IHDR(png, info, width, height, bits, kind, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        png_set_compression_level(png, 1); // a picture every 33 ms
        png_write_info(png, info);
        png_write_image(png, rows.data());
        png_write_end(png, info);
    } else {
        good = false;
    }
    png_destroy_write_struct(&png, &info);
    if (!good) {
        throw Error(file.string() + ": cannot be written");
    }
}

json lensJson(const Intrinsics& lens) {
    return {{"width", lens.width},
            {"height", lens.height},
            {"fx", lens.fx},
            {"fy", lens.fy},
            {"cx", lens.cx},
            {"cy", lens.cy},
            {"distortion_model", "plumb_bob"},
            {"distortion", lens.distortion}};
}

} // namespace

std::string sixDigits(uint32_t number) {
    const std::string digits = std::to_string(number);
    return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

void writeDepthPng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                   std::span<const uint16_t> depth) {
    std::vector<uint8_t> bytes;
    bytes.reserve(2 * depth.size());
    for (uint16_t value : depth) {
        bytes.push_back(static_cast<uint8_t>(value >> 8));
        bytes.push_back(static_cast<uint8_t>(value & 255));
    }
    std::vector<png_bytep> rows(height);
    for (uint32_t v = 0; v < height; ++v) {
        rows[v] = bytes.data() + 2ull * v * width;
    }
    writeRows(file, width, height, 16, PNG_COLOR_TYPE_GRAY, std::move(rows));
}

void writeColourPng(const std::filesystem::path& file, uint32_t width, uint32_t height,
                    std::span<const uint32_t> colour) {
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * colour.size());
    for (uint32_t p : colour) {
        bytes.insert(bytes.end(),
                     {static_cast<uint8_t>(p), static_cast<uint8_t>(p >> 8), static_cast<uint8_t>(p >> 16)});
    }
    std::vector<png_bytep> rows(height);
    for (uint32_t v = 0; v < height; ++v) {
        rows[v] = bytes.data() + 3ull * v * width;
    }
    writeRows(file, width, height, 8, PNG_COLOR_TYPE_RGB, std::move(rows));
}

void writeIntrinsics(const std::filesystem::path& file, const CameraInfo& camera) {
    json all;
    if (camera.registered) {
        all = lensJson(camera.depth);
    } else {
        all = {{"depth", lensJson(camera.depth)}, {"color", lensJson(camera.colour)}};
        const Pose& p = camera.colourTdepth;
        all["extrinsics_topic_tf"] = {
            {"Color",
             {{"t", {p.position.x, p.position.y, p.position.z}},
              {"q_xyzw", {p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w}}}}};
    }
    all["depth_scale_m_per_unit"] = camera.metresPerUnit;
    all["registered_to_color"] = camera.registered;
    std::ofstream out(file);
    out << all.dump(1) << "\n";
    if (!out) {
        throw Error(file.string() + ": cannot be written");
    }
}

} // namespace fathom::operate
