// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/guidance_points.h"
#include "engine/cloud/guidance_pose.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fathom::cloud {

namespace {

// Pixel, row-major in the picture, of each slot of the patch in the top left corner. The order in which
// spheres are collected is by pixel.
std::array<uint32_t, 256> pixelsOfPatch(uint32_t width) {
    std::array<uint32_t, 256> pixels;
    for (uint32_t slot = 0; slot < 256; ++slot) {
        const uint32_t sub = slot >> 4, p = slot & 15;
        pixels[slot] = ((sub >> 2) * 4 + (p >> 2)) * width + (sub & 3) * 4 + (p & 3);
    }
    return pixels;
}

// Counts what one patch has of each class.
class PatchTally {
public:
    explicit PatchTally(FrameCounts& counts)
        : counts_(counts) {}
    void add(uint32_t patch, uint32_t c) {
        if (patch != patch_) {
            finish();
            patch_ = patch;
        }
        ++counts_.classSpheres[c];
        present_ |= 1u << c;
    }
    void finish() {
        counts_.patches += present_ != 0;
        for (; present_ != 0; present_ &= present_ - 1) {
            ++counts_.classPatches[static_cast<size_t>(std::countr_zero(present_))];
        }
    }

private:
    FrameCounts& counts_;
    uint32_t patch_ = ~0u, present_ = 0;
};

void takeSpheres(FixtureSet& set, const std::vector<uint32_t>& rows, const Plan& plan,
                 const PatchLayout& layout, FrameCounts& counts) {
    const auto packed = set.device.packed.as<glm::vec4>();
    const auto tags = set.device.tags.as<uint32_t>();
    const uint32_t width = set.host.camera.depth.width, pixels = set.host.camera.depth.pixels();
    const std::array<uint32_t, 256> inPatch = pixelsOfPatch(width);
    RegionSpheres& out = set.host.spheres;
    out.resize(counts.spheres);
    PatchTally tally(counts);
    for (uint32_t i = 0; i < counts.spheres; ++i) {
        const uint32_t c = tags[i] & 7, key = tags[i] >> 3, patch = key >> 9;
        const uint32_t corner = (patch / layout.across * width + patch % layout.across) * 16;
        out.x[i] = packed[i].x, out.y[i] = packed[i].y, out.z[i] = packed[i].z;
        out.radius[i] = packed[i].w;
        out.source[i] = corner + inPatch[key & 255] + ((key & 256) != 0 ? pixels : 0);
        out.fixture[i] = static_cast<uint8_t>(rows[c]);
        tally.add(patch, c);
    }
    tally.finish();
    if (plan.query == Plan::Query::Gpu) { // its answers are looked up in them
        set.keys.resize(counts.spheres);
        std::transform(tags.begin(), tags.begin() + counts.spheres, set.keys.begin(),
                       [](uint32_t tag) { return tag >> 3; });
    }
}

// Sub-patch bits of listed patches to row-major bits of the picture, 16 of a patch's row at a time.
void takeForbiddenBits(FixtureSet& set, const PatchLayout& layout, FrameCounts& counts) {
    Fixtures& host = set.host;
    const uint32_t width = host.camera.depth.width, height = host.camera.depth.height;
    host.forbiddenBits.assign((static_cast<size_t>(width) * height + 31) / 32, 0);
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<uint32_t>();
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        for (uint32_t row = 0; listed[patch] != 0 && row < 16; ++row) {
            uint32_t word = 0;
            for (uint32_t k = 0; k < 4; ++k) {
                const uint32_t sub = bits[patch * 16 + row / 4 * 4 + k];
                word |= (sub >> (row % 4 * 4) & 15u) << (4 * k);
            }
            if (word == 0) {
                continue; // rows below the picture are
            }
            counts.forbidden += static_cast<uint32_t>(std::popcount(word));
            const uint32_t pixel =
                ((patch / layout.across) * 16 + row) * width + (patch % layout.across) * 16;
            const uint64_t placed = static_cast<uint64_t>(word) << pixel % 32;
            host.forbiddenBits[pixel / 32] |= static_cast<uint32_t>(placed);
            if (placed >> 32 != 0) {
                host.forbiddenBits[pixel / 32 + 1] |= static_cast<uint32_t>(placed >> 32);
            }
        }
    }
}

Moments classMoments(const FixtureSet& set, uint32_t k, const PatchLayout& layout) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto all = set.device.moments.as<shared::PatchMoments>();
    std::vector<Moments> parts;
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        const shared::PatchMoments& m = all[patch * shared::kMaxClasses + k];
        if (listed[patch] != 0 && m.anchor.w > 0.0f) {
            parts.push_back({m.anchor.w,
                             dvec3(m.anchor) + dvec3(m.offset),
                             {m.first.x, m.first.y, m.first.z, m.first.w, m.second.x, m.second.y}});
        }
    }
    return mergeAll(std::move(parts));
}

void takeGuidance(FixtureSet& set, const Scene& scene, const std::vector<uint32_t>& rows,
                  const PatchLayout& layout) {
    uint32_t k = 0;
    for (uint32_t c = 0; c < rows.size(); ++c) {
        const FixtureClass& fixture = scene.fixtures[rows[c]];
        if (fixture.role != Role::Guidance) {
            continue;
        }
        const bool chosen = fixture.largestPart || fixture.trim > 0.0;
        Moments m =
            chosen ? chosenMoments(set, c, fixture, scene.filter.edge, layout) : classMoments(set, k, layout);
        m.mean += set.host.origin;
        set.host.guidance.push_back(guidancePose(m, fixture, rows[c], set.host.baseTcamera.position));
        ++k;
    }
}

} // namespace

uint32_t validPixels(const Fixtures& host, const Scene& scene) {
    const auto [lo, hi] = depthBand(scene, host.camera.metresPerUnit);
    uint32_t count = 0;
    for (uint16_t raw : host.depth) {
        count += raw >= lo && raw <= hi ? 1u : 0u;
    }
    return count;
}

FrameCounts collect(FixtureSet& set, const Scene& scene, const Plan& plan, const PatchLayout& layout) {
    const std::vector<uint32_t> rows = classRows(scene);
    FrameCounts counts;
    counts.classPixels.resize(rows.size());
    counts.classSpheres.resize(rows.size());
    counts.classPatches.resize(rows.size());
    set.keys.clear();
    set.host.guidance.clear();
    set.host.forbiddenBits.clear();
    if (!plan.spheres) {
        set.host.spheres.resize(0);
    }
    if (!plan.cloud) {
        return counts;
    }
    const shared::FrameCounters& c = set.device.counters.as<shared::FrameCounters>()[0];
    counts.nodes = c.nodes;
    counts.spheres = plan.spheres ? c.spheres : 0;
    for (size_t i = 0; i < rows.size(); ++i) {
        counts.classPixels[i] = c.classPixels[i];
        counts.leakSpacing.push_back(std::bit_cast<float>(c.leakSpacing[i]));
        counts.leakRange.push_back(std::bit_cast<float>(c.leakRange[i]));
    }
    if (plan.spheres) {
        takeSpheres(set, rows, plan, layout, counts);
        takeForbiddenBits(set, layout, counts);
    }
    if (plan.moments) {
        takeGuidance(set, scene, rows, layout);
    }
    return counts;
}

} // namespace fathom::cloud
