// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_camera.h"

#include "devices/images/metre_units.h"
#include "devices/pcd/ply_file.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printed.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace fathom {

namespace {

constexpr double kMaxResidual = 1.0; // [pixels]
constexpr double kMaxBehind = 0.01;  // share of points behind the camera: faults of single pixels

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

PcdCloud readCloud(const std::filesystem::path& file) {
    const std::string begin = firstBytes(file, 4); // "ply" and the end of its line
    const bool ply = begin == "ply\n" || begin == "ply\r" || file.extension() == ".ply";
    return ply ? readPlyCloud(file) : readPcd(file);
}

// Rows: right, down and forward in the cloud's axes.
glm::dmat3 axes(const dvec3& right, const dvec3& down, const dvec3& forward) {
    return glm::transpose(glm::dmat3(right, down, forward));
}

// Fits the lens under these axes and projection; infinite residual when the image would be upside down. Empty
// with too few points.
std::optional<FittedLens> fitAs(const PcdCloud& cloud, const glm::dmat3& opticalTcloud, bool fan) {
    Line across, down;
    size_t behind = 0;
    for (size_t i = 0; i < cloud.points.size(); ++i) {
        const dvec3 p = opticalTcloud * cloud.points[i];
        if (isMeasured(p)) {
            const double x = fan ? std::atan2(p.x, p.z) : p.x / p.z;
            const double y = fan ? std::atan2(p.y, std::hypot(p.x, p.z)) : p.y / p.z;
            // Relative to the centre, for precision of the sums.
            const size_t column = i % cloud.width, row = i / cloud.width;
            across.add(x, static_cast<double>(column) - 0.5 * cloud.width);
            down.add(y, static_cast<double>(row) - 0.5 * cloud.height);
        }
        behind += p.z < 0.0 ? 1 : 0;
    }
    FittedLens fit;
    fit.residual = HUGE_VAL;
    fit.opticalTcloud = opticalTcloud;
    if (across.n < 16.0 || !(across.spread() > 1e-9) || !(down.spread() > 1e-9)) {
        return std::nullopt;
    }
    fit.lens = {.width = cloud.width,
                .height = cloud.height,
                .fx = across.factor(),
                .fy = down.factor(),
                .cx = across.offset() + 0.5 * cloud.width,
                .cy = down.offset() + 0.5 * cloud.height,
                .fan = fan};
    // No camera sees behind itself: such axes are wrong, however well the rest fits.
    if (fit.lens.fx > 0.0 && fit.lens.fy > 0.0 && static_cast<double>(behind) < kMaxBehind * across.n) {
        fit.residual = std::sqrt(across.meanSquare() + down.meanSquare());
    }
    return fit;
}

// Intensity as grey; full scale is the smallest one that contains the maximum.
std::vector<uint32_t> greyOf(const std::vector<float>& intensity) {
    float largest = 0.0f;
    for (const float value : intensity) {
        largest = std::isfinite(value) ? std::max(largest, value) : largest;
    }
    const float scale = largest <= 1.0f ? 255.0f : (largest <= 255.0f ? 1.0f : 255.0f / 65535.0f);
    std::vector<uint32_t> grey;
    for (const float value : intensity) {
        const float level = std::isfinite(value) ? std::clamp(value * scale, 0.0f, 255.0f) : 0.0f;
        grey.push_back(0xff000000u | 0x010101u * static_cast<uint32_t>(level + 0.5f));
    }
    return grey;
}

// A single cloud, whose points give the lens.
void checkOptions(const std::string& file, const SourceOptions& options) {
    options.checkMetres(file);
    options.checkNoTopics(file);
    const bool lens = !options.intrinsics.empty();
    if (lens || !options.extrinsics.empty()) {
        throw BadInput(file, lens ? "intrinsics" : "extrinsics", "for a cloud",
                       "neither: lens and colour follow from the points");
    }
    if (options.start != 0.0 || std::isfinite(options.duration)) {
        throw BadInput(file, options.start != 0.0 ? "start" : "duration", "for a single cloud",
                       "neither: it is one frame");
    }
}

} // namespace

namespace {

// Why a cloud fits in none of the axes.
std::string whyNoAxes(const PcdCloud& cloud) {
    size_t before = 0, behind = 0;
    for (const dvec3& p : cloud.points) {
        before += p.z > 0.0 ? 1 : 0;
        behind += p.z < 0.0 ? 1 : 0;
    }
    return before == 0 && behind > 0
               ? "all lie behind the camera if z is forward, and are mirrored or upside down if z is backward"
               : "they lie behind the camera or are mirrored or upside down in all axes that are read";
}

} // namespace

