// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect_spheres.h"

#include "engine/cloud/sphere_run.h"
#include "engine/contact/clones.h"
#include "engine/types/thread_pool.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace fathom::cloud {

namespace {

constexpr uint32_t kMinPart = 4096; // spheres
constexpr size_t kMinPatches = 64;  // patches counted per part

// The device has just written the runs in any patch order, so their cache lines are cold and the processor
// cannot predict where the next run begins.
template <class T>
void bringNear(std::span<T> run) noexcept {
    constexpr size_t kLine = 64; // bytes
    for (size_t i = 0; i < run.size(); i += kLine / sizeof(T)) {
        __builtin_prefetch(&run[i]);
    }
}

// Bits of the slots with a sphere, of 32 radii; < 0 = none.
FATHOM_CLONES uint32_t bitsOfSpheres(const float* radii) noexcept {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 32; ++k) {
        bits |= static_cast<uint32_t>(radii[k] >= 0.0f) << k;
    }
    return bits;
}

void add(SphereCounts& to, const SphereCounts& more) {
    to.all += more.all;
    to.patches += more.patches;
    for (size_t c = 0; c < to.ofClass.size(); ++c) {
        to.ofClass[c] += more.ofClass[c];
        to.patchesOfClass[c] += more.patchesOfClass[c];
    }
}

} // namespace

SphereCollector::SphereCollector(FixtureSet& set, const SphereSource& from,
                                 const std::vector<uint32_t>& fixtures, ThreadPool& workers)
    : set_(set)
    , from_(from)
    , fixtures_(fixtures)
    , begins_(from.layout.patches() + 1) {
    const uint32_t count = placePatches(workers);
    set.host.spheres.resize(count);
    counts_.resize(partsOf(&workers, count, kMinPart));
}

uint32_t SphereCollector::placePatches(ThreadPool& workers) {
    inParts(&workers, from_.layout.patches(), kMinPatches, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch) {
            begins_[patch] = spheresOf(static_cast<uint32_t>(patch));
        }
    });
    uint32_t next = 0;
    for (uint32_t& begin : begins_) { // the last entry has no patch and count 0
        next += std::exchange(begin, next);
    }
    return next;
}

// Runs and radii of unlisted patches belong to earlier frames.
uint32_t SphereCollector::spheresOf(uint32_t patch) const noexcept {
    if (set_.device.listed.as<uint32_t>()[patch] == 0) {
        return 0;
    }
    if (from_.plan.pack) {
        return set_.device.runs.as<glm::uvec2>()[patch].y & 0xffff;
    }
    uint32_t n = 0;
    for (const gpu::Buffer* radii : {&from_.work.radii, &from_.work.heldRadii}) {
        const float* const r = *radii ? &radii->as<float>()[size_t{patch} * 256] : nullptr;
        for (uint32_t slot = 0; r != nullptr && slot < 256; slot += 32) {
            n += static_cast<uint32_t>(std::popcount(bitsOfSpheres(r + slot)));
        }
    }
    return n;
}

// Parts consist of whole patches and have about equally many spheres.
void SphereCollector::take(uint32_t part) noexcept {
    const auto patchAt = [&](uint64_t share) {
        const uint64_t sphere = begins_.back() * share / parts();
        return static_cast<uint32_t>(std::ranges::lower_bound(begins_, sphere) - begins_.begin());
    };
    SphereColumns columns(set_, fixtures_, from_.layout, from_.seen, from_.plan.hold);
    if (from_.plan.pack) {
        takePacked(patchAt(part), patchAt(part + 1), columns);
    } else {
        takeSlots(patchAt(part), patchAt(part + 1), columns);
    }
    counts_[part] = columns.counts();
}

SphereCounts SphereCollector::counts() const {
    SphereCounts all;
    for (const SphereCounts& part : counts_) {
        add(all, part);
    }
    return all;
}

