// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/source_check.h"

#include "apps/binding/scene_edits.h"
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
    , depth_(scene, CameraDecorator::info()) {
    const std::string why = CameraDecorator::whyNoColour();
    bool anyColour = false;
    for (const FixtureClass& fixture : scene.fixtures) {
        const bool uses = fixture.usesColour() && !isSpare(fixture);
        anyColour = anyColour || uses;
        if (!why.empty() && uses) {
            warn(fmt::format("fixture '{}' will have no point: it asks for colour, but {}", fixture.name,
                             why));
        }
    }
    colourSeen_ = !anyColour || !why.empty();
}

void SourceCheck::look(const Frame& frame) {
    depth_.look(frame->depth);
    const auto lit = [&] {
        return frame->isRaw() ? isLit(frame->raw)
                              : std::ranges::any_of(frame->colour, [](uint32_t c) { return isLit(c); });
    };
    colourSeen_ = colourSeen_ || lit();
}

void SourceCheck::end() {
    done_ = true;
    if (!depth_.seen()) {
        warn(description() + ": " + depth_.fault("the unit (scale=M)"));
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
    if (depth_.seen() && colourSeen_) {
        done_ = true;
    } else if ((*frame)->captureTime - *begin_ >= 1.0) {
        end();
    }
    return frame;
}

} // namespace fathom
