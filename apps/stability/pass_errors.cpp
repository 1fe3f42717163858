// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/pass_errors.h"

#include "engine/reference/guidance.h"
#include "engine/reference/surface.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

void PassError::add(const PassError& other) {
    error = other.error > error || other.error != other.error ? other.error : error;
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
    const auto twin = reference::thin(rig.scene(), rig.width(), rig.height(), rig.forbidden(), rig.points());
    const auto cells = rig.thinning();
    const double step = rig.scene().errorBudget / shared::kGrowthSteps; // radii round up to it
    PassError e;
    e.wrong += cells.size() != twin.size();
    for (size_t i = 0; i < std::min(cells.size(), twin.size()); ++i) {
        const auto compare = [&](double here, double there) {
            const bool different = (here >= 0.0) != (there >= 0.0);
            e.wrong += different && !twin[i].unsure;
            e.unsure += different && twin[i].unsure;
            if (here >= 0.0 && there >= 0.0) {
                e.add(std::max({0.0, there - here, here - there - step}) / range);
            }
        };
        compare(cells[i].whole, twin[i].whole);
        for (size_t q = 0; q < 4 && cells[i].whole < 0.0 && twin[i].whole < 0.0; ++q) {
            compare(cells[i].quarters[q], twin[i].quarters[q]);
        }
    }
    return e;
}

PassError sphereError(const PrecisionRig& rig, double range) {
    const std::vector<double> growth = rig.plan().thin
                                           ? reference::keptGrowth(rig.width(), rig.height(), rig.thinning())
                                           : std::vector<double>{};
    const auto twin = reference::spheres(rig.scene(), rig.forbidden(), rig.points(), growth);
    const auto here = rig.spheres();
    PassError e;
    for (size_t i = 0; i < twin.size(); ++i) {
        const bool both = here[i].radius >= 0.0 && twin[i].radius >= 0.0;
        e.wrong += (here[i].radius >= 0.0) != (twin[i].radius >= 0.0) || here[i].cls != twin[i].cls;
        if (both) {
            e.add(std::max(glm::distance(here[i].centre, twin[i].centre),
                           std::abs(here[i].radius - twin[i].radius)) /
                  range);
        }
    }
    return e;
}

namespace {

// Adds the margin that the passes add to a radius, so that rounding never leaves a child outside its parent.
double roundedOutward(double radius) {
    return radius * 1.000001 + 1e-7;
}

void compareBounds(const std::vector<reference::Bound>& here, const std::vector<reference::Bound>& there,
                   double range, PassError& e) {
    e.wrong += here.size() != there.size();
    for (size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
        e.wrong += here[i].count != there[i].count || (here[i].radius < 0.0) != (here[i].count == 0);
        if (here[i].count != 0 && there[i].count != 0) {
            e.add(std::max(glm::distance(here[i].centre, there[i].centre),
                           std::abs(here[i].radius - roundedOutward(there[i].radius))) /
                  range);
        }
    }
}

} // namespace

PassError treeError(const PrecisionRig& rig, double range) {
    auto levels = rig.tree();
    const auto spheres = rig.spheres();
    const int across = static_cast<int>(rig.layout().across) * 4;
    PassError e;
    std::vector<reference::Bound> leaves;
    for (size_t i = 0; i < levels[0].size(); ++i) {
        const int u0 = static_cast<int>(i) % across * 4, v0 = static_cast<int>(i) / across * 4;
        std::vector<reference::RegionSphere> inside;
        for (int v = v0; v < std::min(v0 + 4, rig.height()); ++v) {
            for (int u = u0; u < std::min(u0 + 4, rig.width()); ++u) {
                inside.push_back(spheres[static_cast<size_t>(v * rig.width() + u)]);
            }
        }
        for (const reference::RegionSphere& s : inside) {
            const double reach =
                glm::distance(s.centre - rig.origin(), levels[0][i].centre - rig.origin()) + s.radius;
            e.wrong += s.radius >= 0.0 && !(reach <= levels[0][i].radius);
        }
        leaves.push_back(reference::boundOf(inside));
    }
    compareBounds(levels[0], leaves, range, e);
    for (size_t l = 1; l < levels.size(); ++l) {
        compareBounds(levels[l], reference::parents(rig.layout(), l, levels[l - 1]), range, e);
    }
    for (auto& level : levels) { // float32 about the origin: exact in float64
        for (reference::Bound& b : level) {
            b.centre -= rig.origin();
        }
    }
    e.wrong += reference::validateTree(rig.layout(), levels).empty() ? 0 : 1;
    return e;
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
