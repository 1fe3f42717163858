// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/scene.h"

#include "engine/types/joined.h"

#include <algorithm>

namespace fathom {

bool Scene::hasPoints() const {
    return std::ranges::any_of(fixtures, [](const FixtureClass& f) { return f.isPoints(); });
}

bool Scene::hasForbiddenPoints() const {
    return std::ranges::any_of(
        fixtures, [](const FixtureClass& f) { return f.isPoints() && f.role == Role::Forbidden; });
}

bool Scene::hasGuidance() const {
    return std::ranges::any_of(
        fixtures, [](const FixtureClass& f) { return f.isPoints() && f.role == Role::Guidance; });
}

bool Scene::usesColour() const {
    return std::ranges::any_of(fixtures,
                               [](const FixtureClass& f) { return f.isPoints() && f.usesColour(); });
}

double Scene::filterBound() const {
    double least = 1e6; // [m] no bound
    for (const FixtureClass& f : fixtures) {
        const bool counts = f.isPoints() && f.role == Role::Forbidden && !f.name.empty(); // not a spare class
        least = counts ? std::min(least, 0.4 * (f.radius + 3.0 * registrationSigma)) : least;
    }
    return least;
}

std::string Scene::pilotNames() const {
    return joined(pilots, &Pilot::name);
}

bool Scene::choosePilot(const std::string& name) {
    const auto at = std::ranges::find(pilots, name, &Pilot::name);
    if (at == pilots.end()) {
        return false;
    }
    pilot = name;
    haptics = at->haptics;
    hand.scale = at->scale;
    return true;
}

} // namespace fathom
