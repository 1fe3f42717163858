// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/guidance_points.h"
#include "engine/cloud/guidance_pose.h"
#include "engine/contact/clones.h"
#include "engine/types/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <exception>

namespace fathom::cloud {

namespace {

constexpr size_t kMinReadings = 16384; // readings per part

// Converts four adjacent sub-patches sub[0..3] to four rows of 16 pixel bits, row k from bit 16 k on:
// transposes 4x4 nibbles.
uint64_t rowsOfSubs(const uint32_t* sub) {
    uint64_t n = 0;
    for (uint32_t k = 0; k < 4; ++k) {
        n |= uint64_t{sub[k] & 0xffff} << 16 * k;
    }
    const uint64_t near = (n ^ n >> 12) & 0x0000f0f00000f0f0; // nibbles of 2x2 blocks
    n ^= near ^ near << 12;
    const uint64_t far = (n ^ n >> 24) & 0x00000000ff00ff00; // the 2x2 blocks
    return n ^ far ^ far << 24;
}

// Converts the sub-patch bits of a row of patches to row-major bits of the image. Returns the number of set
// bits.
uint32_t takeBitsOfRow(FixtureSet& set, uint32_t down, const PatchLayout& layout) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto bits = set.device.bits.as<uint32_t>();
    uint32_t *const out = set.host.forbiddenBits.data(), count = 0;
    for (uint32_t across = 0; across < layout.across; ++across) {
        const uint32_t patch = down * layout.across + across;
        for (uint32_t four = 0; listed[patch] != 0 && four < 4; ++four) {
            uint64_t rows = rowsOfSubs(&bits[patch * 16 + four * 4]);
            count += static_cast<uint32_t>(std::popcount(rows));
            uint32_t pixel = (down * 16 + four * 4) * set.host.camera.depth.width + across * 16;
            for (; rows != 0; rows >>= 16, pixel += set.host.camera.depth.width) { // no bits below the image
                const uint64_t placed = (rows & 0xffff) << pixel % 32;
                out[pixel / 32] |= static_cast<uint32_t>(placed);
                if (placed >> 32 != 0) {
                    out[pixel / 32 + 1] |= static_cast<uint32_t>(placed >> 32);
                }
            }
        }
    }
    return count;
}

// Handles two rows of patches, or the last one: 32 rows of pixels end at a word boundary for any image width.
uint32_t takeBitsOfPair(FixtureSet& set, uint32_t pair, const PatchLayout& layout) {
    return takeBitsOfRow(set, 2 * pair, layout) +
           (2 * pair + 1 < layout.down ? takeBitsOfRow(set, 2 * pair + 1, layout) : 0);
}

FATHOM_CLONES uint32_t countWithin(const uint16_t* raw, size_t n, uint16_t least, uint16_t most) noexcept {
    uint32_t count = 0;
    for (size_t i = 0; i < n; ++i) {
        count += static_cast<uint32_t>((raw[i] >= least) & (raw[i] <= most));
    }
    return count;
}

Moments classMoments(const FixtureSet& set, uint32_t k, const PatchLayout& layout) {
    const auto listed = set.device.listed.as<uint32_t>();
    const auto all = set.device.moments.as<shared::PatchMoments>();
    std::vector<Moments> parts;
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        const shared::PatchMoments& m = all[patch * shared::kMaxClasses + k];
        if ((listed[patch] & shared::kPatchGuided) != 0 && m.anchor.w > 0.0f) {
            parts.push_back({m.anchor.w,
                             dvec3(m.anchor) + dvec3(m.offset),
                             {m.first.x, m.first.y, m.first.z, m.first.w, m.second.x, m.second.y}});
        }
    }
    return mergeAll(std::move(parts));
}

void takeGuidance(FixtureSet& set, const Scene& scene, const std::vector<uint32_t>& fixtures,
                  const PatchLayout& layout) {
    uint32_t k = 0;
    for (uint32_t c = 0; c < fixtures.size(); ++c) {
        const FixtureClass& fixture = scene.fixtures[fixtures[c]];
        if (fixture.role != Role::Guidance) {
            continue;
        }
        const bool chosen = fixture.largestPart || fixture.trim > 0.0;
        size_t untrimmed = 0;
        Moments m = chosen ? chosenMoments(set, c, fixture, scene.filter.edge, layout, untrimmed)
                           : classMoments(set, k, layout);
        m.mean += set.host.origin;
        GuidancePose pose = guidancePose(m, fixture, fixtures[c], set.host.baseTcamera.position);
        pose.present = pose.present || (pose.count > 0 && untrimmed >= fixture.minCount);
        set.host.guidance.push_back(pose);
        ++k;
    }
}

} // namespace

