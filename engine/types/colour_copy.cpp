// SPDX-License-Identifier: Apache-2.0
#include "engine/types/colour_copy.h"

#include "engine/types/yuyv.h"

namespace fathom {

void readColours(const Frame::Content& content, std::vector<uint32_t>& rgba) {
    if (content.yuyv.empty()) {
        rgba.assign(content.colour.begin(), content.colour.end());
    } else {
        rgba.resize(2 * content.yuyv.size());
        unpackYuyv(content.yuyv, rgba);
    }
}

void ColourCopy::take(const Frame::Content& content) {
    yuyv_ = !content.yuyv.empty();
    const std::span<const uint32_t> words = content.colours(yuyv_);
    words_.assign(words.begin(), words.end());
}

void ColourCopy::giveTo(std::vector<uint32_t>& rgba) {
    if (yuyv_) {
        rgba.resize(2 * words_.size());
        unpackYuyv(words_, rgba);
    } else {
        rgba.swap(words_);
    }
}

} // namespace fathom