FittedLens fitLens(const PcdCloud& cloud) {
    const dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    const glm::dmat3 kinds[] = {axes(x, y, z), axes(x, -y, -z), axes(-y, -z, x)};
    std::optional<FittedLens> best;
    for (const bool fan : {false, true}) {
        for (const glm::dmat3& kind : kinds) {
            const auto fit = fitAs(cloud, kind, fan);
            best = fit && (!best || fit->residual < best->residual) ? fit : best;
        }
    }
    if (!best) {
        throw Error("too few points to find the lens");
    }
    best->fault = std::isfinite(best->residual) ? "" : whyNoAxes(cloud);
    return *best;
}

std::string lensWarning(const Intrinsics& lens) {
    if (!isUnusualLens(lens)) {
        return "";
    }
    return printed(
        "the lens of its points has fx %.1f, fy %.1f and the principal point (%.1f, %.1f): they may be in "
        "another frame than their camera's",
        lens.fx, lens.fy, lens.cx, lens.cy);
}

PcdCamera::PcdCamera(const std::filesystem::path& file, const SourceOptions& options)
    : file_(file)
    , cloud_(readCloud(file)) {
    checkOptions(file.string(), options);
    FittedLens fit;
    try {
        fit = fitLens(cloud_);
    } catch (const Error& e) {
        throw BadInput(file.string(), "points", e.what(), "at least 16, spread over the image");
    }
    if (fit.residual > kMaxResidual) {
        throw BadInput(
            file.string(), "points",
            "deviates from the rays of a pinhole and of a fan" +
                (fit.fault.empty() ? " by " + std::to_string(fit.residual) + " pixels" : ": " + fit.fault),
            "a cloud from a depth camera or a scan with equal angles: x right and y down, y up "
            "and z backward, or x forward and z up; points without a measurement are NaN or 0");
    }
    if (const std::string warning = lensWarning(fit.lens); !warning.empty()) {
        log::warn("{}: {}", file.string(), warning);
        warnings_.push_back(warning);
    }
    if (!cloud_.pose.empty()) {
        warnings_.push_back("the pose in " + cloud_.pose + " is not read: base_T_camera of the scene counts");
        log::warn("{}: {}", file.string(), warnings_.back());
    }
    scalePoints(fit, options);
    if (options.depthOnly()) {
        cloud_.colour.clear();
    } else if (cloud_.colour.empty()) {
        cloud_.colour = greyOf(cloud_.intensity);
    }
    info_.depth = info_.colour = fit.lens;
    info_.poseless = true;
    info_.hasColour = !cloud_.colour.empty();
    slots_.emplace(info_.depth.pixels(), info_.hasColour, 1);
}

// To the optical frame and metres; sets the depth unit. A few points beyond the depth of interest do not cost
// the others their precision.
void PcdCamera::scalePoints(const FittedLens& fit, const SourceOptions& options) {
    ValueSpan seen;
    for (dvec3& p : cloud_.points) {
        p = fit.opticalTcloud * p * options.scale.value_or(1.0);
        seen.add(isMeasured(p) ? p.z : 0.0);
    }
    if (const std::string warning = metresWarning(file_.string(), seen); !warning.empty()) {
        warnings_.push_back(warning);
    }
    info_.metresPerUnit = unitForMetres(seen, options.farthest, 1.0);
    farthest_ = options.farthest;
}

std::vector<std::string> PcdCamera::warnings() const {
    return warnings_;
}

std::string PcdCamera::whyNoColour() const {
    const std::string why = Camera::whyNoColour();
    return why.empty() || cloud_.uncoloured.empty() ? why : cloud_.uncoloured;
}

std::optional<Frame> PcdCamera::next() {
    if (done_) {
        return std::nullopt;
    }
    done_ = true;
    FrameSlot* slot = &slots_->acquireFor(description());
    const std::span<uint16_t> depth = slot->depth();
    uint64_t beyond = 0;
    for (size_t i = 0; i < cloud_.points.size(); ++i) {
        const dvec3& p = cloud_.points[i];
        depth[i] = isMeasured(p) ? unitsOf(p.z, info_.metresPerUnit, beyond) : uint16_t{0};
    }
    if (const double limit = 65535.0 * info_.metresPerUnit; beyond > 0 && limit < farthest_) {
        log::warn("{}: points beyond {:.4g} m count as not measured: {}", file_.string(), limit, beyond);
    }
    std::copy(cloud_.colour.begin(), cloud_.colour.end(), slot->colour().begin());
    Frame::Content content;
    content.depth = depth.first(info_.depth.pixels());
    content.colour = slot->colour().first(info_.hasColour ? info_.depth.pixels() : 0);
    return slot->lend(content);
}

} // namespace fathom
