// SPDX-License-Identifier: Apache-2.0
// A scene of two forbidden classes, and images whose left half has the first one and the right half the
// other.
#pragma once

#include "tests/support/cloud_rig.h"

namespace fathom::testing {

inline Scene redAndBlueScene() {
    Scene scene = plainScene();
    scene.fixtures[0].hue = Band{345, 15};
    FixtureClass blue = forbiddenClass("blue", 0.03);
    blue.hue = Band{225, 255};
    scene.fixtures.push_back(blue);
    return scene;
}

// Depths of the halves [m].
inline Image redAndBlueImage(const CameraInfo& camera, double red, double blue) {
    const int middle = static_cast<int>(camera.depth.width / 2);
    Image image = drawnImage(
        camera, [&](int u, int) { return u < middle ? red : blue; }, 0xff2020c0);
    for (size_t i = 0; i < image.colour.size(); ++i) {
        image.colour[i] = static_cast<int>(i % camera.depth.width) < middle ? 0xff2020c0 : 0xffc02020;
    }
    return image;
}

} // namespace fathom::testing
