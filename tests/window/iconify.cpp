// SPDX-License-Identifier: Apache-2.0
#include "tests/window/iconify.h"

#include "tests/window/window_rig.h"

#include <doctest/doctest.h> // before Xlib, whose macros it cannot bear
#include <string>

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace fathom::window {

// ICCCM 4.2.8.1
bool askToClose(const std::string& display, const std::string& window) {
    Display* server = XOpenDisplay(display.c_str());
    if (server == nullptr) {
        return false;
    }
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = static_cast<::Window>(std::stoul(window));
    event.xclient.message_type = XInternAtom(server, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(server, "WM_DELETE_WINDOW", False));
    XSendEvent(server, event.xclient.window, False, NoEventMask, &event);
    XCloseDisplay(server);
    return true;
}

// ICCCM 4.1.3.1: WM_STATE is a property of two longs, and an iconic window is unmapped.
bool iconify(const std::string& display, const std::string& window, bool iconic) {
    Display* server = XOpenDisplay(display.c_str());
    if (server == nullptr) {
        return false;
    }
    const auto id = static_cast<::Window>(std::stoul(window));
    const Atom state = XInternAtom(server, "WM_STATE", False);
    const long values[2] = {iconic ? IconicState : NormalState, None};
    if (iconic) {
        XUnmapWindow(server, id);
    } else {
        XMapWindow(server, id);
    }
    XChangeProperty(server, id, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(values), 2);
    XCloseDisplay(server); // flushes all requests
    return true;
}

bool setResolution(const std::string& display, int perInch) {
    Display* server = XOpenDisplay(display.c_str());
    if (server == nullptr) {
        return false;
    }
    const std::string resource = "Xft.dpi:\t" + std::to_string(perInch) + "\n";
    XChangeProperty(server, DefaultRootWindow(server), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(resource.data()),
                    static_cast<int>(resource.size()));
    XCloseDisplay(server);
    return true;
}

void WindowRig::minimise(bool on) const {
    REQUIRE(iconify(display_, window_, on));
}

void WindowRig::askToClose() const {
    REQUIRE(window::askToClose(display_, window_));
    settle();
}

} // namespace fathom::window
