// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr double kFinestUnit = 1e-4;  // [m]
constexpr double kMostResidual = 1.0; // [pixels]

// A straight line p = a s + b through many points.
struct Line {
    double n = 0.0, s = 0.0, p = 0.0, ss = 0.0, sp = 0.0, pp = 0.0;
    void add(double slope, double pixel) {
        n += 1.0;
        s += slope;
        p += pixel;
        ss += slope * slope;
        sp += slope * pixel;
        pp += pixel * pixel;
    }
    double spread() const { return n * ss - s * s; }
    double factor() const { return (n * sp - s * p) / spread(); }
    double offset() const { return (p - factor() * s) / n; }
    double meanSquare() const {
        const double a = factor(), b = offset();
        return std::max(0.0,
                        (pp - 2.0 * a * sp - 2.0 * b * p + a * a * ss + 2.0 * a * b * s + n * b * b) / n);
    }
};

bool measured(const dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && p.z != 0.0;
}

} // namespace

FittedLens fitLens(const PcdCloud& cloud) {
    Line across, down;
    size_t behind = 0;
    for (size_t i = 0; i < cloud.points.size(); ++i) {
        const dvec3& p = cloud.points[i];
        if (measured(p)) {
            // About the centre: the sums keep their digits.
            across.add(p.x / p.z, static_cast<double>(i % cloud.width) - 0.5 * cloud.width);
            down.add(p.y / p.z, static_cast<double>(i / cloud.width) - 0.5 * cloud.height);
            behind += p.z < 0.0 ? 1 : 0;
        }
    }
    if (across.n < 16.0 || !(across.spread() > 1e-9) || !(down.spread() > 1e-9)) {
        throw Error("too few points to find the lens");
    }
    FittedLens fit;
    fit.upAndBack = static_cast<double>(behind) > 0.5 * across.n;
    // With z backward x/z changes its sign; with y up as well y/z keeps it.
    fit.lens = {.width = cloud.width,
                .height = cloud.height,
                .fx = fit.upAndBack ? -across.factor() : across.factor(),
                .fy = down.factor(),
                .cx = across.offset() + 0.5 * cloud.width,
                .cy = down.offset() + 0.5 * cloud.height};
    fit.residual = std::sqrt(across.meanSquare() + down.meanSquare());
    return fit;
}

PcdCamera::PcdCamera(const std::filesystem::path& file)
    : file_(file)
    , cloud_(readPcd(file)) {
    FittedLens fit;
    try {
        fit = fitLens(cloud_);
    } catch (const Error& e) {
        throw BadInput(file.string(), "points", e.what(), "at least 16, spread over the picture");
    }
    if (fit.residual > kMostResidual || !(fit.lens.fx > 0.0) || !(fit.lens.fy > 0.0)) {
        throw BadInput(file.string(), "points",
                       "off a pinhole's rays by " + std::to_string(fit.residual) + " pixels",
                       "a cloud that a depth camera saw, x right and y down (or y up and z backward)");
    }
    double farthest = 0.0;
    for (const dvec3& p : cloud_.points) {
        farthest = measured(p) ? std::max(farthest, std::abs(p.z)) : farthest;
    }
    upAndBack_ = fit.upAndBack;
    info_.depth = info_.colour = fit.lens;
    info_.hasColour = !cloud_.colour.empty();
    info_.metresPerUnit = kFinestUnit * std::ceil(std::max(1.0, farthest / (65000.0 * kFinestUnit)));
    slots_.emplace(info_.depth.pixels(), info_.hasColour, 1);
}

std::optional<Frame> PcdCamera::next() {
    if (done_) {
        return std::nullopt;
    }
    done_ = true;
    FrameSlot* slot = slots_->acquire();
    const std::span<uint16_t> depth = slot->depth();
    for (size_t i = 0; i < cloud_.points.size(); ++i) {
        const double z = upAndBack_ ? -cloud_.points[i].z : cloud_.points[i].z;
        depth[i] = measured(cloud_.points[i]) && z > 0.0
                       ? static_cast<uint16_t>(std::lround(z / info_.metresPerUnit))
                       : uint16_t{0};
    }
    std::copy(cloud_.colour.begin(), cloud_.colour.end(), slot->colour().begin());
    Frame::Content content;
    content.depth = depth.first(info_.depth.pixels());
    content.colour = slot->colour().first(info_.hasColour ? info_.depth.pixels() : 0);
    return Frame(content, slot->giveBack());
}

} // namespace fathom
