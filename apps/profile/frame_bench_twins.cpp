// SPDX-License-Identifier: Apache-2.0
// Compares a bench's last frame with the float64 twins, before any timing.
#include "apps/profile/frame_bench.h"
#include "apps/verify/pass_rig.h"
#include "engine/cloud/frame_params.h"
#include "engine/reference/classify.h"
#include "engine/reference/guidance.h"
#include "engine/reference/self_filter.h"
#include "engine/reference/surface.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace fathom::profile {

namespace {

constexpr double kSamePoint = 2e-5; // [m] float32 passes against float64, up to 4 m away
constexpr double kSameDepth = 1e-6; // [m] depth of an occlusion cell
constexpr double kSamePixel = 1e-3; // [colour pixels] from a cell border, where either cell is right

} // namespace

std::vector<uint32_t> FrameBench::masks() const {
    return verify::masksOf(device_, *cycle_, camera_);
}

reference::PointImage FrameBench::points() const {
    return verify::pointsOf(device_, *cycle_, *lease_, camera_);
}

namespace {

// Selects about `most` patches at a fixed stride in row-major order, and the four corners. The stride has no
// common factor with the row length, so it does not stay in a few columns.
std::vector<uint8_t> samplePatches(const PatchLayout& layout, size_t most) {
    const size_t count = layout.patches();
    std::vector<uint8_t> chosen(count, most >= count ? 1 : 0);
    size_t stride = std::max<size_t>(1, (count + most - 1) / most);
    while (std::gcd(stride, size_t{layout.across}) != 1) {
        ++stride;
    }
    for (size_t p = 0; p < count; p += stride) {
        chosen[p] = 1;
    }
    for (const size_t corner : {size_t{0}, size_t{layout.across} - 1, count - layout.across, count - 1}) {
        chosen[corner] = 1;
    }
    return chosen;
}

// A point on a border may fall into either cell, so each cell's depth only has bounds. The class check
// afterwards uses the device's own cells.
std::string cellsDiffer(const reference::FrameView& view, const reference::CellImage& cells) {
    const reference::CellBounds twin = reference::occlusion(view, kSamePixel);
    for (size_t i = 0; i < twin.sure.nearest.size(); ++i) {
        const double z = i < cells.nearest.size() ? cells.nearest[i] : 0.0;
        if (!(z >= twin.possible.nearest[i] - kSameDepth && z <= twin.sure.nearest[i] + kSameDepth)) {
            return "occlusion cell " + std::to_string(i);
        }
    }
    return "";
}

} // namespace

std::string FrameBench::differsFromTwins(const SampleFrame& image, size_t mostPatches) const {
    const reference::FrameView view(scene_, camera_, image.baseTcamera, image.depth, image.colour);
    std::vector<uint32_t> looked = masks();
    std::optional<reference::CellImage> cells;
    if (plan_.occlusion) {
        cells = verify::cellsOf(device_, *cycle_);
        const std::string wrong = cellsDiffer(view, *cells);
        if (!wrong.empty()) {
            return wrong;
        }
    }
    reference::ClassImage classes = reference::classify(view, cells ? &*cells : nullptr);
    if (plan_.selfFilter) {
        reference::removeArm(view, arm_.spheres, classes);
    }
    for (size_t i = 0; i < looked.size(); ++i) {
        if (looked[i] != classes.masks[i] && classes.unsure[i] == 0) {
            return "class bits of pixel " + std::to_string(i);
        }
    }
    const std::vector<uint8_t> sample = samplePatches(cycle_->layout(), mostPatches);
    const uint32_t width = camera_.depth.width;
    const auto sampled = [&](size_t i) {
        return sample[i / width / 16 * cycle_->layout().across + i % width / 16] != 0;
    };
    for (size_t i = 0; i < looked.size(); ++i) {
        looked[i] = sampled(i) ? looked[i] : 0; // the twin skips other pixels
    }
    const reference::SurfaceImage twin = reference::surface(view, looked);
    const reference::PointImage mine = points();
    for (size_t i = 0; i < looked.size(); ++i) {
        const bool same = (mine.z[i] == 0.0) == (twin.points.z[i] == 0.0) &&
                          glm::length(mine.at[i] - twin.points.at[i]) <= kSamePoint;
        if (sampled(i) && !same && twin.unsure[i] == 0) {
            return "point of pixel " + std::to_string(i);
        }
    }
    return "";
}

std::string FrameBench::spheresDiffer() const {
    const RegionSpheres& spheres = set().host.spheres;
    const std::vector<uint32_t> bits = masks();
    const reference::PointImage mine = points();
    std::vector<uint8_t> taken(bits.size(), 0);
    for (size_t i = 0; i < spheres.size(); ++i) {
        const uint32_t pixel = spheres.source[i];
        if (pixel >= bits.size()) {
            continue; // held from an earlier frame, no point in this one
        }
        const FixtureClass& f = scene_.fixtures[spheres.fixture[i]];
        const dvec3 centre = set().host.origin + dvec3(spheres.x[i], spheres.y[i], spheres.z[i]);
        const bool holds = mine.z[pixel] != 0.0 && bits[pixel] != 0 && f.role == Role::Forbidden &&
                           glm::length(centre - mine.at[pixel]) <= kSamePoint &&
                           spheres.radius[i] >= static_cast<float>(f.radius) * (1.0f - 1e-6f) &&
                           taken[pixel] == 0;
        if (!holds) {
            return "region sphere " + std::to_string(i);
        }
        taken[pixel] = 1;
    }
    return "";
}

std::string FrameBench::guidanceDiffers() const {
    const std::vector<uint32_t> fixtures = cloud::classFixtures(scene_), bits = masks();
    const reference::PointImage all = points();
    const int width = static_cast<int>(camera_.depth.width), height = static_cast<int>(camera_.depth.height);
    for (const GuidancePose& here : set().host.guidance) {
        const FixtureClass& f = scene_.fixtures[here.fixture];
        const auto c =
            static_cast<size_t>(std::find(fixtures.begin(), fixtures.end(), here.fixture) - fixtures.begin());
        std::vector<uint32_t> own = bits;
        if (f.largestPart) {
            const auto part = reference::largestPart(width, height, bits, all, c, scene_.filter.edge);
            std::transform(part.begin(), part.end(), own.begin(), [&](uint8_t in) { return in * (1u << c); });
        }
        const auto chosen = reference::trimmed(reference::pointsOfClass(own, all, c), f.trim);
        const GuidancePose there = reference::guidance(chosen, f, set().host.baseTcamera.position);
        if (here.count != there.count || !(glm::distance(here.position, there.position) <= kSamePoint)) {
            return "guidance of '" + f.name + "'";
        }
    }
    return "";
}

} // namespace fathom::profile
