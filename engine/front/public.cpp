// SPDX-License-Identifier: Apache-2.0
#include "engine/front/public.h"

#include "engine/scene/camera_limits.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"
#include "engine/types/version.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::v0 {

Error::~Error() = default;
BadInput::~BadInput() = default;
ComputeDeviceLost::~ComputeDeviceLost() = default;

Nanoseconds now() noexcept {
    return nanosecondsOf(Clock::now());
}

const char* version() noexcept {
    return fathom::version();
}

} // namespace fathom::v0

namespace fathom::front {

namespace {

ColourFormat formatOf(v0::ColourFormat format) {
    return format == v0::ColourFormat::Rgb    ? ColourFormat::Rgb
           : format == v0::ColourFormat::Yuyv ? ColourFormat::Yuyv
                                              : ColourFormat::Rgba;
}

// A value that the enumeration does not have, as other languages may pass it.
template <class Enum>
void checkKnown(const std::string& place, const char* field, Enum value, Enum last, const char* allowed) {
    if (value < Enum{} || value > last) {
        throw BadInput(place, field, std::to_string(static_cast<long long>(value)), allowed);
    }
}

v0::State external(StepState state) noexcept {
    switch (state) {
    case StepState::Off:
        return v0::State::Off;
    case StepState::Free:
        return v0::State::Free;
    case StepState::Contact:
        return v0::State::Contact;
    case StepState::Escape:
        return v0::State::Escape;
    case StepState::Trapped:
        return v0::State::Trapped;
    case StepState::Waiting:
        return v0::State::Waiting;
    case StepState::Fading:
        break;
    }
    return v0::State::Fading;
}

Intrinsics internal(const v0::Intrinsics& lens, const std::string& place, const char* field) {
    const std::string size = sizeText(lens.width, lens.height);
    if (lens.width == 0 || lens.height == 0) {
        throw BadInput(place, field, size, "a width and a height above 0");
    }
    const auto refuse = [&](const std::string& number, double value, const char* allowed) {
        throw BadInput(place, field, size + ", " + number + " " + significant(value, 9), allowed);
    };
    for (const auto& [number, value] : {std::pair("fx", lens.fx), {"fy", lens.fy}}) {
        if (!std::isfinite(value) || value <= 0.0) {
            refuse(number, value, "a positive number of pixels");
        }
    }
    for (const auto& [number, value] : {std::pair("cx", lens.cx), {"cy", lens.cy}}) {
        if (!std::isfinite(value)) {
            refuse(number, value, "a finite number of pixels");
        }
    }
    for (size_t i = 0; i < lens.distortion.size(); ++i) {
        if (!std::isfinite(lens.distortion[i])) {
            refuse("distortion[" + std::to_string(i) + "]", lens.distortion[i], "a finite number");
        }
    }
    return {lens.width, lens.height, lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion, false};
}

// The unit [m] to which depth in metres is rounded: 0.1 mm, or the least multiple whose 16 bits reach farZ.
double floatUnit(double farZ) {
    constexpr double kFinest = 0.0001, kReach = 65535.0 * kFinest;
    return kFinest * std::max(1.0, std::ceil(farZ / kReach));
}

// A unit quaternion stays the same to the last bit.
Pose normalised(Pose pose) {
    dquat& q = pose.rotation;
    const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    if (std::isfinite(largest) && largest > 0.0 && !(std::abs(glm::dot(q, q) - 1.0) < 1e-14)) {
        q = unitOf(q);
    }
    return pose;
}

} // namespace

v0::Step external(const StepRecord& record) noexcept {
    v0::Step step;
    step.wrench = {external(record.deviceWrench.force), external(record.deviceWrench.torque)};
    step.residual = {external(record.residual.force), external(record.residual.torque)};
    step.arm = external(record.arm.posture);
    step.baseTtool = external(record.tool);
    step.baseTcommand = external(record.device);
    step.state = external(record.state);
    step.sceneAge = record.sceneAge;
    step.minGap = record.minGap;
    step.clearance = record.clearance;
    step.guidance = record.guidance;
    step.frame = record.frame;
    step.warnings = when(isOld(record.sceneAge), v0::StepWarning::OldScene) |
                    when(!record.finite, v0::StepWarning::NotFinite) |
                    when(record.stalled, v0::StepWarning::Stalled);
    for (uint32_t i = 0; i < std::min<size_t>(record.touchCount, step.contacts.size()); ++i) {
        const Touch& touch = record.touches[i];
        step.contacts[step.contactCount++] = {external(touch.point), external(touch.normal), touch.gap,
                                              touch.fixture};
    }
    return step;
}

v0::Clearance external(const SmallestGap& gap, const Tool& tool, const dvec3& origin) {
    v0::Clearance out;
    out.gap = gap.gap;
    if (gap.any()) {
        const Sphere& leaf = tool.leaves()[gap.leaf];
        out.fixture = gap.fixture;
        out.toolIndex = gap.leaf;
        out.toolCentre = external(leaf.centre);
        out.toolRadius = leaf.radius;
        out.regionCentre = external(origin + dvec3(gap.sphere));
        out.regionRadius = gap.sphere.w;
    }
    return out;
}

CameraInfo internal(const v0::CameraModel& model, double farZ) {
    const std::string place = "camera " + model.name;
    CameraInfo info;
    info.depth = internal(model.depth, place, "depth");
    info.registered = !model.colour.has_value();
    info.colour = model.colour ? internal(*model.colour, place, "colour") : info.depth;
    info.colourTdepth = info.registered ? Pose{} : normalised(internal(model.colourTdepth));
    info.metresPerUnit = model.depthFormat == v0::DepthFormat::Metres ? floatUnit(farZ) : model.metresPerUnit;
    info.hasColour = model.colourFormat != v0::ColourFormat::None;
    info.colourFormat = formatOf(model.colourFormat);
    checkKnown(place, "depthFormat", model.depthFormat, v0::DepthFormat::Metres, "Uint16 or Metres");
    checkKnown(place, "colourFormat", model.colourFormat, v0::ColourFormat::Yuyv, "None, Rgb, Rgba or Yuyv");
    if (!(info.metresPerUnit >= kLeastDepthUnit && info.metresPerUnit <= kMostDepthUnit)) {
        throw BadInput(place, "metresPerUnit", significant(info.metresPerUnit, 9), "1e-7 to 1");
    }
    if (!isFinite(info.colourTdepth)) {
        throw BadInput(place, "colourTdepth", "not finite or without a rotation", "a pose");
    }
    if (info.colourFormat == ColourFormat::Yuyv && info.colour.width % 2 != 0) {
        throw BadInput(place, "colour width", std::to_string(info.colour.width), "an even width for YUYV");
    }
    return info;
}

} // namespace fathom::front
