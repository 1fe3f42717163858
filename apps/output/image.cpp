// SPDX-License-Identifier: Apache-2.0
#include "apps/output/image.h"

#include "engine/types/angle.h"
#include "engine/types/error.h"
#include "engine/types/output_file.h"

#include <exception>
#include <utility>

namespace fathom {

namespace {

struct PngSink {
    OutputFile& file;
    std::exception_ptr failure; // exceptions must not pass through cairo, which is C
};

cairo_status_t writeChunk(void* closure, const unsigned char* bytes, unsigned int count) {
    auto& sink = *static_cast<PngSink*>(closure);
    try {
        sink.file.write(bytes, count);
        return CAIRO_STATUS_SUCCESS;
    } catch (...) {
        sink.failure = std::current_exception();
        return CAIRO_STATUS_WRITE_ERROR;
    }
}

void selectFont(cairo_t* cr, double size, bool bold) {
    cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
}

// Replaces bytes that are not UTF-8. They would put the cairo context into a permanent error state, and
// device names may contain them.
std::string drawable(const std::string& words) {
    std::string result;
    for (size_t i = 0; i < words.size(); ++i) {
        const auto lead = static_cast<unsigned char>(words[i]);
        const size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 0;
        bool good = length > 0 && lead < 0xf5 && lead >= 0x20 && i + length <= words.size();
        for (size_t k = 1; good && k < length; ++k) {
            good = (static_cast<unsigned char>(words[i + k]) & 0xc0u) == 0x80u;
        }
        result += good ? words.substr(i, length) : "?";
        i += good ? length - 1 : 0;
    }
    return result;
}

} // namespace

Image::Image(int width, int height, Colour background)
    : width_(width)
    , height_(height) {
    surface_ = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
    cr_ = cairo_create(surface_);
    if (const cairo_status_t status = cairo_status(cr_); status != CAIRO_STATUS_SUCCESS) {
        cairo_destroy(cr_);
        cairo_surface_destroy(surface_);
        throw Error("image of " + std::to_string(width) + " x " + std::to_string(height) + ": " +
                    cairo_status_to_string(status));
    }
    setColour(background);
    cairo_paint(cr_);
}

Image::Image(Image&& other) noexcept
    : width_(other.width_)
    , height_(other.height_)
    , surface_(std::exchange(other.surface_, nullptr))
    , cr_(std::exchange(other.cr_, nullptr)) {}

Image::~Image() {
    cairo_destroy(cr_);
    cairo_surface_destroy(surface_);
}

void Image::setColour(Colour colour) const {
    cairo_set_source_rgba(cr_, colour.r, colour.g, colour.b, colour.a);
}

void Image::line(double x0, double y0, double x1, double y1, Colour colour, double width) const {
    setColour(colour);
    cairo_set_line_width(cr_, width);
    cairo_move_to(cr_, x0, y0);
    cairo_line_to(cr_, x1, y1);
    cairo_stroke(cr_);
}

void Image::box(double x, double y, double width, double height, Colour colour) const {
    setColour(colour);
    cairo_rectangle(cr_, x, y, width, height);
    cairo_fill(cr_);
}

void Image::dot(double x, double y, double radius, Colour colour) const {
    setColour(colour);
    cairo_arc(cr_, x, y, radius, 0.0, kTurn);
    cairo_fill(cr_);
}

void Image::text(double x, double y, const std::string& words, double size, Colour colour, Align align,
                 bool bold) const {
    const std::string shown = drawable(words);
    selectFont(cr_, size, bold);
    cairo_text_extents_t extents;
    cairo_text_extents(cr_, shown.c_str(), &extents);
    const double shift = align == Align::Left ? 0.0 : align == Align::Centre ? 0.5 : 1.0;
    cairo_move_to(cr_, x - shift * extents.x_advance, y);
    setColour(colour);
    cairo_show_text(cr_, shown.c_str());
    cairo_new_path(cr_);
}

void Image::textUpwards(double x, double y, const std::string& words, double size, Colour colour,
                        bool bold) const {
    cairo_save(cr_);
    cairo_translate(cr_, x, y);
    cairo_rotate(cr_, -0.25 * kTurn);
    text(0.0, 0.0, words, size, colour, Align::Centre, bold);
    cairo_restore(cr_);
}

double Image::textWidth(const std::string& words, double size, bool bold) const {
    selectFont(cr_, size, bold);
    cairo_text_extents_t extents;
    cairo_text_extents(cr_, drawable(words).c_str(), &extents);
    return extents.x_advance;
}

void Image::beginPixels() const {
    cairo_surface_flush(surface_);
}

uint32_t* Image::row(int v) const {
    unsigned char* first = cairo_image_surface_get_data(surface_);
    const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(surface_));
    return reinterpret_cast<uint32_t*>(first + static_cast<size_t>(v) * stride);
}

void Image::endPixels() const {
    cairo_surface_mark_dirty(surface_);
}

void Image::writePng(const std::filesystem::path& file) const {
    OutputFile out(file);
    writePng(out);
    out.commit();
}

void Image::writePng(OutputFile& file) const {
    PngSink sink{file, nullptr};
    const cairo_status_t drawn = cairo_status(cr_);
    const cairo_status_t status = drawn == CAIRO_STATUS_SUCCESS
                                      ? cairo_surface_write_to_png_stream(surface_, writeChunk, &sink)
                                      : drawn;
    if (sink.failure) {
        std::rethrow_exception(sink.failure);
    }
    if (status != CAIRO_STATUS_SUCCESS) {
        throw Error(file.path().string() + ": cannot draw: " + cairo_status_to_string(status));
    }
}

} // namespace fathom