uint32_t copyDepth(HostFixtures& host, std::span<const uint16_t> depth, const Scene& scene,
                   ThreadPool* workers) {
    const auto [lo, hi] = depthBand(scene, host.camera.metresPerUnit);
    // lo > hi: no depth value is in near..far, so the band 1..0 counts nothing.
    const auto least = static_cast<uint16_t>(lo <= hi ? lo : 1),
               most = static_cast<uint16_t>(lo <= hi ? hi : 0);
    host.depth.resize(depth.size());
    std::atomic<uint32_t> valid{0};
    inParts(workers, depth.size(), kMinReadings, [&](size_t begin, size_t end) {
        std::copy_n(&depth[begin], end - begin, &host.depth[begin]);
        valid += countWithin(&host.depth[begin], end - begin, least, most);
    });
    return valid;
}

namespace {

FrameCounts countsOf(const shared::FrameCounters& c, size_t classes) {
    FrameCounts counts;
    counts.classSpheres.resize(classes);
    counts.classPatches.resize(classes);
    for (size_t i = 0; i < classes; ++i) {
        counts.classPixels.push_back(c.classPixels[i]);
        counts.leakSpacing.push_back(std::bit_cast<float>(c.leakSpacing[i]));
        counts.leakRange.push_back(std::bit_cast<float>(c.leakRange[i]));
    }
    return counts;
}

// Runs the work for forbidden classes and guidance on all workers. Guidance comes first because it may take
// longest.
void collectSpheres(FixtureSet& set, const Scene& scene, const SphereSource& from,
                    const std::vector<uint32_t>& fixtures, ThreadPool& workers, FrameCounts& counts) {
    const PatchLayout& layout = from.layout;
    set.host.forbiddenBits.assign((set.host.camera.depth.pixels() + 31) / 32, 0);
    SphereCollector spheres(set, from, fixtures, workers);
    const uint32_t guidance = from.plan.moments ? 1 : 0, pairs = (layout.down + 1) / 2,
                   runs = (pairs + 3) / 4;
    std::atomic<uint32_t> forbidden{0};
    std::exception_ptr failed; // from the one part that allocates: a job must not throw
    workers.run(guidance + spheres.parts() + runs, [&](uint32_t part) {
        if (part < guidance) {
            try {
                takeGuidance(set, scene, fixtures, layout);
            } catch (...) {
                failed = std::current_exception();
            }
        } else if (part < guidance + spheres.parts()) {
            spheres.take(part - guidance);
        } else {
            const uint32_t first = (part - guidance - spheres.parts()) * 4;
            for (uint32_t pair = first; pair < std::min(first + 4, pairs); ++pair) {
                forbidden += takeBitsOfPair(set, pair, layout);
            }
        }
    });
    if (failed) {
        std::rethrow_exception(failed);
    }
    const SphereCounts all = spheres.counts();
    counts.spheres = all.all;
    counts.patches = all.patches;
    counts.nodes += spheres.nodesAbove();
    counts.forbidden = forbidden;
    std::copy_n(all.ofClass.begin(), fixtures.size(), counts.classSpheres.begin());
    std::copy_n(all.patchesOfClass.begin(), fixtures.size(), counts.classPatches.begin());
}

} // namespace

FrameCounts collect(FixtureSet& set, const Scene& scene, const SphereSource& from, ThreadPool& workers) {
    const std::vector<uint32_t> fixtures = classFixtures(scene);
    set.host.guidance.clear();
    set.host.forbiddenBits.clear();
    if (!from.plan.spheres) {
        set.host.spheres.resize(0);
    }
    const shared::FrameCounters& c = set.device.counters.as<shared::FrameCounters>()[0];
    FrameCounts counts = countsOf(c, fixtures.size());
    counts.nodes = c.subs;
    if (from.plan.spheres) {
        collectSpheres(set, scene, from, fixtures, workers, counts);
    } else {
        takeGuidance(set, scene, fixtures, from.layout);
    }
    return counts;
}

} // namespace fathom::cloud
