// SPDX-License-Identifier: Apache-2.0
// Half, single and double precision for the centres of region spheres, the data that is stored and scanned
// most.
#include "apps/profile/half_number.h"
#include "apps/profile/precision.h"
#include "engine/contact/clones.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <memory>

namespace fathom::profile {

namespace {

FATHOM_CLONES
float scanSingle(const float* __restrict x, const float* __restrict y, const float* __restrict z,
                 size_t count, float cx, float cy, float cz) noexcept {
    float least[16];
    std::fill_n(least, 16, 1e30f);
    for (size_t i = 0; i + 16 <= count; i += 16) {
        for (size_t k = 0; k < 16; ++k) {
            const float dx = x[i + k] - cx, dy = y[i + k] - cy, dz = z[i + k] - cz;
            const float d = dx * dx + dy * dy + dz * dz;
            least[k] = d < least[k] ? d : least[k];
        }
    }
    return *std::min_element(least, least + 16);
}

FATHOM_CLONES
double scanDouble(const double* __restrict x, const double* __restrict y, const double* __restrict z,
                  size_t count, double cx, double cy, double cz) noexcept {
    double least[16];
    std::fill_n(least, 16, 1e30);
    for (size_t i = 0; i + 16 <= count; i += 16) {
        for (size_t k = 0; k < 16; ++k) {
            const double dx = x[i + k] - cx, dy = y[i + k] - cy, dz = z[i + k] - cz;
            const double d = dx * dx + dy * dy + dz * dz;
            least[k] = d < least[k] ? d : least[k];
        }
    }
    return *std::min_element(least, least + 16);
}

} // namespace

float nearestSquared(const float* x, const float* y, const float* z, size_t count, float cx, float cy,
                     float cz) noexcept {
    return scanSingle(x, y, z, count, cx, cy, cz);
}

double nearestSquared(const double* x, const double* y, const double* z, size_t count, double cx, double cy,
                      double cz) noexcept {
    return scanDouble(x, y, z, count, cx, cy, cz);
}

namespace {

template <class T>
struct Columns {
    std::vector<T> x, y, z;
    void add(T px, T py, T pz) {
        x.push_back(px);
        y.push_back(py);
        z.push_back(pz);
    }
    size_t size() const { return x.size(); }
};

FATHOM_CLONES
float nearestHalf(const uint16_t* __restrict x, const uint16_t* __restrict y, const uint16_t* __restrict z,
                  size_t count, float cx, float cy, float cz) noexcept {
    float least[16];
    std::fill_n(least, 16, 1e30f);
    for (size_t i = 0; i + 16 <= count; i += 16) {
        for (size_t k = 0; k < 16; ++k) {
            const float dx = widened(x[i + k]) - cx, dy = widened(y[i + k]) - cy, dz = widened(z[i + k]) - cz;
            const float d = dx * dx + dy * dy + dz * dz;
            least[k] = d < least[k] ? d : least[k];
        }
    }
    return *std::min_element(least, least + 16);
}

struct FarCloud {
    Columns<double> exact;
    Columns<float> single;
    Columns<uint16_t> half, local;
    std::vector<dvec3> blocks; // centre of each block of 256 in `local`
    std::vector<dvec3> leaves;

