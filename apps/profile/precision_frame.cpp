// SPDX-License-Identifier: Apache-2.0
// Half, single and double precision in frames and ticks: depth pixels, the filter's weights and sums, pair
// gaps.
#include "apps/profile/half_number.h"
#include "apps/profile/precision.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <memory>

namespace fathom::profile {

namespace {

constexpr double kUnit = 1e-4;  // [m] per raw depth unit
constexpr int kWindow = 2;      // [pixels] radius of the filter
constexpr double kSigma = 0.01; // [m]

// A wavy wall 0.8 m away with a step and 1 mm of noise.
struct Image {
    int width, height;
    std::vector<uint16_t> raw;

    Image(int w, int h)
        : width(w)
        , height(h) {
        for (int v = 0; v < h; ++v) {
            for (int u = 0; u < w; ++u) {
                const double noise =
                    std::fmod(std::abs(std::sin(u * 12.9898 + v * 78.233) * 43758.5453), 1.0);
                const double z =
                    (u < w / 3 ? 0.8 : 0.9) + 0.03 * std::sin(9.0 * u / w) * std::cos(7.0 * v / h);
                raw.push_back(static_cast<uint16_t>(std::lround((z + 0.002 * (noise - 0.5)) / kUnit)));
            }
        }
    }
    double exact(size_t i) const { return raw[i] * kUnit; }
    double focal() const { return 0.9 * width; }
};

// Each pixel format stores a depth and converts it back.
struct RawPixel {
    using Number = float;
    uint16_t stored;
    static RawPixel of(uint16_t raw) { return {raw}; }
    float metres() const { return static_cast<float>(stored) * static_cast<float>(kUnit); }
};
struct HalfPixel {
    using Number = float;
    uint16_t stored;
    static HalfPixel of(uint16_t raw) { return {halved(static_cast<float>(raw * kUnit))}; }
    float metres() const { return widened(stored); }
};
template <class T>
struct PlainPixel {
    using Number = T;
    T stored;
    static PlainPixel of(uint16_t raw) { return {static_cast<T>(raw * kUnit)}; }
    T metres() const { return stored; }
};

template <class Pixel>
PrecisionLoop depthLoop(const std::shared_ptr<const Image>& shared, const char* name, double allowed) {
    const Image& image = *shared;
    using T = typename Pixel::Number;
    std::vector<Pixel> pixels;
    std::transform(image.raw.begin(), image.raw.end(), std::back_inserter(pixels), Pixel::of);
    struct Points {
        std::vector<T> x, y, z;
    };
    const size_t count = pixels.size();
    const auto points =
        std::make_shared<Points>(Points{std::vector<T>(count), std::vector<T>(count), std::vector<T>(count)});
    const T inverse = static_cast<T>(1.0 / image.focal());
    const auto unproject = [shared, points, pixels, inverse] {
        const int middleU = shared->width / 2, middleV = shared->height / 2;
        T *x = points->x.data(), *y = points->y.data(), *z = points->z.data();
        for (int v = 0; v < shared->height; ++v) {
            const T rayY = (static_cast<T>(v) - static_cast<T>(middleV)) * inverse;
            const size_t row = static_cast<size_t>(v) * static_cast<size_t>(shared->width);
            for (int u = 0; u < shared->width; ++u) {
                const size_t i = row + static_cast<size_t>(u);
                z[i] = static_cast<T>(pixels[i].metres());
                x[i] = (static_cast<T>(u) - static_cast<T>(middleU)) * inverse * z[i];
                y[i] = rayY * z[i];
            }
        }
    };
    unproject();
    double error = 0.0; // [m]
    for (size_t i = 0; i < pixels.size(); ++i) {
        error = std::max(error, std::abs(static_cast<double>(points->z[i]) - image.exact(i)));
    }
    verify(error <= allowed, "precision", name, "a depth is off by " + digits(error * 1e3) + " mm");
    return {precisionRow("frame: depth pixels", name, std::string(name) == "16-bit sensor units", error * 1e3,
                         sizeof(Pixel), static_cast<double>(count), NAN),
            unproject};
}

// The stored weight: as computed, or rounded to half.
template <class T, bool kHalfWeights>
T kept(T weight) {
    if constexpr (kHalfWeights) {
        return static_cast<T>(widened(halved(static_cast<float>(weight))));
    }
    return weight;
}

// The paper's filter (eq. 1-2) over an image without its border, computed in T.
template <class T, bool kHalfWeights>
std::vector<double> filter(const Image& p) {
    const T inverse = static_cast<T>(1.0 / p.focal()), scale = static_cast<T>(1.0 / (2.0 * kSigma * kSigma));
    std::vector<double> out(p.raw.size(), 0.0);
    const int middleU = p.width / 2, middleV = p.height / 2;
    const auto point = [&](int u, int v) {
        const T z = static_cast<T>(p.raw[static_cast<size_t>(v * p.width + u)]) * static_cast<T>(kUnit);
        return glm::vec<3, T>(static_cast<T>(u - middleU) * inverse * z,
                              static_cast<T>(v - middleV) * inverse * z, z);
    };
    for (int v = kWindow; v < p.height - kWindow; ++v) {
        for (int u = kWindow; u < p.width - kWindow; ++u) {
            const auto centre = point(u, v);
            T sum = 0, weights = 0;
            for (int dv = -kWindow; dv <= kWindow; ++dv) {
                for (int du = -kWindow; du <= kWindow; ++du) {
                    const auto apart = point(u + du, v + dv) - centre;
                    const T weight = kept<T, kHalfWeights>(std::exp(-glm::dot(apart, apart) * scale));
                    sum += apart.z * weight;
                    weights += weight;
                }
            }
            out[static_cast<size_t>(v * p.width + u)] = static_cast<double>(centre.z + sum / weights);
        }
    }
    return out;
}

struct Pairs {
    std::vector<float> x, y, z, radius;
    dvec3 leaf{0.013, -0.007, -0.031}; // [m] relative to the set's origin
    explicit Pairs(size_t count) {
        for (size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i);
            x.push_back(static_cast<float>(0.05 * std::sin(1.7 * t)));
            y.push_back(static_cast<float>(0.05 * std::cos(2.3 * t)));
            z.push_back(static_cast<float>(0.8 + 0.01 * std::sin(t)));
            radius.push_back(0.04f);
        }
        leaf.z += 0.8;
    }
};

// gap = |c - s| - (r + R) of every pair, as in the narrow phase.
template <class T>
void gapsOf(const Pairs& pairs, std::vector<T>& gaps) {
    const T cx = static_cast<T>(pairs.leaf.x), cy = static_cast<T>(pairs.leaf.y),
            cz = static_cast<T>(pairs.leaf.z);
    gaps.resize(pairs.x.size());
    for (size_t i = 0; i < gaps.size(); ++i) {
        const T dx = static_cast<T>(pairs.x[i]) - cx, dy = static_cast<T>(pairs.y[i]) - cy,
                dz = static_cast<T>(pairs.z[i]) - cz;
        gaps[i] = std::sqrt(dx * dx + dy * dy + dz * dz) -
                  (static_cast<T>(pairs.radius[i]) + static_cast<T>(0.008));
    }
}

} // namespace

