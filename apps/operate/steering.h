// SPDX-License-Identifier: Apache-2.0
// Keys and mouse: change the console and, without a haptic device, move the tool.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/view_port.h"

#include <optional>
#include <span>

namespace fathom::operate {

// All keys for the help panel; only the first works during text input.
struct KeyHelp {
    const char* keys;
    const char* what;
};
std::span<const KeyHelp> keyHelp();

// Translates the input of a window frame into console changes and a raw hand pose.
class Steering {
public:
    Steering(const Pose& start, const Scene::Hand& hand); // start: raw device pose

    // Handles the input of one window frame. large: the view for mouse drags. toolDepth [m]: depth of the
    // tool along that view's axis. Returns where the large view was clicked, by the mouse without a drag or
    // by Enter at the keyboard cursor.
    std::optional<ImVec2> step(Console& console, const ViewPort& large, double toolDepth);
    const Pose& pose() const { return raw_; }

private:
    void keys(Console& console);
    void lookByKeys(Console& console);
    void switchFocus(Console& console);
    void moveByKeys(Console& console, const ViewPort& large);
    void moveCursor(Console& console, const ViewPort& large, const dvec3& direction);
    std::optional<ImVec2> clickByMouse(const ViewPort& large);
    void moveByMouse(Console& console, const ViewPort& large, double toolDepth);
    void shift(const dvec3& base);
    void rotate(const dvec3& base); // rotation vector [rad]

    Pose raw_;
    dquat baseRdevice_;
    double scale_;
    bool dragging_ = false, orbiting_ = false;
    double travelled_ = 0.0; // [pixels] since the button went down
};

} // namespace fathom::operate