    static constexpr size_t kBlock = 256; // pixels of a patch
    FarCloud(size_t spheres, size_t leafCount, double away) {
        const auto side = static_cast<size_t>(std::sqrt(static_cast<double>(spheres) / kBlock));
        for (size_t b = 0; b < side * side; ++b) {
            const size_t row = b / side;
            const dvec3 corner(0.027 * static_cast<double>(b % side), 0.027 * static_cast<double>(row), away);
            blocks.push_back(corner + dvec3(0.0128, 0.0128, 0.0));
            for (size_t k = 0; k < kBlock; ++k) {
                const size_t line = k / 16;
                const dvec3 p =
                    corner + dvec3(0.0016 * static_cast<double>(k % 16), 0.0016 * static_cast<double>(line),
                                   0.01 * std::sin(37.0 * static_cast<double>(b * kBlock + k)));
                const dvec3 d = p - blocks.back();
                exact.add(p.x, p.y, p.z);
                single.add(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
                half.add(halved(static_cast<float>(p.x)), halved(static_cast<float>(p.y)),
                         halved(static_cast<float>(p.z)));
                local.add(halved(static_cast<float>(d.x)), halved(static_cast<float>(d.y)),
                          halved(static_cast<float>(d.z)));
            }
        }
        for (size_t i = 0; i < leafCount; ++i) {
            const double t = static_cast<double>(i);
            leaves.push_back({0.2 + 0.1 * std::sin(1.7 * t), 0.2 + 0.1 * std::cos(2.3 * t),
                              away - 0.03 - 0.02 * std::sin(t)});
        }
    }
};

using Distances = std::vector<double>; // [m] one per leaf

Distances runDouble(const FarCloud& s) {
    Distances out;
    for (const dvec3& c : s.leaves) {
        out.push_back(std::sqrt(nearestSquared(s.exact.x.data(), s.exact.y.data(), s.exact.z.data(),
                                               s.exact.size(), c.x, c.y, c.z)));
    }
    return out;
}
Distances runSingle(const FarCloud& s) {
    Distances out;
    for (const dvec3& c : s.leaves) {
        const glm::vec3 f(c);
        out.push_back(std::sqrt(double{nearestSquared(s.single.x.data(), s.single.y.data(), s.single.z.data(),
                                                      s.single.size(), f.x, f.y, f.z)}));
    }
    return out;
}
Distances runHalf(const FarCloud& s) {
    Distances out;
    for (const dvec3& c : s.leaves) {
        const glm::vec3 f(c);
        out.push_back(std::sqrt(double{
            nearestHalf(s.half.x.data(), s.half.y.data(), s.half.z.data(), s.half.size(), f.x, f.y, f.z)}));
    }
    return out;
}
Distances runLocalHalf(const FarCloud& s) {
    Distances out;
    for (const dvec3& c : s.leaves) {
        float least = 1e30f;
        for (size_t b = 0; b < s.blocks.size(); ++b) {
            const glm::vec3 f(c - s.blocks[b]);
            const size_t at = b * FarCloud::kBlock;
            least = std::min(least, nearestHalf(s.local.x.data() + at, s.local.y.data() + at,
                                                s.local.z.data() + at, FarCloud::kBlock, f.x, f.y, f.z));
        }
        out.push_back(std::sqrt(double{least}));
    }
    return out;
}

} // namespace

std::vector<PrecisionLoop> centreRows(const StudyContext& context) {
    const size_t spheres = context.settings.quick ? 10000 : 60000, leaves = context.settings.quick ? 32 : 256;
    struct Kind {
        const char* name;
        Distances (*run)(const FarCloud&);
        double bytes, allowed; // [m]
    };
    std::vector<PrecisionLoop> loops;
    for (double away : {0.8, 8.0}) {
        const auto scene = std::make_shared<const FarCloud>(spheres, leaves, away);
        const Distances truth = runDouble(*scene);
        for (const Kind& kind :
             {Kind{"double", runDouble, 24, 0.0}, Kind{"single", runSingle, 12, 4e-6},
              Kind{"half about the patch", runLocalHalf, 6, 2e-5}, Kind{"half", runHalf, 6, away * 1e-3}}) {
            const Distances found = kind.run(*scene);
            double error = 0.0; // [m]
            for (size_t i = 0; i < truth.size(); ++i) {
                error = std::max(error, std::abs(found[i] - truth[i]));
            }
            verify(error <= kind.allowed, "precision", kind.name, digits(error * 1e3) + " mm");
            loops.push_back({precisionRow("centres " + digits(away) + " m from the origin", kind.name,
                                          std::string(kind.name) == "single", error * 1e3, kind.bytes,
                                          static_cast<double>(scene->exact.size()), NAN),
                             [scene, run = kind.run] { run(*scene); }});
        }
    }
    return loops;
}

} // namespace fathom::profile