std::vector<PrecisionLoop> depthRows(const StudyContext& context) {
    const bool quick = context.settings.quick;
    const auto image = std::make_shared<const Image>(quick ? 160 : 640, quick ? 120 : 480);
    return {depthLoop<PlainPixel<double>>(image, "double", 0.0),
            depthLoop<PlainPixel<float>>(image, "single", 1e-7),
            depthLoop<RawPixel>(image, "16-bit sensor units", 1e-7),
            depthLoop<HalfPixel>(image, "half", 2.5e-4)};
}

std::vector<PrecisionLoop> weightRows(const StudyContext& context) {
    const bool quick = context.settings.quick;
    const auto image = std::make_shared<const Image>(quick ? 80 : 320, quick ? 60 : 240);
    const std::vector<double> truth = filter<double, false>(*image);
    struct Kind {
        const char* name;
        std::vector<double> (*run)(const Image&);
        double bytes, allowed; // [m]
    };
    std::vector<PrecisionLoop> loops;
    for (const Kind& kind :
         {Kind{"double", filter<double, false>, 8, 0.0}, Kind{"single", filter<float, false>, 4, 1e-6},
          Kind{"half weights", filter<float, true>, 2, 2e-5}}) {
        const std::vector<double> found = kind.run(*image);
        double error = 0.0; // [m]
        for (size_t i = 0; i < truth.size(); ++i) {
            error = std::max(error, std::abs(found[i] - truth[i]));
        }
        verify(error <= kind.allowed, "precision", kind.name,
               "filtered depth off by " + digits(error * 1e3) + " mm");
        loops.push_back({precisionRow("frame: filter weights", kind.name, std::string(kind.name) == "single",
                                      error * 1e3, kind.bytes, static_cast<double>(truth.size()), NAN),
                         [image, run = kind.run] { run(*image); }});
    }
    return loops;
}

std::vector<PrecisionLoop> gapRows(const StudyContext& context) {
    const auto pairs = std::make_shared<const Pairs>(context.settings.quick ? 2000 : 20000);
    const std::string source = "frame: pair gaps of a tick";
    std::vector<double> truth;
    std::vector<float> single;
    gapsOf(*pairs, truth);
    gapsOf(*pairs, single);
    double error = 0.0; // [m]
    for (size_t i = 0; i < truth.size(); ++i) {
        error = std::max(error, std::abs(static_cast<double>(single[i]) - truth[i]));
    }
    verify(error > 0.0 && error <= 5e-7, "precision", "single gaps", digits(error * 1e3) + " mm");
    const double count = static_cast<double>(truth.size());
    return {{precisionRow(source, "double", true, 0.0, 8, count, NAN),
             [pairs, truth]() mutable { gapsOf(*pairs, truth); }},
            {precisionRow(source, "single", false, error * 1e3, 4, count, NAN),
             [pairs, single]() mutable { gapsOf(*pairs, single); }}};
}

} // namespace fathom::profile
