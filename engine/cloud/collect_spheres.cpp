// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect_spheres.h"

#include "engine/contact/clones.h"
#include "engine/types/crew.h"

#include <algorithm>
#include <utility>

namespace fathom::cloud {

namespace {

constexpr uint32_t kLeastPart = 4096; // spheres
constexpr size_t kLeastPatches = 64;  // that are counted in one go

// Tags as spheres.comp packs them: (layer * 256 + slot in the patch) * 8 + class of points.
constexpr uint32_t kClassMask = 7, kClassBits = 3;
static_assert(shared::kMaxClasses <= kClassMask + 1);

uint32_t tagOf(uint32_t place, uint32_t pointClass) {
    return place << kClassBits | (pointClass & kClassMask);
}

FATHOM_CLONES void toColumns(const glm::vec4* spheres, size_t n, float* __restrict x, float* __restrict y,
                             float* __restrict z, float* __restrict radius) noexcept {
    for (size_t i = 0; i < n; ++i) {
        x[i] = spheres[i].x, y[i] = spheres[i].y, z[i] = spheres[i].z, radius[i] = spheres[i].w;
    }
}

// Pixels, row-major in the picture, of a patch whose first is `corner`; held points count on from the last
// pixel. The order in which spheres are collected is by pixel.
FATHOM_CLONES void toSources(const uint32_t* tags, size_t n, uint32_t corner, uint32_t width, uint32_t pixels,
                             uint32_t* __restrict source) noexcept {
    for (size_t i = 0; i < n; ++i) {
        const uint32_t place = tags[i] >> kClassBits;
        const uint32_t row = (place >> 6 & 3) * 4 + (place >> 2 & 3);
        const uint32_t column = (place >> 4 & 3) * 4 + (place & 3);
        source[i] = corner + row * width + column + (place >> 8) * pixels;
    }
}

FATHOM_CLONES uint32_t countClass(const uint32_t* tags, size_t n, uint32_t pointClass) noexcept {
    uint32_t count = 0;
    for (size_t i = 0; i < n; ++i) {
        count += static_cast<uint32_t>((tags[i] & kClassMask) == pointClass);
    }
    return count;
}

} // namespace

// Writes the host's columns, which are large enough already, in order of patches.
class SphereColumns {
public:
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout)
        : set_(set)
        , across_(layout.across)
        , width_(set.host.camera.depth.width)
        , pixels_(static_cast<uint32_t>(set.host.camera.depth.pixels())) {
        std::ranges::transform(rows, rows_.begin(), [](uint32_t row) { return static_cast<uint8_t>(row); });
    }

    // All n > 0 spheres of a patch, from the columns' place `first` on.
    void put(uint32_t patch, size_t first, uint32_t n, const glm::vec4* spheres, const uint32_t* tags) {
        RegionSpheres& out = set_.host.spheres;
        toColumns(spheres, n, &out.x[first], &out.y[first], &out.z[first], &out.radius[first]);
        const uint32_t corner = (patch / across_ * width_ + patch % across_) * 16;
        toSources(tags, n, corner, width_, pixels_, &out.source[first]);
        putClasses(&out.fixture[first], n, tags);
        for (uint32_t i = 0; i < n && !set_.keys.empty(); ++i) {
            set_.keys[first + i] = patch * 512 + (tags[i] >> kClassBits);
        }
    }

    const SphereCounts& counts() const { return counts_; }

private:
    void putClasses(uint8_t* fixture, uint32_t n, const uint32_t* tags) {
        counts_.all += n;
        ++counts_.patches;
        uint32_t classes = 0, left = n;
        for (uint32_t c = 0; left > 0 && c < shared::kMaxClasses; ++c) {
            const uint32_t here = countClass(tags, n, c);
            counts_.ofClass[c] += here;
            counts_.patchesOfClass[c] += here != 0;
            classes += here != 0;
            left -= here;
        }
        if (classes == 1) { // as in most patches
            std::fill_n(fixture, n, rows_[tags[0] & kClassMask]);
            return;
        }
        const std::array rows = rows_; // a byte that is written might be any of the members otherwise
        for (uint32_t i = 0; i < n; ++i) {
            fixture[i] = rows[tags[i] & kClassMask];
        }
    }

    FixtureSet& set_;
    SphereCounts counts_;
    uint32_t across_, width_, pixels_;
    std::array<uint8_t, shared::kMaxClasses> rows_{}; // of the scene's fixtures, for each class
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
            columns.put(patch, begins_[patch], n, &packed[runs[patch].x], &tags[runs[patch].x]);
        }
    }
}

// Of patches [first, end): what a device of its own would have packed.
void SphereCollector::takeSlots(uint32_t first, uint32_t end, SphereColumns& columns) const noexcept {
    const std::array<std::span<const glm::vec4>, 2> points{work_.points.as<glm::vec4>(),
                                                           work_.kept.as<glm::vec4>()};
    const std::array<std::span<const float>, 2> radii{work_.radii.as<float>(), work_.heldRadii.as<float>()};
    const auto classes = work_.classes.as<uint8_t>();
    std::array<glm::vec4, 513> spheres; // of a patch, and a place that is written beyond them
    std::array<uint32_t, 513> tags;
    for (uint32_t patch = first; patch < end; ++patch) {
        uint32_t n = 0;
        const uint32_t layers = begins_[patch + 1] == begins_[patch] ? 0 : (plan_.hold ? 2 : 1);
        for (uint32_t layer = 0; layer < layers; ++layer) {
            for (uint32_t slot = 0; slot < 256; ++slot) {
                const size_t at = size_t{patch} * 256 + slot;
                const float radius = radii[layer][at];
                spheres[n] = glm::vec4(glm::vec3(points[layer][at]), radius);
                tags[n] = tagOf(layer * 256 + slot, classes[at] >> (4 * layer) & 15u);
                n += radius >= 0.0f ? 1u : 0u;
            }
        }
        if (n > 0) {
            columns.put(patch, begins_[patch], n, spheres.data(), tags.data());
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
