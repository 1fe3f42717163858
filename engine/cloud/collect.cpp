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

// Writes the host's columns, which are large enough already, in order.
class SphereColumns {
public:
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout,
                  FrameCounts& counts)
        : set_(set)
        , rows_(rows)
        , across_(layout.across)
        , width_(set.host.camera.depth.width)
        , pixels_(set.host.camera.depth.pixels())
        , inPatch_(pixelsOfPatch(width_))
        , tally_(counts) {}

    // key: patch * 512 + layer * 256 + slot in the patch.
    void put(const glm::vec4& s, uint32_t key, uint32_t c) {
        RegionSpheres& out = set_.host.spheres;
        const uint32_t patch = key >> 9, corner = (patch / across_ * width_ + patch % across_) * 16;
        out.x[next_] = s.x, out.y[next_] = s.y, out.z[next_] = s.z;
        out.radius[next_] = s.w;
        out.source[next_] = corner + inPatch_[key & 255] + ((key & 256) != 0 ? pixels_ : 0);
        out.fixture[next_] = static_cast<uint8_t>(rows_[c]);
        if (!set_.keys.empty()) {
            set_.keys[next_] = key;
        }
        ++next_;
        tally_.add(patch, c);
    }
    void finish() { tally_.finish(); }

private:
    FixtureSet& set_;
    const std::vector<uint32_t>& rows_;
    uint32_t across_, width_, pixels_;
    std::array<uint32_t, 256> inPatch_;
    PatchTally tally_;
    size_t next_ = 0;
};

void makeRoom(FixtureSet& set, const Plan& plan, size_t spheres) {
    set.host.spheres.resize(spheres);
    set.keys.resize(plan.query == Plan::Query::Gpu ? spheres : 0);
}

void takePacked(const FixtureSet& set, uint32_t count, SphereColumns& columns) {
    const auto packed = set.device.packed.as<glm::vec4>();
    const auto tags = set.device.tags.as<uint32_t>();
    for (uint32_t i = 0; i < count; ++i) {
        columns.put(packed[i], tags[i] >> 3, tags[i] & 7);
    }
}

void takeSlots(const FixtureSet& set, const WorkBuffers& work, bool hold, const PatchLayout& layout,
               SphereColumns& columns) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto spheres = slotSpheres(work, set.device).as<glm::vec4>(),
               held = slotHeld(work, set.device).as<glm::vec4>();
    const auto classes = work.classes.as<uint32_t>();
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        for (uint32_t layer = 0; listed[patch] != 0 && layer < (hold ? 2u : 1u); ++layer) {
            const auto from = (layer == 0 ? spheres : held).subspan(patch * 256, 256);
            for (uint32_t slot = 0; slot < 256; ++slot) {
                if (from[slot].w >= 0.0f) {
                    columns.put(from[slot], patch * 512 + layer * 256 + slot,
                                classes[patch * 256 + slot] >> (8 * layer) & 255);
                }
            }
        }
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

FrameCounts collect(FixtureSet& set, const WorkBuffers& work, const Scene& scene, const Plan& plan,
                    const PatchLayout& layout) {
    const std::vector<uint32_t> rows = classRows(scene);
    FrameCounts counts;
    counts.classPixels.resize(rows.size());
    counts.classSpheres.resize(rows.size());
    counts.classPatches.resize(rows.size());
    set.host.guidance.clear();
    set.host.forbiddenBits.clear();
    if (!plan.spheres) {
        makeRoom(set, plan, 0);
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
        counts.spheres = c.spheres;
        makeRoom(set, plan, c.spheres);
        SphereColumns columns(set, rows, layout, counts);
        if (plan.pack) {
            takePacked(set, c.spheres, columns);
        } else {
            takeSlots(set, work, plan.hold, layout, columns);
        }
        columns.finish();
        takeForbiddenBits(set, layout, counts);
    }
    if (plan.moments) {
        takeGuidance(set, scene, rows, layout);
    }
    return counts;
}

} // namespace fathom::cloud
