// SPDX-License-Identifier: Apache-2.0
#include "apps/output/silhouette.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {

namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

struct Range {
    double lo, hi; // range of ray slopes; empty when hi < lo
};

// Slopes y/z of the two tangents from the eye to the projection of the sphere on the (y, z) plane.
Range slopesOf(double y, double z, double radius) {
    if (z > radius) { // roots of (y - z s)^2 = r^2 (1 + s^2)
        const double scale = 1.0 / (z * z - radius * radius);
        const double half = radius * std::sqrt(y * y + z * z - radius * radius);
        return {(y * z - half) * scale, (y * z + half) * scale};
    }
    const double distance = std::hypot(y, z);
    if (distance <= radius) {
        return {-kEverywhere, kEverywhere};
    }
    const double middle = std::atan2(y, z);
    const double half = std::asin(radius / distance);
    constexpr double kSide = 0.25 * kTurn - 1e-9;
    if (middle - half > kSide || middle + half < -kSide) {
        return {0.0, -1.0}; // behind the eye
    }
    return {middle - half < -kSide ? -kEverywhere : std::tan(middle - half),
            middle + half > kSide ? kEverywhere : std::tan(middle + half)};
}

// The pixels of a row that see a sphere in front of the eye: rays (x, y, 1) with (c . ray)^2 >= k |ray|^2 and
// k = |c|^2 - r^2, solved for x. Middle and square of the half width are polynomials of y.
class RowRuns {
public:
    RowRuns(const dvec3& c, double k)
        : c_(c)
        , k_(k)
        , a_(c.x * c.x - k) {}

    Range at(double y) const {
        const double rest = c_.y * y + c_.z;
        const double b = c_.x * rest, square = k_ * (a_ * (y * y + 1.0) + rest * rest);
        if (a_ < 0.0) {
            const double root = std::sqrt(std::max(0.0, square));
            return square < 0.0 ? Range{0.0, -1.0} : Range{(root - b) * inverse_, (-b - root) * inverse_};
        }
        // The cone of rays to the sphere contains a direction at infinity within the row, so the run is
        // unbounded on the sphere's side.
        if (a_ == 0.0 || c_.x == 0.0) {
            return {-kEverywhere, kEverywhere};
        }
        const double root = std::sqrt(std::max(0.0, square));
        return c_.x > 0.0 ? Range{(root - b) * inverse_, kEverywhere}
                          : Range{-kEverywhere, (-b - root) * inverse_};
    }

private:
    dvec3 c_;
    double k_, a_, inverse_ = 1.0 / a_;
};

} // namespace

Silhouette::Silhouette(const ImageView& view)
    : view_(view)
    , width_(view.width())
    , height_(view.height())
    , steps_(static_cast<size_t>(width_ + 1) * static_cast<size_t>(height_)) {}

void Silhouette::add(const dvec3& baseCentre, double radius) {
    const dvec3 c = view_.cameraTbase.apply(baseCentre);
    if (!isFinite(c) || !(radius > 0.0) || c.z <= -radius) {
        return;
    }
    const double k = glm::dot(c, c) - radius * radius;
    const double scale = view_.scale;
    const double fx = view_.lens.fx * scale, fy = view_.lens.fy * scale;
    const glm::dvec2 shift = c.z > 0.0 ? view_.distortionShift(c) : glm::dvec2(0.0);
    // Image coordinates of the ray (0, 0, 1), shifted by the distortion.
    const double u0 = (view_.lens.cx + 0.5) * scale + shift.x;
    const double v0 = (view_.lens.cy + 0.5) * scale + shift.y;
    const Range rows = k <= 0.0 ? Range{-kEverywhere, kEverywhere} : slopesOf(c.y, c.z, radius);
    // Rows whose centre (v + 0.5) is inside.
    const double first = std::max(0.0, std::ceil(v0 + fy * rows.lo - 0.5));
    const double last = std::min(height_ - 1.0, std::floor(v0 + fy * rows.hi - 0.5));
    if (!settled_.empty() && c.z > radius && covers(c, radius, {fx, fy}, {u0, v0})) {
        return;
    }
    const RowRuns runs(c, k);
    const double perRow = 1.0 / fy;
    for (double v = first; v <= last; v += 1.0) {
        const Range run = k <= 0.0 ? Range{-kEverywhere, kEverywhere} : runs.at((v + 0.5 - v0) * perRow);
        addRow(static_cast<int>(v), u0 + fx * run.lo, u0 + fx * run.hi);
    }
}

