// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/still_part.h"

#include "engine/types/median.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace fathom::tune {

namespace {

constexpr double kGaussianMedian = 1.4826; // sigma of a normal distribution over its median deviation
constexpr uint32_t kStride = 2;            // pixels that are looked at for noise and stillness
constexpr double kMaxPosition = 0.0005, kMaxTurn = 0.0005; // [m], [rad] of a still camera
constexpr double kMaxGrowth = 1.5; // of the change between two frames, with the time between them
constexpr double kMaxNoise = 4.0;  // of depthSigma(); more comes from images that show different things
constexpr double kFlicker = 5.0;   // [sigma] scatter of a pixel at a border

double medianOrZero(std::vector<double>& values) {
    return values.empty() ? 0.0 : medianOf(values);
}

double roundingSigma(const CameraInfo& camera) {
    return camera.metresPerUnit / std::sqrt(12.0);
}

bool posesDiffer(const Pose& a, const Pose& b) {
    const double turn = 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a.rotation, b.rotation))));
    return glm::distance(a.position, b.position) > kMaxPosition || turn > kMaxTurn;
}

// Depths of the pixels that all images measure, over the square of the first one: noise grows like that.
template <class Term>
std::vector<double> termsOf(const CameraInfo& camera, std::initializer_list<const SampleFrame*> images,
                            Term&& term) {
    std::vector<double> terms;
    const uint32_t width = camera.depth.width, height = camera.depth.height;
    for (uint32_t v = 0; v < height; v += kStride) {
        for (uint32_t u = 0; u < width; u += kStride) {
            const size_t i = size_t{v} * width + u;
            if (std::ranges::all_of(images, [i](const SampleFrame* image) { return image->depth[i] > 0; })) {
                const double z = camera.metresPerUnit * (*images.begin())->depth[i];
                terms.push_back(camera.metresPerUnit * std::abs(term(i)) / (z * z));
            }
        }
    }
    return terms;
}

// Median change of a pixel [1/m].
double changeBetween(const CameraInfo& camera, const SampleFrame& a, const SampleFrame& b) {
    std::vector<double> changes =
        termsOf(camera, {&a, &b}, [&](size_t i) { return 1.0 * b.depth[i] - a.depth[i]; });
    return medianOrZero(changes);
}

// Value below which a quarter of the list lies: recordings may consist of many short parts.
double quarterOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 4];
}

// Mean and scatter of every pixel of the depth images.
struct PixelSums {
    std::vector<double> mean, scatter; // [units]; scatter 0 = too few readings
};

PixelSums sumsOf(const FrameSequence& source, const StillPart& part) {
    const size_t pixels = source.camera.depth.pixels();
    PixelSums sums{std::vector<double>(pixels), std::vector<double>(pixels)};
    for (size_t i = 0; i < pixels; ++i) {
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (size_t k = part.first; k < part.first + part.count; ++k) {
            const double z = source.frames[k].depth[i];
            sum += z, squares += z * z, count += z > 0.0 ? 1.0 : 0.0;
        }
        if (2.0 * count >= static_cast<double>(part.count) && count > 1.0) {
            sums.mean[i] = sum / count;
            sums.scatter[i] = std::sqrt(std::max(0.0, squares - sum * sum / count) / (count - 1.0));
        }
    }
    return sums;
}

void meanColours(const FrameSequence& source, const StillPart& part, std::vector<uint32_t>& colour) {
    colour.assign(source.frames[part.first].colour.size(), 0u);
    const auto count = static_cast<uint32_t>(part.count);
    for (size_t i = 0; i < colour.size(); ++i) {
        uint32_t red = 0, green = 0, blue = 0;
        for (size_t k = part.first; k < part.first + part.count; ++k) {
            const uint32_t c = source.frames[k].colour[i];
            red += c & 0xffu, green += c >> 8 & 0xffu, blue += c >> 16 & 0xffu;
        }
        colour[i] = 0xff000000u | (blue + count / 2) / count << 16 | (green + count / 2) / count << 8 |
                    (red + count / 2) / count;
    }
}

} // namespace

