// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/guidance_points.h"
#include "engine/cloud/guidance_pose.h"

#include <bit>

namespace fathom::cloud {

namespace {

// Slot within a patch of the pixel at (x, y) of the patch; the order in which spheres are collected is by
// pixel.
uint32_t pixelInPatch(uint32_t slot) {
    const uint32_t sub = slot >> 4 & 15, p = slot & 15;
    return ((sub >> 2) * 4 + (p >> 2)) * 16 + (sub & 3) * 4 + (p & 3);
}

class SphereCollector {
public:
    SphereCollector(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout)
        : set_(set)
        , rows_(rows)
        , layout_(layout)
        , width_(set.host.camera.depth.width)
        , pixels_(set.host.camera.depth.pixels()) {}

    // Seen or held points of one patch. Returns the classes that have a sphere there, as bits.
    uint32_t takeLayer(uint32_t patch, bool heldLayer, std::vector<uint32_t>& classSpheres) {
        const auto spheres = (heldLayer ? set_.device.held : set_.device.spheres).as<glm::vec4>();
        const auto classes = set_.device.classes.as<uint32_t>();
        uint32_t present = 0;
        for (uint32_t slot = patch * 256; slot < patch * 256 + 256; ++slot) {
            if (spheres[slot].w < 0.0f) {
                continue;
            }
            const uint32_t c = classes[slot] >> (heldLayer ? 8 : 0) & 255;
            set_.keys.push_back(patch * 512 + (heldLayer ? 256 : 0) + (slot & 255));
            add(spheres[slot], sourceOf(patch, slot) + (heldLayer ? pixels_ : 0), rows_[c]);
            ++classSpheres[c];
            present |= 1u << c;
        }
        return present;
    }

private:
    uint32_t sourceOf(uint32_t patch, uint32_t slot) const {
        const uint32_t inside = pixelInPatch(slot);
        return ((patch / layout_.across) * 16 + inside / 16) * width_ + (patch % layout_.across) * 16 +
               inside % 16;
    }

    void add(const glm::vec4& s, uint32_t source, uint32_t row) {
        RegionSpheres& out = set_.host.spheres;
        out.x.push_back(s.x), out.y.push_back(s.y), out.z.push_back(s.z);
        out.radius.push_back(s.w);
        out.source.push_back(source);
        out.fixture.push_back(static_cast<uint8_t>(row));
    }

    FixtureSet& set_;
    const std::vector<uint32_t>& rows_;
    const PatchLayout& layout_;
    uint32_t width_, pixels_;
};

void takeSpheres(FixtureSet& set, const std::vector<uint32_t>& rows, const Plan& plan,
                 const PatchLayout& layout, FrameCounts& counts) {
    const auto listed = set.device.listed.as<uint32_t>();
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
}

// Sub-patch bits of listed patches to row-major bits of the picture.
void takeForbiddenBits(FixtureSet& set, const PatchLayout& layout, FrameCounts& counts) {
    Fixtures& host = set.host;
    const uint32_t width = host.camera.depth.width, height = host.camera.depth.height;
    host.forbiddenBits.assign((static_cast<size_t>(width) * height + 31) / 32, 0);
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<uint32_t>();
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        for (uint32_t sub = 0; listed[patch] != 0 && sub < 16; ++sub) {
            counts.forbidden += static_cast<uint32_t>(std::popcount(bits[patch * 16 + sub]));
            for (uint32_t word = bits[patch * 16 + sub]; word != 0; word &= word - 1) {
                const uint32_t p = static_cast<uint32_t>(std::countr_zero(word));
                const uint32_t u = (patch % layout.across) * 16 + (sub & 3) * 4 + (p & 3);
                const uint32_t v = (patch / layout.across) * 16 + (sub >> 2) * 4 + (p >> 2);
                const uint32_t pixel = v * width + u;
                host.forbiddenBits[pixel / 32] |= 1u << pixel % 32;
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

// Depth readings in near..far. Counted here: a counter that 300 000 invocations share costs the device
// milliseconds.
uint32_t validPixels(const Fixtures& host, const Scene& scene) {
    const auto [lo, hi] = depthBand(scene, host.camera.metresPerUnit);
    uint32_t count = 0;
    for (uint16_t raw : host.depth) {
        count += raw >= lo && raw <= hi ? 1u : 0u;
    }
    return count;
}

} // namespace

FrameCounts collect(FixtureSet& set, const Scene& scene, const Plan& plan, const PatchLayout& layout) {
    const std::vector<uint32_t> rows = classRows(scene);
    FrameCounts counts;
    counts.valid = validPixels(set.host, scene);
    counts.classPixels.resize(rows.size());
    counts.classSpheres.resize(rows.size());
    counts.classPatches.resize(rows.size());
    set.host.spheres.resize(0);
    set.keys.clear();
    set.host.guidance.clear();
    set.host.forbiddenBits.clear();
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
