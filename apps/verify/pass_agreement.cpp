// SPDX-License-Identifier: Apache-2.0
#include "apps/verify/pass_agreement.h"

#include <algorithm>
#include <cmath>

namespace fathom::verify {

namespace {

void keepLargest(double& largest, double error) {
    largest = error > largest || std::isnan(error) ? error : largest;
}

// Adds the margin that the passes add to a radius, so that rounding never leaves a child outside its parent.
double roundedOutward(double radius) {
    return radius * 1.000001 + 1e-7;
}

void compareBounds(const std::vector<reference::Bound>& here, const std::vector<reference::Bound>& there,
                   TreeAgreement& a) {
    a.wrong += here.size() != there.size();
    for (size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
        a.wrong += here[i].count != there[i].count || (here[i].radius < 0.0) != (here[i].count == 0);
        if (here[i].count != 0 && there[i].count != 0) {
            ++a.nodes;
            keepLargest(a.centre, glm::distance(here[i].centre, there[i].centre));
            keepLargest(a.radius, std::abs(here[i].radius - roundedOutward(there[i].radius)));
        }
    }
}

// The spheres of a sub-patch of 4x4 pixels.
std::vector<reference::RegionSphere> spheresIn(const PassRig& rig, size_t subPatch,
                                               const std::vector<reference::RegionSphere>& all) {
    const auto across = static_cast<int>(rig.layout().across) * 4, index = static_cast<int>(subPatch);
    const int u0 = index % across * 4, v0 = index / across * 4;
    std::vector<reference::RegionSphere> inside;
    for (int v = v0; v < std::min(v0 + 4, rig.height()) && !all.empty(); ++v) {
        for (int u = u0; u < std::min(u0 + 4, rig.width()); ++u) {
            inside.push_back(all[static_cast<size_t>(v * rig.width() + u)]);
        }
    }
    return inside;
}

// Checks that every sphere is inside its sub-patch's bound. Returns the twin's bounds.
std::vector<reference::Bound> checkLeaves(const PassRig& rig, const std::vector<reference::Bound>& bounds,
                                          TreeAgreement& a) {
    const auto seen = rig.spheres();
    const auto held = rig.plan().hold ? rig.spheres(true) : std::vector<reference::RegionSphere>{};
    std::vector<reference::Bound> twin;
    for (size_t i = 0; i < bounds.size(); ++i) {
        auto inside = spheresIn(rig, i, seen);
        const auto more = spheresIn(rig, i, held);
        inside.insert(inside.end(), more.begin(), more.end());
        for (const reference::RegionSphere& s : inside) {
            const double reach =
                glm::distance(s.centre - rig.origin(), bounds[i].centre - rig.origin()) + s.radius;
            a.escaped += s.radius >= 0.0 && !(reach <= bounds[i].radius);
        }
        twin.push_back(reference::boundOf(inside));
    }
    return twin;
}

} // namespace

ThinAgreement thinAgreement(const PassRig& rig) {
    const auto twin = reference::thin(rig.scene(), rig.width(), rig.height(), rig.forbidden(), rig.points());
    const auto cells = rig.thinning();
    const double step = rig.scene().errorBudget / shared::kGrowthSteps; // radii round up to it
    ThinAgreement a;
    a.wrong += cells.size() != twin.size();
    for (size_t i = 0; i < std::min(cells.size(), twin.size()); ++i) {
        const auto compare = [&](double here, double there) {
            const bool different = (here >= 0.0) != (there >= 0.0);
            a.wrong += different && !twin[i].unsure;
            a.unsure += different && twin[i].unsure;
            a.thinned += here >= 0.0;
            if (here >= 0.0 && there >= 0.0) {
                ++a.compared;
                keepLargest(a.growth, std::max({0.0, there - here, here - there - step}));
            }
        };
        ++a.cells;
        compare(cells[i].whole, twin[i].whole);
        for (size_t q = 0; q < 4 && cells[i].whole < 0.0 && twin[i].whole < 0.0; ++q) {
            compare(cells[i].quarters[q], twin[i].quarters[q]);
        }
    }
    return a;
}

SphereAgreement sphereAgreement(const PassRig& rig) {
    const std::vector<double> growth = rig.plan().thin
                                           ? reference::keptGrowth(rig.width(), rig.height(), rig.thinning())
                                           : std::vector<double>{};
    const auto twin = reference::spheres(rig.scene(), rig.forbidden(), rig.points(), growth);
    const auto here = rig.spheres();
    SphereAgreement a;
    for (size_t i = 0; i < twin.size(); ++i) {
        a.spheres += here[i].radius >= 0.0;
        a.wrong += (here[i].radius >= 0.0) != (twin[i].radius >= 0.0) || here[i].cls != twin[i].cls;
        if (here[i].radius >= 0.0 && twin[i].radius >= 0.0) {
            ++a.compared;
            keepLargest(a.centre, glm::distance(here[i].centre, twin[i].centre));
            keepLargest(a.radius, std::abs(here[i].radius - twin[i].radius));
        }
    }
    return a;
}

TreeAgreement treeAgreement(const PassRig& rig) {
    auto levels = rig.tree();
    TreeAgreement a;
    compareBounds(levels[0], checkLeaves(rig, levels[0], a), a);
    compareBounds(levels[1], reference::parents(rig.layout(), 1, levels[0]), a);
    auto above = levels[1];
    for (size_t l = 2; l < rig.layout().levels.size(); ++l) {
        above = reference::parents(rig.layout(), l, above);
        a.nodes += static_cast<uint64_t>(std::ranges::count_if(above, &reference::Bound::count));
    }
    for (auto& level : levels) { // float32 about the origin: exact in float64
        for (reference::Bound& b : level) {
            b.centre -= rig.origin();
        }
    }
    a.fault = reference::validateTree(rig.layout(), levels);
    return a;
}

} // namespace fathom::verify
