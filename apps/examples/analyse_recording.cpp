// SPDX-License-Identifier: Apache-2.0
// Analyses a recording without a clock: how near may a tool come along the optical axis, frame by frame?
// FOLDER has 16-bit PNG files of depth, by default of 0.001 m per unit; TUM RGB-D recordings have 0.0002.
#include <cstdio>
#include <fathom/fathom.h>
#include <filesystem>
#include <memory>
#include <png.h>
#include <set>
#include <vector>

static std::vector<std::uint16_t> readDepth(const std::string& file, const fathom::Intrinsics& lens) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const std::shared_ptr<void> atEnd(nullptr, [&](void*) { png_destroy_read_struct(&png, &info, nullptr); });
    std::vector<std::uint16_t> depth(std::size_t{lens.width} * lens.height);
    std::vector<png_bytep> rows;
    for (std::size_t v = 0; v < lens.height; ++v) {
        rows.push_back(reinterpret_cast<png_bytep>(&depth[v * lens.width]));
    }
    if (!in || setjmp(png_jmpbuf(png)) != 0) { // libpng jumps here after an error
        throw fathom::Error("cannot read " + file);
    }
    png_init_io(png, in.get());
    png_read_info(png, info);
    if (png_get_image_width(png, info) != lens.width || png_get_image_height(png, info) != lens.height ||
        png_get_bit_depth(png, info) != 16 || png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY) {
        throw fathom::Error(file + " is not a 16-bit grey image of the camera's size");
    }
    png_set_swap(png); // PNG is big-endian
    png_read_image(png, rows.data());
    return depth;
}

int main(int count, char** argument) try {
    if (count != 9 && count != 10) {
        throw fathom::Error("usage: analyse_recording FOLDER SCENE WIDTH HEIGHT FX FY CX CY [M_PER_UNIT]");
    }
    const auto number = [&](int i) { return std::stod(argument[i]); };
    fathom::CameraModel camera;
    camera.depth = {
        std::uint32_t(number(3)), std::uint32_t(number(4)), number(5), number(6), number(7), number(8), {}};
    camera.metresPerUnit = count == 10 ? number(9) : 0.001;
    fathom::Lockstep lockstep(fathom::Scene::fromFile(argument[2]), camera, {});
    const std::set<std::filesystem::path> files(std::filesystem::directory_iterator(argument[1]), {});
    for (fathom::Nanoseconds time = 0; const auto& file : files) {
        const auto depth = readDepth(file, camera.depth);
        lockstep.process({.depth = depth.data(), .stamp = time});
        fathom::Step step; // pushes ahead at 1 m/s for 1 s; the tool stops at the first region
        for (int tick = 0; tick < 1000; ++tick, time += 1'000'000) {
            lockstep.queryContacts();
            step = lockstep.step({.deviceThandle = {.position = {0, 0, 0.001 * tick}}}, time);
        }
        std::printf("%s,%.4f\n", file.filename().c_str(), step.baseTtool.position[2]);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
