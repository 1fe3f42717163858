// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/scene.h"

#include <algorithm>

namespace fathom {

bool Scene::hasForbiddenPoints() const {
    return std::any_of(fixtures.begin(), fixtures.end(),
                       [](const FixtureClass& f) { return f.isPoints() && f.role == Role::Forbidden; });
}

bool Scene::hasGuidance() const {
    return std::any_of(fixtures.begin(), fixtures.end(),
                       [](const FixtureClass& f) { return f.isPoints() && f.role == Role::Guidance; });
}

bool Scene::usesColour() const {
    return std::any_of(fixtures.begin(), fixtures.end(),
                       [](const FixtureClass& f) { return f.isPoints() && f.usesColour(); });
}

} // namespace fathom
