// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/pass_errors.h"

#include "apps/verify/pass_agreement.h"
#include "engine/reference/guidance.h"
#include "engine/reference/surface.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

// NaN when one is.
double larger(double a, double b) {
    return b > a || std::isnan(b) ? b : a;
}

} // namespace

void PassError::add(const PassError& other) {
    error = larger(error, other.error);
    values += other.values;
    wrong += other.wrong;
    unsure += other.unsure;
}

PassError classifyError(const PrecisionRig& rig) {
    const reference::CellImage cells = rig.plan().occlusion ? rig.cells() : reference::CellImage{};
    const auto twin = reference::classify(rig.view(), rig.plan().occlusion ? &cells : nullptr);
    const std::vector<uint32_t> masks = rig.masks();
    PassError e;
    for (size_t i = 0; i < masks.size(); ++i) {
        ++e.values;
        e.unsure += twin.unsure[i];
        e.wrong += masks[i] != twin.masks[i] && twin.unsure[i] == 0;
    }
    return e;
}

PassError surfaceError(const PrecisionRig& rig, double range) {
    const auto twin = reference::surface(rig.view(), rig.masks());
    const reference::PointImage points = rig.points();
    PassError e;
    for (size_t i = 0; i < points.z.size(); ++i) {
        const bool here = points.z[i] != 0.0, there = twin.points.z[i] != 0.0;
        e.unsure += twin.unsure[i];
        e.wrong += here != there && twin.unsure[i] == 0;
        if (here && there) {
            e.add(std::max(glm::distance(points.at[i], twin.points.at[i]),
                           std::abs(points.z[i] - twin.points.z[i])) /
                  range);
        }
    }
    return e;
}

PassError thinError(const PrecisionRig& rig, double range) {
    const verify::ThinAgreement a = verify::thinAgreement(rig);
    return {a.growth / range, a.compared, a.wrong, a.unsure};
}

PassError sphereError(const PrecisionRig& rig, double range) {
    const verify::SphereAgreement a = verify::sphereAgreement(rig);
    return {larger(a.centre, a.radius) / range, a.compared, a.wrong};
}

PassError treeError(const PrecisionRig& rig, double range) {
    const verify::TreeAgreement a = verify::treeAgreement(rig);
    return {larger(a.centre, a.radius) / range, a.nodes, a.escaped + a.wrong + (a.fault.empty() ? 0 : 1)};
}

PassError momentsError(const PrecisionRig& rig, double range) {
    const auto twin = reference::moments(reference::pointsOfClass(rig.masks(), rig.points(), 1));
    const GuidancePose& pose = rig.host().guidance.at(0);
    PassError e;
    e.wrong += pose.count != twin.count;
    if (twin.count > 0.0) {
        e.add(glm::distance(pose.position, twin.mean) / range);
    }
    return e;
}

PassError guidanceError(const PrecisionRig& rig) {
    const auto points = reference::pointsOfClass(rig.masks(), rig.points(), 1);
    const GuidancePose twin =
        reference::guidance(points, rig.scene().fixtures[1], rig.scene().baseTcamera.position);
    const GuidancePose& pose = rig.host().guidance.at(0);
    PassError e;
    e.wrong += pose.count != twin.count || pose.planar != twin.planar || pose.present != twin.present;
    if (pose.planar && twin.planar) {
        e.add(std::atan2(glm::length(glm::cross(pose.normal, twin.normal)),
                         glm::dot(pose.normal, twin.normal)));
    }
    return e;
}

PassError occlusionError(const PrecisionRig& rig, double range) {
    const reference::CellBounds twin = reference::occlusion(rig.view(), 1e-3);
    const reference::CellImage cells = rig.cells();
    PassError e;
    e.wrong += cells.nearest.size() != twin.sure.nearest.size();
    for (size_t i = 0; i < std::min(cells.nearest.size(), twin.sure.nearest.size()); ++i) {
        const double z = cells.nearest[i], least = twin.possible.nearest[i], most = twin.sure.nearest[i];
        if (std::isfinite(z) || std::isfinite(most)) {
            e.add(std::max(
                      {0.0, std::isfinite(least) ? least - z : 0.0, std::isfinite(most) ? z - most : 0.0}) /
                  range);
            e.wrong += std::isfinite(z) && !std::isfinite(least);
        }
    }
    return e;
}

PassError holdError(const PrecisionRig& rig, reference::HoldMemory& twin, double now, double before,
                    double range) {
    const auto there = twin.step(rig.view(), now, before, rig.forbidden(), rig.points());
    const auto here = rig.spheres(true);
    PassError e;
    for (size_t i = 0; i < here.size(); ++i) {
        const bool unsure = twin.unsure()[i] != 0;
        e.unsure += unsure;
        if (here[i].cls != there[i].cls) {
            e.wrong += !unsure;
        } else if (here[i].cls >= 0 && !unsure) {
            e.add(std::max(glm::distance(here[i].centre, there[i].centre),
                           std::abs(here[i].radius - there[i].radius)) /
                  range);
        }
    }
    return e;
}

} // namespace fathom::stability