void Silhouette::addRow(int v, double from, double to) {
    const double first = std::max(0.0, std::ceil(from - 0.5));
    const double end = std::min(static_cast<double>(width_), std::floor(to - 0.5) + 1.0);
    if (!(first < end)) {
        return;
    }
    int32_t* row = steps_.data() + static_cast<size_t>(v) * static_cast<size_t>(width_ + 1);
    ++row[static_cast<size_t>(first)];
    --row[static_cast<size_t>(end)];
    box_.u0 = std::min(box_.u0, static_cast<int>(first));
    box_.u1 = std::max(box_.u1, static_cast<int>(end));
    box_.v0 = std::min(box_.v0, v);
    box_.v1 = std::max(box_.v1, v + 1);
}

// Sums of covered pixels above and left of each corner of the box's pixels.
void Silhouette::settle() {
    const auto across = static_cast<size_t>(std::max(0, box_.u1 - box_.u0)) + 1;
    settledBox_ = box_;
    settled_.assign(across * (static_cast<size_t>(std::max(0, box_.v1 - box_.v0)) + 1), 0);
    for (int v = box_.v0; v < box_.v1; ++v) {
        const int32_t* step = steps_.data() + static_cast<size_t>(v) * static_cast<size_t>(width_ + 1) +
                              static_cast<size_t>(box_.u0);
        const int32_t* above = settled_.data() + static_cast<size_t>(v - box_.v0) * across;
        int32_t* sum = settled_.data() + static_cast<size_t>(v - box_.v0 + 1) * across;
        int32_t open = 0, inRow = 0;
        for (size_t i = 1; i < across; ++i) {
            open += *step++;
            inRow += open > 0 ? 1 : 0;
            sum[i] = above[i] + inRow;
        }
    }
}

// Whether all pixels of a sphere in front of the eye were covered at the last settle(). Its outline is an
// ellipse, which two rectangles contain. focal, middle: [pixels] per slope, and of the ray (0, 0, 1).
bool Silhouette::covers(const dvec3& c, double radius, glm::dvec2 focal, glm::dvec2 middle) const {
    constexpr double kShort = 0.7072; // the rectangles cross on the outline
    const double scale = 1.0 / (c.z * c.z - radius * radius);
    const glm::dvec2 at = middle + c.z * scale * focal * glm::dvec2(c);
    const glm::dvec2 half = radius * std::sqrt(glm::dot(c, c) - radius * radius) * scale * focal;
    return isFull(at, half * glm::dvec2(1.0, kShort)) && isFull(at, half * glm::dvec2(kShort, 1.0));
}

bool Silhouette::isFull(glm::dvec2 middle, glm::dvec2 half) const {
    const Box& box = settledBox_;
    const glm::dvec2 low = glm::floor(middle - half - 0.5), high = glm::ceil(middle + half - 0.5);
    if (!(high.x >= 0.0 && high.y >= 0.0 && low.x < width_ && low.y < height_)) {
        return false; // outside of the image
    }
    const int u0 = static_cast<int>(std::max(0.0, low.x)), v0 = static_cast<int>(std::max(0.0, low.y));
    const int u1 = static_cast<int>(std::min(width_ - 1.0, high.x)) + 1,
              v1 = static_cast<int>(std::min(height_ - 1.0, high.y)) + 1;
    if (u0 < box.u0 || u1 > box.u1 || v0 < box.v0 || v1 > box.v1) {
        return false;
    }
    const auto across = static_cast<size_t>(box.width()) + 1;
    const auto sum = [&](int atU, int atV) {
        return settled_[static_cast<size_t>(atV - box.v0) * across + static_cast<size_t>(atU - box.u0)];
    };
    return sum(u1, v1) - sum(u0, v1) - sum(u1, v0) + sum(u0, v0) == (u1 - u0) * (v1 - v0);
}

