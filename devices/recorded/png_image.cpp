// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/png_image.h"

#include "engine/types/input_files.h"
#include "engine/types/number_text.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <png.h>
#include <vector>

namespace fathom {

namespace {

static_assert(std::endian::native == std::endian::little, "0xAABBGGRR and the byte swap assume it");

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

using Message = std::array<char, 160>;

void onError(png_structp png, png_const_charp text) {
    Message& message = *static_cast<Message*>(png_get_error_ptr(png));
    std::snprintf(message.data(), message.size(), "libpng: %s", text);
    png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {} // faults are reported as errors

// libpng reports errors by longjmp. Nothing with a destructor is alive between setjmp and the jump: each of
// the two calls below is its own function whose locals are plain.
class PngReader {
public:
    explicit PngReader(const std::filesystem::path& file)
        : file_(isRegularFile(file) ? std::fopen(file.c_str(), "rb") : nullptr) {
        noteInput(file);
        open(whyUnreadable(file));
    }
    explicit PngReader(std::span<const uint8_t> bytes)
        : file_(bytes.empty() ? nullptr
                              : ::fmemopen(const_cast<uint8_t*>(bytes.data()), bytes.size(), "rb")) {
        open("no bytes");
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    std::string fault() const { return message_.data(); }
    PngSize size() const { return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)}; }
    int bits() const { return png_get_bit_depth(png_, info_); }
    int kind() const { return png_get_color_type(png_, info_); }

    // Rows of the transformed image; true when every one was read and every checksum holds.
    bool readDepth(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_set_swap(png_); // PNG is big-endian
        return readRows(rows, sizeof(uint16_t));
    }
    bool readColour(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_set_scale_16(png_); // 16 bits -> the nearest level of 8
        png_set_expand(png_);   // palette -> RGB, grey of 1, 2, 4 bits -> 8, transparent colour -> alpha
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
        return readRows(rows, sizeof(uint32_t));
    }

private:
    void open(const std::string& whyNot) {
        if (!file_) {
            say(whyNot.c_str());
            return;
        }
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, onError, onWarning);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
        if (info_ == nullptr) {
            say("libpng: out of memory");
            return;
        }
        readHeader();
    }

    void say(const char* text) { std::snprintf(message_.data(), message_.size(), "%s", text); }

    void readHeader() {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return;
        }
        png_init_io(png_, file_.get());
        png_read_info(png_, info_);
    }

    bool readRows(png_bytepp rows, size_t bytesPerPixel) {
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        if (png_get_rowbytes(png_, info_) != bytesPerPixel * png_get_image_width(png_, info_)) {
            say("unexpected pixel format");
            return false;
        }
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    std::unique_ptr<std::FILE, CloseFile> file_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    Message message_{};
};

template <class Pixel>
std::vector<png_bytep> rowPointers(PngSize size, std::span<Pixel> target) {
    std::vector<png_bytep> rows(size.height);
    for (uint32_t v = 0; v < size.height; ++v) {
        rows[v] = reinterpret_cast<png_bytep>(target.data() + size_t{v} * size.width);
    }
    return rows;
}

// Returns why the image does not match the request; empty = it matches.
std::string checkHeader(const PngReader& png, PngSize size) {
    if (!png.fault().empty()) {
        return png.fault();
    }
    const PngSize got = png.size();
    return got == size
               ? ""
               : sizeText(got.width, got.height) + " pixels, not " + sizeText(size.width, size.height);
}

std::string readDepth(PngReader& png, PngSize size, std::span<uint16_t> target) {
    if (std::string fault = checkHeader(png, size); !fault.empty()) {
        return fault;
    }
    if (png.bits() != 16 || png.kind() != PNG_COLOR_TYPE_GRAY) {
        return std::to_string(png.bits()) + "-bit image of PNG colour type " + std::to_string(png.kind()) +
               ", not 16-bit grey";
    }
    std::vector<png_bytep> rows = rowPointers(size, target);
    return png.readDepth(rows.data()) ? "" : png.fault();
}

std::string readColour(PngReader& png, PngSize size, std::span<uint32_t> target) {
    if (std::string fault = checkHeader(png, size); !fault.empty()) {
        return fault;
    }
    std::vector<png_bytep> rows = rowPointers(size, target);
    return png.readColour(rows.data()) ? "" : png.fault();
}

} // namespace

std::optional<PngSize> readPngSize(const std::filesystem::path& file) {
    const PngReader png(file);
    return png.fault().empty() ? std::optional(png.size()) : std::nullopt;
}

std::optional<PngHeader> pngHeader(std::span<const uint8_t> bytes) {
    constexpr size_t kHeader = 26; // signature, length and name of IHDR, width, height, bits, colour type
    if (bytes.size() < kHeader || !std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin())) {
        return std::nullopt;
    }
    const auto word = [&](size_t at) {
        return uint32_t{bytes[at]} << 24 | uint32_t{bytes[at + 1]} << 16 | uint32_t{bytes[at + 2]} << 8 |
               bytes[at + 3];
    };
    return PngHeader{{word(16), word(20)}, bytes[24], bytes[25] == PNG_COLOR_TYPE_GRAY};
}

std::string readDepthPng(const std::filesystem::path& file, PngSize size, std::span<uint16_t> target) {
    PngReader png(file);
    return readDepth(png, size, target);
}

std::string readDepthPng(std::span<const uint8_t> bytes, PngSize size, std::span<uint16_t> target) {
    PngReader png(bytes);
    return readDepth(png, size, target);
}

std::string readColourPng(const std::filesystem::path& file, PngSize size, std::span<uint32_t> target) {
    PngReader png(file);
    return readColour(png, size, target);
}

std::string readColourPng(std::span<const uint8_t> bytes, PngSize size, std::span<uint32_t> target) {
    PngReader png(bytes);
    return readColour(png, size, target);
}

} // namespace fathom
