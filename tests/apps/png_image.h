// SPDX-License-Identifier: Apache-2.0
// A PNG, read back by pixel.
#pragma once

#include "apps/output/image.h"

#include <filesystem>

namespace fathom::testing {

class PngImage {
public:
    explicit PngImage(const std::filesystem::path& file)
        : surface_(cairo_image_surface_create_from_png(file.c_str())) {}
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
    ~PngImage() { cairo_surface_destroy(surface_); }
    int width() const { return cairo_image_surface_get_width(surface_); }
    int height() const { return cairo_image_surface_get_height(surface_); }
    // 0xRRGGBB
    uint32_t at(int u, int v) const {
        const unsigned char* row =
            cairo_image_surface_get_data(surface_) + v * cairo_image_surface_get_stride(surface_);
        return reinterpret_cast<const uint32_t*>(row)[u] & 0xffffffu;
    }
    int red(int u, int v) const { return static_cast<int>(at(u, v) >> 16); }
    int blue(int u, int v) const { return static_cast<int>(at(u, v) & 0xffu); }

private:
    cairo_surface_t* surface_;
};

} // namespace fathom::testing
