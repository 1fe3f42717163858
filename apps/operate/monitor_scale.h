// SPDX-License-Identifier: Apache-2.0
// How large text has to be on a monitor, by its resolution.
#pragma once

struct GLFWmonitor;
struct GLFWwindow;

namespace fathom::operate {

// What is known of a monitor.
struct MonitorFigures {
    double desktop = 1.0; // the desktop's own scale for it; 1 = none is set
    int width = 0;        // [pixels]
    int millimetres = 0;  // width; 0 or nonsense = not known
    double stretch = 1.0; // pixels of the framebuffer per unit of the window's size
};

// Text at 1 is made for 96 pixels per inch. Takes the desktop's scale, or else the resolution where its
// figures make sense. From 1 to 2.5, in steps of an eighth.
double monitorScale(const MonitorFigures& figures);

// Main thread. Of the monitor with the centre of the window, or of the first one without a window.
MonitorFigures monitorOf(GLFWwindow* window);
// The monitor that has the middle of the window, else the first one; null without a monitor.
GLFWmonitor* monitorWith(GLFWwindow* window);

} // namespace fathom::operate
