// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/png_output.h"

#include "engine/types/error.h"

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <png.h>
#include <vector>

namespace fathom {

namespace {

constexpr int kEffort = 1; // zlib level: 30 frames per second matter more than the last tenth of the size

struct CloseOutput {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

void keepMessage(png_structp png, png_const_charp message) {
    auto* kept = static_cast<char*>(png_get_error_ptr(png));
    std::snprintf(kept, 128, "%s", message);
    std::longjmp(png_jmpbuf(png), 1); // NOLINT: libpng's error path
}

void ignoreWarning(png_structp, png_const_charp) {}

// No object with a destructor lives between setjmp and a possible longjmp.
bool writeRows(std::FILE* file, PngSize size, int bits, int colourType, bool fourBytes, png_bytepp rows,
               char* message) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, message, keepMessage, ignoreWarning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, file);
    png_set_compression_level(png, kEffort);
    png_set_filter(png, 0, PNG_FILTER_SUB);
    png_set_IHDR(png, info, size.width, size.height, bits, colourType, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    if (bits == 16) {
        png_set_swap(png); // source is little-endian
    }
    if (fourBytes) {
        png_set_filler(png, 0, PNG_FILLER_AFTER); // drops alpha
    }
    png_write_image(png, rows);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

void write(const std::filesystem::path& path, PngSize size, int bits, int colourType, const void* pixels,
           size_t bytesPerPixel) {
    std::vector<png_bytep> rows(size.height);
    auto* first = static_cast<png_byte*>(const_cast<void*>(pixels));
    for (uint32_t y = 0; y < size.height; ++y) {
        rows[y] = first + size_t{y} * size.width * bytesPerPixel;
    }
    std::unique_ptr<std::FILE, CloseOutput> file(std::fopen(path.c_str(), "wbx"));
    if (!file) {
        throw Error(path.string() + ": cannot be written (" + std::strerror(errno) + ")");
    }
    char message[128] = "libpng refuses";
    const bool written =
        writeRows(file.get(), size, bits, colourType, bytesPerPixel == 4, rows.data(), message);
    if (!written || std::fflush(file.get()) != 0) {
        throw Error(path.string() + ": cannot be written (" + (written ? std::strerror(errno) : message) +
                    ")");
    }
}

} // namespace

void writeDepthPng(const std::filesystem::path& file, PngSize size, std::span<const uint16_t> pixels) {
    write(file, size, 16, PNG_COLOR_TYPE_GRAY, pixels.data(), 2);
}

void writeColourPng(const std::filesystem::path& file, PngSize size, std::span<const uint32_t> pixels) {
    write(file, size, 8, PNG_COLOR_TYPE_RGB, pixels.data(), 4);
}

} // namespace fathom
