// SPDX-License-Identifier: Apache-2.0
#include "engine/types/colour_copy.h"

namespace fathom {

namespace {

void unpackTo(const RawColour& raw, std::vector<uint32_t>& rgba) {
    rgba.resize(size_t{raw.width} * raw.height);
    unpackColour(raw, rgba);
}

} // namespace

void readColours(const Frame::Content& content, std::vector<uint32_t>& rgba) {
    if (content.isRaw()) {
        unpackTo(content.raw, rgba);
    } else {
        rgba.assign(content.colour.begin(), content.colour.end());
    }
}

std::vector<uint32_t> coloursOf(const Frame::Content& content) {
    std::vector<uint32_t> rgba;
    readColours(content, rgba);
    return rgba;
}

void ColourCopy::take(const Frame::Content& content) {
    raw_ = content.raw;
    if (content.isRaw()) {
        bytes_.assign(raw_.bytes.begin(), raw_.bytes.end());
        raw_.bytes = bytes_;
    } else {
        words_.assign(content.colour.begin(), content.colour.end());
    }
}

void ColourCopy::giveTo(std::vector<uint32_t>& rgba) {
    if (raw_.format != ColourFormat::Rgba) {
        unpackTo(raw_, rgba);
    } else {
        rgba.swap(words_);
    }
}

} // namespace fathom
