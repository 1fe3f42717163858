// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/nearest.h"

#include "apps/output/image_view.h"
#include "apps/output/silhouette.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace fathom::operate {

namespace {

constexpr size_t kGroup = 8; // spheres of the tool that are tested together first; neighbours in order

// Centre and radius [m] around all spheres.
Sphere around(std::span<const Sphere> spheres) {
    Sphere all{dvec3(0.0), 0.0};
    for (const Sphere& s : spheres) {
        all.centre += s.centre / static_cast<double>(spheres.size());
    }
    for (const Sphere& s : spheres) {
        all.radius = std::max(all.radius, glm::distance(all.centre, s.centre) + s.radius);
    }
    return all;
}

constexpr size_t kBlock = 16; // region spheres that are tested together first; neighbours in order

std::vector<Sphere> blocksOf(const HostFixtures& set) {
    std::vector<Sphere> blocks, members;
    for (size_t first = 0; first < set.spheres.size(); first += kBlock) {
        members.clear();
        for (size_t i = first; i < std::min(set.spheres.size(), first + kBlock); ++i) {
            members.push_back({regionCentre(set, i), double{set.spheres.radius[i]}});
        }
        blocks.push_back(around(members));
    }
    return blocks;
}

double gapBetween(const Sphere& a, const Sphere& b) {
    return glm::distance(a.centre, b.centre) - a.radius - b.radius;
}

} // namespace

std::optional<Nearest> nearestRegion(const HostFixtures& set, std::span<const Sphere> tool) {
    const size_t count = set.spheres.size();
    if (count == 0 || tool.empty()) {
        return std::nullopt;
    }
    size_t region = 0;
    const Sphere* leaf = &tool.front();
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Sphere> blocks = blocksOf(set);
    for (size_t first = 0; first < tool.size(); first += kGroup) {
        const auto group = tool.subspan(first, std::min(kGroup, tool.size() - first));
        const Sphere all = around(group);
        for (size_t block = 0; block < blocks.size(); ++block) {
            if (gapBetween(blocks[block], all) >= least) {
                continue; // none of the group is nearer to any of the block
            }
            for (size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
                const Sphere sphere{regionCentre(set, i), double{set.spheres.radius[i]}};
                for (const Sphere& s : group) {
                    if (const double gap = gapBetween(sphere, s); gap < least) {
                        least = gap;
                        region = i;
                        leaf = &s;
                    }
                }
            }
        }
    }
    const dvec3 centre = regionCentre(set, region), between = centre - leaf->centre;
    const double length = glm::length(between);
    const dvec3 along = length > 0.0 ? between / length : dvec3(0.0, 0.0, 1.0);
    return Nearest{leaf->centre + leaf->radius * along, centre - double{set.spheres.radius[region]} * along,
                   least, set.spheres.fixture[region]};
}

double surfaceAt(const HostFixtures& set, double u, double v) {
    const Intrinsics& lens = set.camera.depth;
    if (!(u >= 0.0) || !(v >= 0.0) || u >= lens.width || v >= lens.height ||
        set.depth.size() != lens.pixels()) {
        return 0.0;
    }
    return set.depth[static_cast<size_t>(v) * lens.width + static_cast<size_t>(u)] * set.camera.metresPerUnit;
}

std::vector<Sphere> shadowOf(const HostFixtures& set, std::span<const Sphere> tool) {
    constexpr size_t kMax = 64;                                // spheres
    constexpr double kStep = 0.01, kFarthest = 0.8;            // [m] along the light
    const dvec3 light = glm::normalize(dvec3(0.35, 0.5, 1.0)); // camera axes
    const ImageView depth{set.camera.depth, inverse(set.baseTcamera), 1};
    std::vector<Sphere> shadow;
    const size_t step = tool.size() / kMax + 1;
    for (size_t i = 0; i < tool.size(); i += step) {
        const dvec3 from = depth.cameraTbase.apply(tool[i].centre);
        for (double s = 0.0; s < kFarthest; s += kStep) {
            const dvec3 at = from + s * light;
            const auto pixel = depth.ofCamera(at);
            const double z = pixel ? surfaceAt(set, pixel->x, pixel->y) : 0.0;
            if (z > 0.0 && at.z >= z) {
                const bool behind = s == 0.0 && at.z > z + tool[i].radius; // hidden: its shadow is, too
                if (!behind) {
                    shadow.push_back({set.baseTcamera.apply(at), tool[i].radius});
                }
                break;
            }
        }
    }
    return shadow;
}

} // namespace fathom::operate
