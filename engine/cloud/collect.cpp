// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/collect.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/guidance_points.h"
#include "engine/cloud/guidance_pose.h"
#include "engine/types/crew.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fathom::cloud {

namespace {

constexpr uint32_t kLeastPart = 4096; // spheres

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

// One sphere of a patch: layer * 256 + slot, and its class.
struct Placed {
    glm::vec4 sphere;
    uint32_t place, fixture;
};

// Writes the host's columns, which are large enough already, in order of patches.
class SphereColumns {
public:
    // From sphere `first` on.
    SphereColumns(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout,
                  FrameCounts& counts, size_t first = 0)
        : set_(set)
        , counts_(counts)
        , across_(layout.across)
        , width_(set.host.camera.depth.width)
        , sources_(sourcesOfPatch(width_, static_cast<uint32_t>(set.host.camera.depth.pixels())))
        , next_(first) {
        std::copy(rows.begin(), rows.end(), rows_.begin());
    }

    // All n > 0 spheres of a patch; at(i) is the i-th, as Placed.
    template <class At>
    void put(uint32_t patch, uint32_t n, const At& at) {
        RegionSpheres& out = set_.host.spheres;
        // In variables of their own: a byte that is written might be any of them otherwise.
        float *const x = &out.x[next_], *const y = &out.y[next_], *const z = &out.z[next_],
                     *const radius = &out.radius[next_];
        uint32_t* const source = &out.source[next_];
        uint8_t* const fixture = &out.fixture[next_];
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
            set_.keys[next_ + i] = patch * 512 + at(i).place;
        }
        next_ += n;
        tally();
    }

private:
    void tally() {
        ++counts_.patches;
        for (size_t c = 0; c < counts_.classSpheres.size(); ++c) {
            counts_.classSpheres[c] += here_[c];
            counts_.classPatches[c] += here_[c] != 0;
        }
        here_.fill(0);
    }

    FixtureSet& set_;
    FrameCounts& counts_;
    uint32_t across_, width_;
    std::array<uint32_t, 512> sources_;
    std::array<uint32_t, shared::kMaxClasses> rows_{}, here_{}; // here_: spheres of each class in the patch
    size_t next_;
};

void makeRoom(FixtureSet& set, const Plan& plan, size_t spheres) {
    set.host.spheres.resize(spheres);
    set.keys.resize(plan.query == Plan::Query::Gpu ? spheres : 0);
}

// A tag is patch << 12 | layer << 11 | slot << 3 | class. Those of [first, last), whole patches.
void takePacked(const FixtureSet& set, uint32_t first, uint32_t last, SphereColumns& columns) {
    const auto packed = set.device.packed.as<glm::vec4>();
    const auto tags = set.device.tags.as<uint32_t>();
    for (uint32_t begin = first, end = first; begin < last; begin = end) {
        const uint32_t patch = tags[begin] >> 12;
        while (end < last && tags[end] >> 12 == patch) {
            ++end;
        }
        columns.put(patch, end - begin, [&](uint32_t i) {
            const uint32_t tag = tags[begin + i];
            return Placed{packed[begin + i], tag >> 3 & 511, tag & 7};
        });
    }
}

// The packed spheres in parts that begin and end with a patch.
void takePackedInParts(FixtureSet& set, const std::vector<uint32_t>& rows, const PatchLayout& layout,
                       Crew& crew, FrameCounts& counts) {
    const uint32_t count = counts.spheres;
    const auto tags = set.device.tags.as<uint32_t>();
    const auto patchStart = [&](uint32_t at) {
        while (at > 0 && at < count && tags[at] >> 12 == tags[at - 1] >> 12) {
            ++at;
        }
        return at;
    };
    const uint32_t parts = partsOf(&crew, count, kLeastPart);
    std::vector<FrameCounts> some(parts, counts);
    crew.run(parts, [&](uint32_t part) {
        const auto at = [&](uint64_t p) { return patchStart(static_cast<uint32_t>(count * p / parts)); };
        const uint32_t first = at(part), last = at(part + 1);
        SphereColumns columns(set, rows, layout, some[part], first);
        takePacked(set, first, last, columns);
    });
    for (const FrameCounts& part : some) {
        counts.patches += part.patches;
        for (size_t c = 0; c < counts.classSpheres.size(); ++c) {
            counts.classSpheres[c] += part.classSpheres[c], counts.classPatches[c] += part.classPatches[c];
        }
    }
}

void takeSlots(const FixtureSet& set, const WorkBuffers& work, bool hold, const PatchLayout& layout,
               SphereColumns& columns) {
    const auto listed = set.device.listed.as<uint32_t>();
    const std::array<std::span<const glm::vec4>, 2> layers{slotSpheres(work, set.device).as<glm::vec4>(),
                                                           slotHeld(work, set.device).as<glm::vec4>()};
    const auto classes = work.classes.as<uint8_t>();
    std::array<uint16_t, 512> places; // that hold a sphere
    for (uint32_t patch = 0; patch < layout.patches(); ++patch) {
        uint32_t n = 0;
        for (uint32_t place = 0; listed[patch] != 0 && place < (hold ? 512u : 256u); ++place) {
            places[n] = static_cast<uint16_t>(place);
            n += layers[place >> 8][patch * 256 + (place & 255)].w >= 0.0f ? 1u : 0u;
        }
        if (n > 0) {
            columns.put(patch, n, [&](uint32_t i) {
                const uint32_t layer = places[i] >> 8u, slot = patch * 256u + (places[i] & 255u);
                return Placed{layers[layer][slot], places[i], classes[slot] >> (4 * layer) & 15u};
            });
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
                    const PatchLayout& layout, Crew& crew) {
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
        if (plan.pack) {
            takePackedInParts(set, rows, layout, crew, counts);
        } else {
            SphereColumns columns(set, rows, layout, counts);
            takeSlots(set, work, plan.hold, layout, columns);
        }
        takeForbiddenBits(set, layout, counts);
    }
    if (plan.moments) {
        takeGuidance(set, scene, rows, layout);
    }
    return counts;
}

} // namespace fathom::cloud
