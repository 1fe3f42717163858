// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/monitor_scale.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>

namespace fathom::operate {

GLFWmonitor* monitorWith(GLFWwindow* window) {
    int count = 0, x = 0, y = 0, width = 0, height = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    if (window != nullptr && count > 1) {
        glfwGetWindowPos(window, &x, &y);
        glfwGetWindowSize(window, &width, &height);
        for (int i = 0; i < count; ++i) {
            int left = 0, top = 0;
            glfwGetMonitorPos(monitors[i], &left, &top);
            const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
            const int u = x + width / 2 - left, v = y + height / 2 - top;
            if (mode != nullptr && u >= 0 && v >= 0 && u < mode->width && v < mode->height) {
                return monitors[i];
            }
        }
    }
    return count > 0 ? monitors[0] : nullptr;
}

double monitorScale(const MonitorFigures& figures) {
    constexpr double kUsual = 96.0, kLowest = 40.0, kHighest = 700.0; // [pixels per inch]
    constexpr double kStep = 0.125, kMax = 2.5;
    double scale = figures.desktop;
    if (scale == 1.0 && figures.millimetres > 0) {
        const double perInch = 25.4 * figures.width / figures.millimetres;
        scale = perInch > kLowest && perInch < kHighest ? perInch / kUsual : 1.0;
    }
    scale /= std::max(1.0, figures.stretch);
    return std::clamp(kStep * std::floor(scale / kStep + 1e-6), 1.0, kMax);
}

MonitorFigures monitorOf(GLFWwindow* window) {
    MonitorFigures figures;
    GLFWmonitor* const monitor = monitorWith(window);
    if (monitor == nullptr) {
        return figures;
    }
    float x = 1.0f, y = 1.0f;
    if (window != nullptr) {
        int pixels = 0, units = 0, ignored = 0;
        glfwGetFramebufferSize(window, &pixels, &ignored);
        glfwGetWindowSize(window, &units, &ignored);
        figures.stretch = units > 0 ? static_cast<double>(pixels) / units : 1.0;
        glfwGetWindowContentScale(window, &x, &y);
    } else {
        glfwGetMonitorContentScale(monitor, &x, &y);
    }
    figures.desktop = static_cast<double>(x);
    int high = 0;
    glfwGetMonitorPhysicalSize(monitor, &figures.millimetres, &high);
    const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
    figures.width = mode != nullptr ? mode->width : 0;
    return figures;
}

} // namespace fathom::operate