DepthNoise noiseWithin(const CameraInfo& camera, const SampleFrame& image) {
    std::vector<double> bends, ranges;
    const uint32_t width = camera.depth.width, height = camera.depth.height;
    for (uint32_t v = 0; v < height; v += kStride) {
        for (uint32_t u = 1; u + 1 < width; u += kStride) {
            const uint16_t* z = &image.depth[v * width + u];
            if (z[-1] > 0 && z[0] > 0 && z[1] > 0) {
                bends.push_back(std::abs(z[-1] - 2.0 * z[0] + z[1]));
                ranges.push_back(z[0]);
            }
        }
    }
    const double sigma = kGaussianMedian * medianOrZero(bends) / std::sqrt(6.0) * camera.metresPerUnit;
    return {std::max(sigma, roundingSigma(camera)), medianOrZero(ranges) * camera.metresPerUnit};
}

DepthNoise noiseOverTime(const FrameSequence& source) {
    DepthNoise noise = noiseWithin(source.camera, source.frames.front());
    std::vector<double> levels; // [1/m]
    for (size_t k = 1; k + 1 < source.frames.size(); ++k) {
        const SampleFrame &a = source.frames[k - 1], &b = source.frames[k], &c = source.frames[k + 1];
        std::vector<double> bends = termsOf(source.camera, {&b, &a, &c}, [&](size_t i) {
            return a.depth[i] - 2.0 * b.depth[i] + c.depth[i];
        });
        levels.push_back(kGaussianMedian * medianOrZero(bends) / std::sqrt(6.0));
    }
    const double overTime = quarterOf(levels) * noise.range * noise.range, usual = depthSigma(noise.range);
    noise.measured = !levels.empty() && overTime <= kMaxNoise * usual;
    noise.sigma =
        std::max(noise.sigma, noise.measured ? overTime : SimulatedCamera::kDepthSigmaShare * usual);
    return noise;
}

StillPart longestStill(const FrameSequence& source) {
    const CameraInfo& camera = source.camera;
    std::vector<double> steps;
    for (size_t k = 1; k < source.frames.size(); ++k) {
        steps.push_back(changeBetween(camera, source.frames[k - 1], source.frames[k]));
    }
    StillPart longest, current;
    for (size_t i = 0; i < source.frames.size(); ++i) {
        const SampleFrame &first = source.frames[current.first], &now = source.frames[i];
        const double range = std::max(1e-3, noiseWithin(camera, first).range);
        const double most = std::max(kMaxGrowth * quarterOf(steps), camera.metresPerUnit / (range * range));
        if (posesDiffer(first.baseTcamera, now.baseTcamera) || changeBetween(camera, first, now) > most) {
            current = {i, 0};
        }
        ++current.count;
        if (current.count > longest.count) {
            longest = current;
        }
    }
    return longest;
}

MeanImage meanOf(const FrameSequence& source, const StillPart& part) {
    const PixelSums sums = sumsOf(source, part);
    std::vector<double> scatters, ranges;
    double farthest = 0.0;
    for (size_t i = 0; i < sums.mean.size(); ++i) {
        if (sums.mean[i] > 0.0) {
            scatters.push_back(sums.scatter[i]);
            ranges.push_back(sums.mean[i]);
            farthest = std::max(farthest, sums.mean[i]);
        }
    }
    const double typical = medianOrZero(scatters), unit = source.camera.metresPerUnit;
    uint32_t finer = 16; // parts of a unit, as many as 16 bits hold
    while (finer > 1 && finer * farthest > 65535.0) {
        finer /= 2;
    }
    MeanImage mean{source.camera, source.frames[part.first], {}};
    mean.noise = {std::max(typical * unit, roundingSigma(source.camera)), medianOrZero(ranges) * unit};
    mean.camera.metresPerUnit = unit / finer;
    mean.camera.colourFormat = ColourFormat::Rgba;
    const double border = kFlicker * std::max(typical, 1.0);
    for (size_t i = 0; i < sums.mean.size(); ++i) {
        const bool steady = sums.mean[i] > 0.0 && sums.scatter[i] <= border;
        mean.image.depth[i] = static_cast<uint16_t>(steady ? std::lround(finer * sums.mean[i]) : 0);
    }
    meanColours(source, part, mean.image.colour);
    return mean;
}

} // namespace fathom::tune
