// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/wavy_wall.h"

#include <cmath>

namespace fathom::profile {

double wallHeight(double x, double y) {
    return 0.01 * std::sin(20.0 * x) * std::cos(17.0 * y);
}

HostFixtures wavyWall(int half, double spacing) {
    HostFixtures f;
    f.frame = 0;
    f.generation = 1;
    for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
            const double x = i * spacing, y = j * spacing;
            const double noise =
                3e-4 * (std::fmod(std::abs(std::sin(i * 12.9898 + j * 78.233) * 43758.5453), 1.0) - 0.5);
            f.spheres.add({x, y, wallHeight(x, y) + noise}, kWallRadius);
        }
    }
    return f;
}

} // namespace fathom::profile
