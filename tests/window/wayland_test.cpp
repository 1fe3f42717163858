// SPDX-License-Identifier: Apache-2.0
// The window in a session of Wayland that also offers X. GLFW before 3.4 has X only, so there this holds
// whatever the program asks for.
#include "tests/support/scratch_folder.h"
#include "tests/window/window_rig.h"

#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <utility>

using namespace fathom;
using namespace fathom::window;
using nlohmann::json;

namespace {

// A Wayland server that accepts connections and never answers.
class SilentWayland {
public:
    SilentWayland() {
        const std::string path = (folder_.path() / "wayland-0").string();
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        REQUIRE(path.size() < sizeof(address.sun_path));
        std::ranges::copy(path, address.sun_path);
        REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
        REQUIRE(::listen(socket_, 4) == 0);
        ::setenv("XDG_SESSION_TYPE", "wayland", 1);
        ::setenv("WAYLAND_DISPLAY", path.c_str(), 1); // an absolute path needs no XDG_RUNTIME_DIR
    }
    ~SilentWayland() {
        ::unsetenv("WAYLAND_DISPLAY");
        ::unsetenv("XDG_SESSION_TYPE");
        ::close(socket_);
    }
    SilentWayland(const SilentWayland&) = delete;
    SilentWayland& operator=(const SilentWayland&) = delete;

private:
    testing::ScratchFolder folder_;
    int socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
};

} // namespace

TEST_CASE(
    "In a session of Wayland the window opens on X, which reports that it is minimised, so forces go off") {
    const SilentWayland wayland;
    WindowRig rig;
    rig.key("a");
    REQUIRE(rig.await([](const json& s) { return s["mode"] == "ARMED"; }));
    rig.minimise(true);
    CHECK(rig.await([](const json& s) { return s["console"]["forces"] == false; }));
    closeQuietly(rig);
}
