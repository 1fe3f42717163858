// SPDX-License-Identifier: Apache-2.0
// Keys and mouse: what they do to the console and, where no device is at hand, to the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_port.h"

#include <optional>
#include <span>

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
    // the tool along that view's axis. Returns where the large view was clicked: by the mouse, when it was
    // not dragged, or by Enter at the keyboard's cursor.
    std::optional<ImVec2> step(Console& console, const ViewPort& large, double toolDepth);
    const Pose& pose() const { return raw_; }

private:
    void keys(Console& console);
    void turnToPanels(Console& console);
    void moveByKeys(Console& console, const ViewPort& large);
    void moveCursor(Console& console, const ViewPort& large, const dvec3& way);
    std::optional<ImVec2> clickByMouse(const ViewPort& large);
    void moveByMouse(Console& console, const ViewPort& large, double toolDepth);
    void shift(const dvec3& base);
    void step(const dvec3& base); // rotation vector [rad]

    Pose raw_;
    dquat baseRdevice_;
    double scale_;
    bool dragging_ = false, orbiting_ = false;
    double travelled_ = 0.0; // [pixels] since the button went down
};

} // namespace fathom::operate
