// SPDX-License-Identifier: Apache-2.0
// Analyses a recording without a clock: how near may a tool come along the optical axis, frame by frame?
//   analyse_recording FOLDER SCENE.yaml WIDTH HEIGHT FX FY CX CY [METRES_PER_UNIT]
// FOLDER/depth has 16-bit PNG files, by default in millimetres (0.001); TUM RGB-D recordings have 0.0002.
#include <algorithm>
#include <cstdio>
#include <fathom/fathom.h>
#include <filesystem>
#include <png.h>
#include <stdexcept>
#include <vector>

static std::vector<std::uint16_t> readDepth(const std::filesystem::path& file) {
    std::FILE* in = std::fopen(file.c_str(), "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    if (in == nullptr || setjmp(png_jmpbuf(png)) != 0)
        throw std::runtime_error("cannot read " + file.string());
    png_init_io(png, in);
    png_read_png(png, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr); // PNG is big-endian
    std::vector<std::uint16_t> depth;
    for (png_uint_32 v = 0; v < png_get_image_height(png, info); ++v) {
        const auto* row = reinterpret_cast<const std::uint16_t*>(png_get_rows(png, info)[v]);
        depth.insert(depth.end(), row, row + png_get_image_width(png, info));
    }
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(in);
    return depth;
}

int main(int count, char** argument) try {
    if (count != 9 && count != 10) {
        throw std::runtime_error(
            "usage: analyse_recording FOLDER SCENE.yaml WIDTH HEIGHT FX FY CX CY [METRES_PER_UNIT]");
    }
    const auto number = [&](int i) { return std::stod(argument[i]); };
    fathom::CameraModel camera;
    camera.depth = {
        std::uint32_t(number(3)), std::uint32_t(number(4)), number(5), number(6), number(7), number(8), {}};
    camera.metresPerUnit = count == 10 ? number(9) : 0.001;
    fathom::Lockstep lockstep(fathom::Scene::fromFile(argument[2]), camera, {});
    std::vector<std::filesystem::path> files;
    const auto folder = std::filesystem::path(argument[1]) / "depth";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    fathom::Nanoseconds time = 0;
    for (const auto& file : files) { // pushes ahead at 1 m/s for 1 s; the tool stops at the first region
        const std::vector<std::uint16_t> depth = readDepth(file);
        lockstep.process({.depth = depth.data(), .stamp = time});
        fathom::Step step;
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
