// SPDX-License-Identifier: Apache-2.0
// Keys and mouse: what they do to the console and, where no device is at hand, to the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_port.h"
#include "devices/haptic_device.h"

namespace fathom::operate {

// Each key that does something, for the help; the first is the only one that works while text is typed.
struct KeyHelp {
    const char* keys;
    const char* what;
};
std::span<const KeyHelp> keyHelp();

class Steering {
public:
    Steering(const Pose& start, const Scene::Hand& hand); // raw

    // One window frame: reads ImGui's events. `large`: the view that the mouse drags in. toolDepth [m]: of
    // the tool along that view's axis. Returns whether the mouse was clicked (not dragged) in the large view.
    bool step(Console& console, const ViewPort& large, double toolDepth);
    HandSample wish(const Console& console) const;

private:
    void keys(Console& console);
    void moveByKeys(const ViewPort& large, bool text);
    void moveByMouse(Console& console, const ViewPort& large, double toolDepth);
    void shift(const dvec3& base);
    void turn(const dvec3& base); // rotation vector [rad]

    Pose raw_;
    dquat baseRdevice_;
    double scale_;
    bool dragging_ = false, orbiting_ = false;
    double travelled_ = 0.0; // [pixels] since the button went down
};

} // namespace fathom::operate
