// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/picked_parts.h"

#include "engine/cloud/pixel_parts.h"

#include <algorithm>
#include <limits>

namespace fathom::operate {

namespace {

using Pixels = std::vector<cloud::PartPixel>;

constexpr double kPickRoom = 0.02; // [m] of the box around the points: noise, and a little motion

Pixels selectedPixels(std::span<const uint8_t> selection, const HostFixtures& set) {
    Pixels pixels;
    const uint32_t width = set.camera.depth.width;
    for (uint32_t i = 0; i < selection.size(); ++i) {
        if (selection[i] != 0) {
            const auto z = static_cast<float>(set.depth[i] * set.camera.metresPerUnit);
            pixels.push_back({i % width, i / width, i, z});
        }
    }
    return pixels;
}

dvec3 pointOf(const cloud::PartPixel& p, const HostFixtures& set) {
    return set.baseTcamera.apply(double{p.z} * dvec3(set.camera.depth.ray(p.u, p.v), 1.0));
}

// The part of the pixel nearest to the click.
uint32_t clickedPart(const Pixels& pixels, std::span<const uint32_t> parts, std::span<const uint8_t> counts,
                     glm::uvec2 clicked) {
    uint32_t best = 0;
    auto nearest = std::numeric_limits<int64_t>::max();
    for (size_t i = 0; i < pixels.size(); ++i) {
        const int64_t du = int64_t{pixels[i].u} - clicked.x, dv = int64_t{pixels[i].v} - clicked.y;
        if (counts[parts[i]] != 0 && du * du + dv * dv < nearest) {
            nearest = du * du + dv * dv;
            best = parts[i];
        }
    }
    return best;
}

// 1 at the index of each part that is taken. Counts all of them in `found`.
std::vector<uint8_t> takenParts(const Pixels& pixels, std::span<const uint32_t> parts, glm::uvec2 clicked,
                                const PartRules& rules, uint32_t speck, PickedParts& found) {
    const std::vector<uint32_t> sizes = cloud::partSizes(parts);
    std::vector<uint8_t> takes(parts.size(), 0);
    for (size_t i = 0; i < sizes.size(); ++i) {
        found.parts += sizes[i] > 0 ? 1 : 0;
        found.specks += sizes[i] > 0 && sizes[i] < speck ? 1 : 0;
    }
    const uint32_t least = rules.noSpecks && found.specks < found.parts ? speck : 1;
    for (size_t i = 0; i < sizes.size(); ++i) {
        takes[i] = sizes[i] >= least ? 1 : 0;
    }
    if (rules.onlyClicked) {
        const uint32_t one = clickedPart(pixels, parts, takes, clicked);
        takes.assign(takes.size(), 0);
        takes[one] = 1;
    }
    found.taken = static_cast<uint32_t>(std::count(takes.begin(), takes.end(), uint8_t{1}));
    return takes;
}

} // namespace

uint32_t speckPoints(const Intrinsics& lens) {
    return std::max<uint32_t>(8, static_cast<uint32_t>(lens.pixels() / 10'000));
}

PickedParts takeParts(std::span<uint8_t> selection, const HostFixtures& set, glm::uvec2 clicked,
                      const PartRules& rules, double edge) {
    PickedParts found;
    const Pixels pixels = selectedPixels(selection, set);
    if (pixels.empty()) {
        return found;
    }
    const std::vector<uint32_t> parts = cloud::connectedParts(pixels, edge);
    const std::vector<uint8_t> takes =
        takenParts(pixels, parts, clicked, rules, speckPoints(set.camera.depth), found);
    if (!rules.onlyClicked && !rules.noSpecks) {
        return found;
    }
    Box box{dvec3(std::numeric_limits<double>::infinity()), dvec3(-std::numeric_limits<double>::infinity())};
    for (size_t i = 0; i < pixels.size(); ++i) {
        if (takes[parts[i]] != 0) {
            const dvec3 at = pointOf(pixels[i], set);
            box = {glm::min(box.min, at - kPickRoom), glm::max(box.max, at + kPickRoom)};
        }
    }
    for (size_t i = 0; i < pixels.size(); ++i) {
        const dvec3 at = pointOf(pixels[i], set);
        const bool in =
            glm::all(glm::lessThanEqual(box.min, at)) && glm::all(glm::lessThanEqual(at, box.max));
        selection[pixels[i].slot] = in ? 1 : 0;
        found.others += in && takes[parts[i]] == 0 ? 1 : 0;
    }
    found.box = box;
    return found;
}

} // namespace fathom::operate
