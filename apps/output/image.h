// SPDX-License-Identifier: Apache-2.0
// A raster image drawn with cairo and written as a PNG file.
#pragma once

#include <cairo.h>
#include <cstdint>
#include <filesystem>
#include <string>

namespace fathom {

class OutputFile;

struct Colour {
    double r = 0.0, g = 0.0, b = 0.0, a = 1.0; // 0..1, not premultiplied

    constexpr Colour alpha(double value) const { return {r, g, b, value}; }
};

enum class Align { Left, Centre, Right };

// Coordinates are pixels from the top left corner, y down, with pixel centres at halves. Throws Error when
// cairo runs out of memory.
class Image {
public:
    Image(int width, int height, Colour background);
    Image(Image&& other) noexcept;
    Image& operator=(const Image&) = delete;
    ~Image();

    int width() const { return width_; }
    int height() const { return height_; }
    cairo_t* cr() const { return cr_; }

    void setColour(Colour colour) const;
    void line(double x0, double y0, double x1, double y1, Colour colour, double width) const;
    void box(double x, double y, double width, double height, Colour colour) const; // filled rectangle
    void dot(double x, double y, double radius, Colour colour) const;
    // (x, y) is the left end, middle or right end of the baseline. size: pixels per em.
    void text(double x, double y, const std::string& words, double size, Colour colour,
              Align align = Align::Left, bool bold = false) const;
    // Text that reads upwards, centred at (x, y), for the label of a vertical axis.
    void textUpwards(double x, double y, const std::string& words, double size, Colour colour,
                     bool bold = false) const;
    double textWidth(const std::string& words, double size, bool bold = false) const;

    // Direct access to row v: width() pixels 0xAARRGGBB, premultiplied. Call endPixels() before drawing
    // again.
    void beginPixels() const;
    uint32_t* row(int v) const;
    void endPixels() const;

    // Writes the file completely or not at all. Throws Error that names the file.
    void writePng(const std::filesystem::path& file) const;
    void writePng(OutputFile& file) const; // without commit

private:
    int width_, height_;
    cairo_surface_t* surface_ = nullptr;
    cairo_t* cr_ = nullptr;
};

} // namespace fathom
