// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/guidance_points.h"
#include "engine/cloud/guidance_pose.h"

#include <array>
#include <bit>
#include <glm/vec2.hpp>

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

// Of one sub-patch: 16 bits each, as the spheres pass writes them.
uint32_t forbiddenOf(glm::uvec2 bits) {
    return bits.x & 0xffff;
}
uint32_t spheresOf(glm::uvec2 bits, bool heldLayer) {
    return heldLayer ? bits.y : bits.x >> 16;
}

// Writes columns that are large enough already.
class SphereCollector {
public:
    SphereCollector(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout)
        : set_(set)
        , rows_(rows)
        , layout_(layout)
        , inPatch_(pixelsOfPatch(set.host.camera.depth.width))
        , width_(set.host.camera.depth.width)
        , pixels_(set.host.camera.depth.pixels()) {}

    // Seen or held points of one patch. Returns the classes that have a sphere there, as bits.
    uint32_t takeLayer(uint32_t patch, bool heldLayer, std::vector<uint32_t>& classSpheres) {
        const auto bits = set_.device.bits.as<glm::uvec2>();
        const auto spheres = (heldLayer ? set_.device.held : set_.device.spheres).as<glm::vec4>();
        const auto classes = set_.device.classes.as<uint32_t>();
        const uint32_t corner = (patch / layout_.across) * 16 * width_ + (patch % layout_.across) * 16;
        uint32_t present = 0;
        for (uint32_t sub = 0; sub < 16; ++sub) {
            for (uint32_t left = spheresOf(bits[patch * 16 + sub], heldLayer); left != 0; left &= left - 1) {
                const uint32_t inside = sub * 16 + static_cast<uint32_t>(std::countr_zero(left));
                const uint32_t slot = patch * 256 + inside, c = classes[slot] >> (heldLayer ? 8 : 0) & 255;
                put(spheres[slot], corner + inPatch_[inside] + (heldLayer ? pixels_ : 0), rows_[c]);
                ++classSpheres[c];
                present |= 1u << c;
            }
        }
        return present;
    }

private:
    void put(const glm::vec4& s, uint32_t source, uint32_t row) {
        RegionSpheres& out = set_.host.spheres;
        out.x[next_] = s.x, out.y[next_] = s.y, out.z[next_] = s.z;
        out.radius[next_] = s.w;
        out.source[next_] = source;
        out.fixture[next_] = static_cast<uint8_t>(row);
        ++next_;
    }

    FixtureSet& set_;
    const std::vector<uint32_t>& rows_;
    const PatchLayout& layout_;
    std::array<uint32_t, 256> inPatch_;
    uint32_t width_, pixels_;
    size_t next_ = 0;
};

size_t countSpheres(const FixtureSet& set, const PatchLayout& layout) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<glm::uvec2>();
    int count = 0;
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        for (uint32_t sub = patch * 16; listed[patch] != 0 && sub < patch * 16 + 16; ++sub) {
            count += std::popcount(spheresOf(bits[sub], false)) + std::popcount(spheresOf(bits[sub], true));
        }
    }
    return static_cast<size_t>(count);
}

// What the GPU query's answers are looked up in.
void takeKeys(FixtureSet& set, const PatchLayout& layout) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<glm::uvec2>();
    for (uint32_t half = 0; half < 2 * layout.patches(); ++half) {
        for (uint32_t sub = 0; listed[half / 2] != 0 && sub < 16; ++sub) {
            for (uint32_t left = spheresOf(bits[half / 2 * 16 + sub], half % 2 != 0); left != 0;
                 left &= left - 1) {
                set.keys.push_back(half * 256 + sub * 16 + static_cast<uint32_t>(std::countr_zero(left)));
            }
        }
    }
}

void takeSpheres(FixtureSet& set, const std::vector<uint32_t>& rows, const Plan& plan,
                 const PatchLayout& layout, FrameCounts& counts) {
    const auto listed = set.device.listed.as<uint32_t>();
    set.host.spheres.resize(countSpheres(set, layout));
    SphereCollector collector(set, rows, layout);
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        if (listed[patch] == 0) {
            continue;
        }
        uint32_t present = collector.takeLayer(patch, false, counts.classSpheres);
        present |= plan.hold ? collector.takeLayer(patch, true, counts.classSpheres) : 0;
        counts.patches += present != 0;
        for (uint32_t c = 0; c < rows.size(); ++c) {
            counts.classPatches[c] += present >> c & 1;
        }
    }
    counts.spheres = static_cast<uint32_t>(set.host.spheres.size());
    if (plan.query == Plan::Query::Gpu) {
        takeKeys(set, layout);
    }
}

// Sub-patch bits of listed patches to row-major bits of the picture, 16 of a patch's row at a time.
void takeForbiddenBits(FixtureSet& set, const PatchLayout& layout, FrameCounts& counts) {
    Fixtures& host = set.host;
    const uint32_t width = host.camera.depth.width, height = host.camera.depth.height;
    host.forbiddenBits.assign((static_cast<size_t>(width) * height + 31) / 32, 0);
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<glm::uvec2>();
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        for (uint32_t row = 0; listed[patch] != 0 && row < 16; ++row) {
            uint32_t word = 0;
            for (uint32_t k = 0; k < 4; ++k) {
                const uint32_t sub = forbiddenOf(bits[patch * 16 + row / 4 * 4 + k]);
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
