// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect_spheres.h"

#include "engine/types/crew.h"

#include <algorithm>
#include <utility>

namespace fathom::cloud {

namespace {

constexpr uint32_t kLeastPart = 4096; // spheres
constexpr size_t kLeastPatches = 64;  // that are counted in one go

// Pixel, row-major in the picture, of each slot of the patch in the top left corner; held points behind them,
// which count on from the last pixel. The order in which spheres are collected is by pixel.
std::array<uint32_t, 512> sourcesOfPatch(uint32_t width, uint32_t pixels) {
    std::array<uint32_t, 512> sources;
    for (uint32_t slot = 0; slot < 256; ++slot) {
        const uint32_t sub = slot >> 4, p = slot & 15;
        sources[slot] = ((sub >> 2) * 4 + (p >> 2)) * width + (sub & 3) * 4 + (p & 3);
        sources[256 + slot] = sources[slot] + pixels;
    }
    return sources;
}

} // namespace

// Writes the host's columns, which are large enough already, in order of patches.
class SphereColumns {
public:
    // One sphere of a patch: layer * 256 + slot, and its class.
    struct Placed {
        glm::vec4 sphere;
        uint32_t place, fixture;
    };

    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout)
        : set_(set)
        , across_(layout.across)
        , width_(set.host.camera.depth.width)
        , sources_(sourcesOfPatch(width_, static_cast<uint32_t>(set.host.camera.depth.pixels()))) {
        std::copy(rows.begin(), rows.end(), rows_.begin());
    }

    // All n > 0 spheres of a patch, from the columns' place `first` on; at(i) is the i-th, as Placed.
    template <class At>
    void put(uint32_t patch, size_t first, uint32_t n, const At& at) {
        RegionSpheres& out = set_.host.spheres;
        // In variables of their own: a byte that is written might be any of them otherwise.
        float *const x = &out.x[first], *const y = &out.y[first], *const z = &out.z[first],
                     *const radius = &out.radius[first];
        uint32_t* const source = &out.source[first];
        uint8_t* const fixture = &out.fixture[first];
        const uint32_t corner = (patch / across_ * width_ + patch % across_) * 16;
        uint32_t last = 0, from = 0; // a run of one class is counted at its end
        for (uint32_t i = 0; i < n; ++i) {
            const Placed p = at(i);
            x[i] = p.sphere.x, y[i] = p.sphere.y, z[i] = p.sphere.z, radius[i] = p.sphere.w;
            source[i] = corner + sources_[p.place];
            fixture[i] = static_cast<uint8_t>(rows_[p.fixture]);
            if (p.fixture != last) {
                here_[last] += i - from;
                last = p.fixture, from = i;
            }
        }
        here_[last] += n - from;
        for (uint32_t i = 0; i < n && !set_.keys.empty(); ++i) {
            set_.keys[first + i] = patch * 512 + at(i).place;
        }
        tally(n);
    }

    const SphereCounts& counts() const { return counts_; }

private:
    void tally(uint32_t n) {
        counts_.all += n;
        ++counts_.patches;
        for (size_t c = 0; c < here_.size(); ++c) {
            counts_.ofClass[c] += here_[c];
            counts_.patchesOfClass[c] += here_[c] != 0;
        }
        here_.fill(0);
    }

    FixtureSet& set_;
    SphereCounts counts_;
    uint32_t across_, width_;
    std::array<uint32_t, 512> sources_;
    std::array<uint32_t, shared::kMaxClasses> rows_{}, here_{}; // here_: spheres of each class in the patch
};

