// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/camera_limits.h"

#include "engine/scene/yaml_node.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kNarrowest = 100.0; // focal length in image sizes: 0.6 degrees across the image
constexpr double kSteepest = 60.0;   // slope of a ray: 89 degrees off the axis

class Check {
public:
    explicit Check(const std::string& source)
        : source_(source) {}

    void number(const std::string& field, double x, const Range& range) const {
        if (!range.contains(x)) {
            throw BadInput(source_, field, significant(x, 9), range.words());
        }
    }

    // The slope of the outermost ray along an axis of the image.
    void slope(const std::string& field, double centre, double size, double focal) const {
        const double steepest = std::max(std::abs(centre), std::abs(size - centre)) / focal;
        if (!(steepest <= kSteepest)) {
            throw BadInput(source_, field,
                           significant(centre, 9) + " with a focal length of " + significant(focal, 9),
                           "rays within 89 degrees of the axis");
        }
    }

    void lens(const std::string& name, const Intrinsics& lens) const {
        const double size = std::max(lens.width, lens.height);
        const Range focal = Range::between(1e-3, kNarrowest * std::max(size, 64.0));
        number(name + " fx", lens.fx, focal);
        number(name + " fy", lens.fy, focal);
        slope(name + " cx", lens.cx, lens.width, lens.fx);
        slope(name + " cy", lens.cy, lens.height, lens.fy);
        for (const double k : lens.distortion) {
            number(name + " distortion", k, Range::between(-1e6, 1e6));
        }
        if (!lens.invertible()) { // points that the lens folds would be lost
            throw BadInput(source_, name + " distortion",
                           joined(
                               lens.distortion, [](double k) { return significant(k, 9); }, " "),
                           "coefficients that can be inverted over the whole image");
        }
    }

private:
    const std::string& source_;
};

} // namespace

void checkCamera(const CameraInfo& camera, const std::string& source) {
    const Check check(source);
    check.lens("depth", camera.depth);
    if (camera.hasColour && !camera.registered) {
        check.lens("colour", camera.colour);
        for (int i = 0; i < 3; ++i) {
            check.number("colour_T_depth", camera.colourTdepth.position[i],
                         Range::between(-kFarthestColour, kFarthestColour));
        }
    }
    check.number("depth unit", camera.metresPerUnit, Range::between(kLeastDepthUnit, kMostDepthUnit));
    check.number("sigma", camera.sigma, Range::between(0.0, 1.0));
    if (camera.beam) {
        check.number("beam sigma", camera.beam->range, Range::between(0.0, 1.0));
        check.number("beam sigma per metre", camera.beam->perMetre, Range::between(0.0, 1.0));
        check.number("beam width", camera.beam->width, Range::between(0.0, 1.0));
    }
}

bool isUsableLens(const Intrinsics& lens) {
    const std::string source;
    try {
        Check(source).lens("", lens);
    } catch (const BadInput&) {
        return false;
    }
    return true;
}

} // namespace fathom