// Takes patches [first, end).
void SphereCollector::takePacked(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept {
    const auto packed = set_.device.packed.as<uint32_t>();
    const auto places = set_.device.places.as<uint32_t>();
    const auto runs = set_.device.runs.as<glm::uvec2>();
    const uint8_t* const classes = from_.work.classes ? from_.work.classes.as<uint8_t>().data() : nullptr;
    const auto bring = [&](uint32_t patch) {
        const uint32_t n = patch < end ? begins_[patch + 1] - begins_[patch] : 0;
        if (n > 0) {
            const size_t words = from_.plan.packsDepths() ? n : 4 * n; // ignores the few held ones
            bringNear(packed.subspan(runs[patch].x, words));
            bringNear(places.subspan(size_t{patch} * 16, 8));
        }
    };
    SphereRun run(from_.plan.packsDepths());
    bring(first);
    for (uint32_t patch = first; patch < end; ++patch) {
        bring(patch + 1);
        const uint32_t n = begins_[patch + 1] - begins_[patch];
        if (n > 0) {
            PatchSpheres spheres =
                run.take(&packed[runs[patch].x], n, runs[patch].y >> 16, &places[size_t{patch} * 16]);
            spheres.classOf = classes != nullptr ? classes + size_t{patch} * 256 : nullptr;
            columns.put(patch, begins_[patch], spheres);
        }
    }
}

// Takes patches [first, end) when the plan does not pack.
void SphereCollector::takeSlots(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept {
    const std::array<std::span<const glm::vec4>, 2> points{from_.work.points.as<glm::vec4>(),
                                                           from_.work.kept.as<glm::vec4>()};
    const std::array<std::span<const float>, 2> radii{from_.work.radii.as<float>(),
                                                      from_.work.heldRadii.as<float>()};
    const auto classes = from_.work.classes.as<uint8_t>();
    std::array<glm::vec4, 512> spheres; // of one patch
    std::array<uint32_t, 16> places;
    for (uint32_t patch = first; patch < end; ++patch) {
        PatchSpheres s;
        uint32_t n = 0;
        const uint32_t layers = begins_[patch + 1] == begins_[patch] ? 0 : (from_.plan.hold ? 2 : 1);
        for (uint32_t word = 0; word < 8 * layers; ++word) {
            const uint32_t layer = word / 8;
            const size_t at = size_t{patch} * 256 + word % 8 * 32;
            places[word] = bitsOfSpheres(&radii[layer][at]);
            for (uint32_t bits = places[word]; bits != 0; bits &= bits - 1) {
                const size_t slot = at + static_cast<size_t>(std::countr_zero(bits));
                s.seen += layer == 0 ? 1 : 0;
                spheres[n++] = glm::vec4(glm::vec3(points[layer][slot]), radii[layer][slot]);
                s.classes |= 1u << (classes[slot] >> 4 * layer & 7u);
            }
        }
        if (n > 0) {
            s.held = n - s.seen;
            s.places = places.data();
            s.whole = spheres.data();
            s.classOf = &classes[size_t{patch} * 256];
            columns.put(patch, begins_[patch], s);
        }
    }
}

uint32_t SphereCollector::nodesAbove() const {
    std::vector<uint8_t> used(from_.layout.patches()), above;
    uint32_t nodes = 0;
    for (uint32_t patch = 0; patch < from_.layout.patches(); ++patch) {
        used[patch] = begins_[patch + 1] > begins_[patch];
        nodes += used[patch];
    }
    for (size_t l = 2; l < from_.layout.levels.size(); ++l) {
        const PatchLayout::Level &below = from_.layout.levels[l - 1], &here = from_.layout.levels[l];
        above.assign(size_t{here.across} * here.down, 0);
        for (uint32_t v = 0, i = 0; v < below.down; ++v) {
            for (uint32_t u = 0; u < below.across; ++u, ++i) {
                above[v / 4 * here.across + u / 4] |= used[i];
            }
        }
        nodes += static_cast<uint32_t>(std::ranges::count(above, 1));
        used.swap(above);
    }
    return nodes;
}

} // namespace fathom::cloud
