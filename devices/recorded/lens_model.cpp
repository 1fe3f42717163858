// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/lens_model.h"

#include "engine/scene/camera_limits.h"
#include "engine/types/number_text.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace fathom {

namespace {

struct KnownLens {
    std::string_view name;
    LensModel model;
};
constexpr std::array kLenses{KnownLens{"plumb_bob", LensModel::Polynomial},
                             KnownLens{"brown_conrady", LensModel::Polynomial},
                             KnownLens{"radtan", LensModel::Polynomial},
                             KnownLens{"opencv", LensModel::Polynomial},
                             KnownLens{"rational_polynomial", LensModel::Polynomial},
                             KnownLens{"inverse_brown_conrady", LensModel::ScaledTangential},
                             KnownLens{"modified_brown_conrady", LensModel::ScaledTangential},
                             KnownLens{"equidistant", LensModel::Equidistant},
                             KnownLens{"kannala_brandt", LensModel::Equidistant},
                             KnownLens{"kannala_brandt4", LensModel::Equidistant},
                             KnownLens{"fisheye", LensModel::Equidistant},
                             KnownLens{"opencv_fisheye", LensModel::Equidistant}};
constexpr const char* kKnownModels =
    "plumb_bob, Brown Conrady, rational_polynomial, inverse_brown_conrady or equidistant, unless all "
    "coefficients are zero";

std::string plainName(const std::string& name) {
    std::string out;
    for (const char c : name) {
        out += c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return out;
}

bool allZero(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double k) { return k == 0.0; });
}

} // namespace

std::string setDistortion(Intrinsics& lens, const std::string& model, std::span<const double> coefficients) {
    const auto known = std::find_if(kLenses.begin(), kLenses.end(), [&](const KnownLens& one) {
        return one.name == (model.empty() ? "plumb_bob" : plainName(model));
    });
    const bool angles = known != kLenses.end() && known->model == LensModel::Equidistant;
    if (coefficients.empty() || (allZero(coefficients) && !angles)) {
        return "";
    }
    if (known == kLenses.end()) {
        return kKnownModels;
    }
    if (!std::all_of(coefficients.begin(), coefficients.end(), [](double k) { return std::isfinite(k); })) {
        return "finite coefficients";
    }
    const size_t count = coefficients.size();
    if (angles ? count < 4 : count < 4 || (count > 5 && count < 8)) {
        return angles ? "k1, k2, k3 and k4" : "k1, k2, p1, p2 and k3 or none, or also k4, k5 and k6";
    }
    const size_t used = angles ? 4 : std::min<size_t>(8, count);
    if (!allZero(coefficients.subspan(used))) {
        return angles ? "k1, k2, k3 and k4" : "no coefficients after k6 (thin prism, tilt) but zeros";
    }
    lens.model = known->model;
    std::copy_n(coefficients.begin(), std::min<size_t>(used, 5), lens.distortion.begin());
    std::copy(coefficients.begin() + static_cast<long>(std::min<size_t>(used, 5)),
              coefficients.begin() + static_cast<long>(used), lens.divisor.begin());
    return "";
}

std::string distortionModel(const Intrinsics& lens) {
    if (lens.model == LensModel::Equidistant) {
        return "equidistant";
    }
    if (lens.model == LensModel::ScaledTangential) {
        return "inverse_brown_conrady";
    }
    return lens.divisor == std::array<double, 3>{} ? "plumb_bob" : "rational_polynomial";
}

std::vector<double> distortionCoefficients(const Intrinsics& lens) {
    std::vector<double> all(lens.distortion.begin(), lens.distortion.end());
    if (lens.model == LensModel::Equidistant) {
        all.pop_back();
    } else if (lens.divisor != std::array<double, 3>{}) {
        all.insert(all.end(), lens.divisor.begin(), lens.divisor.end());
    }
    return all;
}

bool isUnusualLens(const Intrinsics& lens) {
    constexpr double kMaxRatio = 1.25;                    // of the focal lengths
    const auto between = [](double at, uint32_t pixels) { // the outermost pixels
        const double middle = 0.5 * (pixels - 1.0);
        return std::abs(at - middle) < std::max(0.5, middle);
    };
    const bool inside = between(lens.cx, lens.width) && between(lens.cy, lens.height);
    const double ratio = std::max(lens.fx, lens.fy) / std::min(lens.fx, lens.fy);
    return !lens.fan && isUsableLens(lens) && !(inside && ratio <= kMaxRatio);
}

std::vector<std::string> lensWarnings(const CameraInfo& camera) {
    std::vector<std::string> warnings;
    const auto add = [&](const Intrinsics& lens, const char* stream) {
        if (isUnusualLens(lens)) {
            warnings.push_back(
                printed("the lens of %s has fx %.1f, fy %.1f and the principal point (%.1f, %.1f) in images "
                        "of %ux%u: it may be that of another image size",
                        stream, lens.fx, lens.fy, lens.cx, lens.cy, lens.width, lens.height));
        }
    };
    add(camera.depth, "depth");
    if (camera.hasColour && !camera.registered) {
        add(camera.colour, "colour");
    }
    return warnings;
}

void warnAboutSkew(std::vector<std::string>& warnings, const std::string& matrix, double skew,
                   const std::string& images) {
    constexpr double kMaxSkew = 0.1; // [pixels]
    if (std::abs(skew) > kMaxSkew) {
        warnings.push_back(matrix + ": a skew of " + significant(skew, 3) + " pixels is not used: " + images +
                           " are played without it");
    }
}

// The lens of images of half the width and height has its principal point at a quarter of both. That of a
// crop rarely is at one share of both.
void warnAboutSize(std::vector<std::string>& warnings, const std::string& matrix, const Intrinsics& lens) {
    constexpr double kFarFromMiddle = 0.1, kMaxApart = 0.06;
    const double across = (lens.cx + 0.5) / lens.width, down = (lens.cy + 0.5) / lens.height;
    const double share = 0.5 * (across + down);
    if (std::abs(share - 0.5) <= kFarFromMiddle || std::abs(across - down) > kMaxApart * share ||
        isUnusualLens(lens)) { // which has a warning of its own
        return;
    }
    warnings.push_back(
        matrix +
        printed(": the principal point (%.1f, %.1f) is at %.0f %% of the width and the height of images of "
                "%ux%u: it may be the lens of another image size",
                lens.cx, lens.cy, 100.0 * share, lens.width, lens.height));
}

bool sameLens(const Intrinsics& a, const Intrinsics& b) {
    const auto equal = [](double one, double other) { return std::abs(one - other) < 1e-6; };
    return a.width == b.width && a.height == b.height && equal(a.fx, b.fx) && equal(a.fy, b.fy) &&
           equal(a.cx, b.cx) && equal(a.cy, b.cy) && a.distortion == b.distortion && a.divisor == b.divisor &&
           a.model == b.model;
}

bool nearlySameLens(const Intrinsics& a, const Intrinsics& b) {
    constexpr double kMaxOff = 0.1; // [pixels]
    if (a.width != b.width || a.height != b.height || a.fan != b.fan) {
        return false;
    }
    for (const double x : {0.0, 0.5, 1.0}) {
        for (const double y : {0.0, 0.5, 1.0}) {
            const glm::dvec2 pixel(x * (a.width - 1.0), y * (a.height - 1.0));
            const glm::dvec2 seen = b.project(dvec3(a.ray(pixel.x, pixel.y), 1.0));
            if (!(glm::length(seen - pixel) <= kMaxOff)) {
                return false;
            }
        }
    }
    return true;
}

} // namespace fathom