namespace {

// The device has just written them, patches in any order: none of a run's lines is near, and the processor
// cannot guess where the next run begins.
template <class T>
void bringNear(std::span<T> run) noexcept {
    constexpr size_t kLine = 64; // bytes
    for (size_t i = 0; i < run.size(); i += kLine / sizeof(T)) {
        __builtin_prefetch(&run[i]);
    }
}

// Which of a patch's 256 slots have a radius, as places from `first` on. Writes one place beyond them.
uint32_t placesOf(const float* radii, uint32_t first, uint16_t* places) {
    uint32_t n = 0;
    for (uint32_t slot = 0; slot < 256; ++slot) {
        places[n] = static_cast<uint16_t>(first + slot);
        n += radii[slot] >= 0.0f ? 1u : 0u;
    }
    return n;
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

SphereCollector::SphereCollector(FixtureSet& set, const WorkBuffers& work, const Plan& plan,
                                 const std::vector<uint32_t>& rows, const PatchLayout& layout, Crew& crew)
    : set_(set)
    , work_(work)
    , plan_(plan)
    , rows_(rows)
    , layout_(layout)
    , begins_(layout.patches() + 1) {
    const uint32_t count = placePatches(crew);
    set.host.spheres.resize(count);
    set.keys.resize(plan.query == Plan::Query::Gpu ? count : 0);
    counts_.resize(partsOf(&crew, count, kLeastPart));
}

uint32_t SphereCollector::placePatches(Crew& crew) {
    inParts(&crew, layout_.patches(), kLeastPatches, [&](size_t begin, size_t end) {
        for (size_t patch = begin; patch < end; ++patch) {
            begins_[patch] = spheresOf(static_cast<uint32_t>(patch));
        }
    });
    uint32_t next = 0;
    for (uint32_t& begin : begins_) { // the last is of no patch, and 0
        next += std::exchange(begin, next);
    }
    return next;
}

// Runs and radii of patches that are not listed are of earlier frames.
uint32_t SphereCollector::spheresOf(uint32_t patch) const noexcept {
    if (set_.device.listed.as<uint32_t>()[patch] == 0) {
        return 0;
    }
    if (plan_.pack) {
        return set_.device.runs.as<glm::uvec2>()[patch].y;
    }
    uint32_t n = 0;
    for (const gpu::Buffer* radii : {&work_.radii, &work_.heldRadii}) {
        const float* const r = *radii ? &radii->as<float>()[size_t{patch} * 256] : nullptr;
        for (uint32_t slot = 0; r != nullptr && slot < 256; ++slot) {
            n += r[slot] >= 0.0f ? 1u : 0u;
        }
    }
    return n;
}

// A part begins and ends with a patch, and all have about as many spheres.
void SphereCollector::take(uint32_t part) noexcept {
    const auto patchAt = [&](uint64_t share) {
        const uint64_t sphere = begins_.back() * share / parts();
        return static_cast<uint32_t>(std::ranges::lower_bound(begins_, sphere) - begins_.begin());
    };
    SphereColumns columns(set_, rows_, layout_);
    if (plan_.pack) {
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

// Of patches [first, end).
void SphereCollector::takePacked(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept {
    const auto packed = set_.device.packed.as<glm::vec4>();
    const auto tags = set_.device.tags.as<uint32_t>();
    const auto runs = set_.device.runs.as<glm::uvec2>();
    const auto bring = [&](uint32_t patch) {
        const uint32_t n = patch < end ? begins_[patch + 1] - begins_[patch] : 0;
        if (n > 0) {
            bringNear(packed.subspan(runs[patch].x, n));
            bringNear(tags.subspan(runs[patch].x, n));
        }
    };
    bring(first);
    for (uint32_t patch = first; patch < end; ++patch) {
        bring(patch + 1);
        const uint32_t n = begins_[patch + 1] - begins_[patch];
        if (n > 0) {
            const size_t from = runs[patch].x;
            columns.put(patch, begins_[patch], n, [&](uint32_t i) {
                const uint32_t tag = tags[from + i];
                return SphereColumns::Placed{packed[from + i], tag >> 3 & 511, tag & 7};
            });
        }
    }
}

// Of patches [first, end).
void SphereCollector::takeSlots(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept {
    const std::array<std::span<const glm::vec4>, 2> points{work_.points.as<glm::vec4>(),
                                                           work_.kept.as<glm::vec4>()};
    const std::array<std::span<const float>, 2> radii{work_.radii.as<float>(), work_.heldRadii.as<float>()};
    const auto classes = work_.classes.as<uint8_t>();
    std::array<uint16_t, 513> places; // that hold a sphere, and one more
    for (uint32_t patch = first; patch < end; ++patch) {
        uint32_t n = 0;
        for (uint32_t layer = 0; begins_[patch + 1] > begins_[patch] && layer < (plan_.hold ? 2u : 1u);
             ++layer) {
            n += placesOf(&radii[layer][patch * 256], layer * 256, &places[n]);
        }
        if (n > 0) {
            columns.put(patch, begins_[patch], n, [&](uint32_t i) {
                const uint32_t layer = places[i] >> 8u, slot = patch * 256u + (places[i] & 255u);
                return SphereColumns::Placed{glm::vec4(glm::vec3(points[layer][slot]), radii[layer][slot]),
                                             places[i], classes[slot] >> (4 * layer) & 15u};
            });
        }
    }
}

uint32_t SphereCollector::nodesAbove() const {
    std::vector<uint8_t> used(layout_.patches()), above;
    uint32_t nodes = 0;
    for (uint32_t patch = 0; patch < layout_.patches(); ++patch) {
        used[patch] = begins_[patch + 1] > begins_[patch];
        nodes += used[patch];
    }
    for (size_t l = 2; l < layout_.levels.size(); ++l) {
        const PatchLayout::Level &below = layout_.levels[l - 1], &here = layout_.levels[l];
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