Silhouette::Box Silhouette::covered() const {
    constexpr int kMargin = 2; // so that a border inside the image stays one
    if (box_.u1 <= box_.u0) {
        return {};
    }
    return {std::max(0, box_.u0 - kMargin), std::max(0, box_.v0 - kMargin),
            std::min(width_, box_.u1 + kMargin), std::min(height_, box_.v1 + kMargin)};
}

std::vector<uint8_t> Silhouette::mask() const {
    return mask({0, 0, width_, height_});
}

std::vector<uint8_t> Silhouette::mask(const Box& box) const {
    std::vector<uint8_t> mask(static_cast<size_t>(box.width()) * static_cast<size_t>(box.height()));
    uint8_t* pixel = mask.data();
    for (int v = box.v0; v < box.v1; ++v) {
        const int32_t* step = steps_.data() + static_cast<size_t>(v) * static_cast<size_t>(width_ + 1) +
                              static_cast<size_t>(box.u0); // no run starts left of the box
        int32_t open = 0;
        for (int u = box.u0; u < box.u1; ++u) {
            open += *step++;
            *pixel++ = open > 0;
        }
    }
    return mask;
}

RegionMasks regionMasks(const ImageView& view, const HostFixtures& set) {
    const uint32_t pixels = set.camera.depth.pixels();
    Silhouette seen(view), held(view);
    size_t before = 0;                        // step of the previous pass
    for (const size_t step : {32u, 8u, 1u}) { // a few spheres cover most of the others
        if (before != 0) {
            seen.settle();
            held.settle();
        }
        for (size_t i = 0; i < set.spheres.size(); i += step) {
            if (before == 0 || i % before != 0) {
                (set.spheres.source[i] >= pixels ? held : seen)
                    .add(regionCentre(set, i), double{set.spheres.radius[i]});
            }
        }
        before = step;
    }
    RegionMasks masks{seen.mask(), {}, false};
    masks.held = held.covered().width() > 0 ? held.mask() : std::vector<uint8_t>(masks.seen.size());
    for (size_t i = 0; held.covered().width() > 0 && i < masks.held.size(); ++i) {
        masks.held[i] = static_cast<uint8_t>(masks.held[i] & ~masks.seen[i] & 1);
        masks.anyHeld = masks.anyHeld || masks.held[i] != 0;
    }
    return masks;
}

namespace {

// trace(mask, width, height) of the spheres, only for the part around them: a tool covers a few per cent of
// an image.
template <class Trace>
std::vector<OutlineLine> around(const ImageView& view, std::span<const Sphere> spheres, Trace trace) {
    Silhouette silhouette(view);
    for (const Sphere& sphere : spheres) {
        silhouette.add(sphere.centre, sphere.radius);
    }
    const Silhouette::Box box = silhouette.covered();
    std::vector<OutlineLine> lines = trace(silhouette.mask(box), box.width(), box.height());
    for (OutlineLine& line : lines) {
        for (glm::dvec2& p : line) {
            p += glm::dvec2(box.u0, box.v0);
        }
    }
    return lines;
}

} // namespace

std::vector<OutlineLine> outlineOf(const ImageView& view, std::span<const Sphere> spheres) {
    return around(view, spheres, [](const std::vector<uint8_t>& mask, int width, int height) {
        return traceOutline(mask, width, height, 0);
    });
}

std::vector<OutlineLine> areaOf(const ImageView& view, std::span<const Sphere> spheres) {
    return around(view, spheres, traceArea);
}

} // namespace fathom
