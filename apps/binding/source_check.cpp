// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/source_check.h"

#include "engine/types/log.h"

#include <algorithm>
#include <fmt/core.h>
#include <utility>

namespace fathom {

namespace {

// A colour that is not black: any channel above 8 levels.
bool isLit(uint32_t rgba) {
    return (rgba & 0x00f8f8f8u) != 0;
}

// The same, of red, green and blue in single bytes. Y U V counts as lit.
bool isLit(const RawColour& raw) {
    const bool bytes = raw.format == ColourFormat::Rgb || raw.format == ColourFormat::Bgr;
    return !bytes || std::ranges::any_of(raw.bytes, [](std::byte b) { return b > std::byte{7}; });
}

} // namespace

void SourceCheck::warn(std::string text) {
    log::warn("{}", text);
    warned_.push_back(std::move(text));
}

std::vector<std::string> SourceCheck::warnings() const {
    std::vector<std::string> all = CameraDecorator::warnings();
    all.insert(all.end(), warned_.begin(), warned_.end());
    return all;
}

SourceCheck::SourceCheck(std::unique_ptr<Camera> source, const Scene& scene)
    : CameraDecorator(std::move(source))
    , nearZ_(scene.nearZ)
    , farZ_(scene.farZ) {
    const std::string why = CameraDecorator::whyNoColour();
    bool asked = false;
    for (const FixtureClass& fixture : scene.fixtures) {
        asked = asked || fixture.usesColour();
        if (!why.empty() && fixture.usesColour()) {
            warn(fmt::format("fixture '{}' will have no point: it asks for colour, but {}", fixture.name,
                             why));
        }
    }
    colourSeen_ = !asked || !why.empty();
}

// Stops at the first pixel in range: for a good source that is soon.
bool SourceCheck::inRange(std::span<const uint16_t> depth) {
    const double unit = info().metresPerUnit;
    for (const uint16_t raw : depth) {
        if (raw == 0) {
            continue;
        }
        least_ = std::min(least_, raw);
        largest_ = std::max(largest_, raw);
        if (raw * unit >= nearZ_ && raw * unit <= farZ_) {
            return true;
        }
    }
    return false;
}

void SourceCheck::look(const Frame& frame) {
    depthSeen_ = depthSeen_ || inRange(frame->depth);
    const auto lit = [&] {
        return frame->isRaw() ? isLit(frame->raw)
                              : std::ranges::any_of(frame->colour, [](uint32_t c) { return isLit(c); });
    };
    colourSeen_ = colourSeen_ || lit();
}

void SourceCheck::end() {
    done_ = true;
    const double unit = info().metresPerUnit;
    if (!depthSeen_ && largest_ == 0) {
        warn(fmt::format("{}: no depth in the first second: nothing is protected", description()));
    } else if (!depthSeen_) {
        warn(fmt::format(
            "{}: no depth of the first second is between camera.near {} m and camera.far {} m: "
            "nothing is protected; it is {:.4g} to {:.4g} m, so check the unit (scale=M) or near and "
            "far",
            description(), nearZ_, farZ_, least_ * unit, largest_ * unit));
    }
    if (!colourSeen_) {
        warn(fmt::format(
            "{}: the colour images of the first second are black, so no class that asks for colour has "
            "a point; {}",
            description(), streams()));
    }
}

std::optional<Frame> SourceCheck::next() {
    std::optional<Frame> frame = CameraDecorator::next();
    if (done_) {
        return frame;
    }
    if (!frame) {
        if (begin_) {
            end();
        }
        return frame;
    }
    begin_ = begin_ ? begin_ : std::optional((*frame)->captureTime);
    look(*frame);
    if (depthSeen_ && colourSeen_) {
        done_ = true;
    } else if ((*frame)->captureTime - *begin_ >= 1.0) {
        end();
    }
    return frame;
}

} // namespace fathom
