// SPDX-License-Identifier: Apache-2.0
#include "tests/window/iconify.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <string>

namespace fathom::window {

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

} // namespace fathom::window
