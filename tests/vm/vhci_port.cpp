// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/vhci_port.h"
#include "tests/support/eventually.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom::vm {

namespace {

constexpr const char* kFolder = "/sys/devices/platform/vhci_hcd.0/";
constexpr int kPortFree = 4; // VDEV_ST_NULL

// Calls row(kind, port, status) for every port until it returns true.
bool anyPort(const std::function<bool(const std::string&, int, int)>& row) {
    std::ifstream file(std::string(kFolder) + "status");
    if (!file) {
        throw std::runtime_error(std::string(kFolder) + "status cannot be read: modprobe vhci-hcd, as root");
    }
    std::string line;
    std::getline(file, line); // the header
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string kind;
        int port = -1, status = -1;
        if (words >> kind >> port >> status && row(kind, port, status)) {
            return true;
        }
    }
    return false;
}

} // namespace

int freeVhciPort() {
    int found = -1;
    // The ports called "hs" serve low, full and high speed.
    anyPort([&](const std::string& kind, int port, int status) {
        const bool usable = kind == "hs" && status == kPortFree;
        found = usable ? port : found;
        return usable;
    });
    if (found < 0) {
        throw std::runtime_error("vhci_hcd: no free port");
    }
    return found;
}

int attachVhci(int port, int speed) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        throw std::runtime_error(std::string("socketpair: ") + std::strerror(errno));
    }
    const std::string words = std::to_string(port) + ' ' + std::to_string(ends[1]) + ' ' +
                              std::to_string(0x10001 + port) + ' ' + std::to_string(speed);
    const int file = ::open((std::string(kFolder) + "attach").c_str(), O_WRONLY | O_CLOEXEC);
    const bool done =
        file >= 0 && ::write(file, words.data(), words.size()) == static_cast<ssize_t>(words.size());
    const int error = errno;
    if (file >= 0) {
        ::close(file);
    }
    ::close(ends[1]);
    if (!done) {
        ::close(ends[0]);
        throw std::runtime_error(std::string(kFolder) + "attach: " + std::strerror(error));
    }
    return ends[0];
}

void waitUntilVhciFree(int wanted) {
    waitFor(
        [wanted] {
            return anyPort([wanted](const std::string&, int port, int status) {
                return port == wanted && status == kPortFree;
            });
        },
        std::chrono::milliseconds(2000));
}

bool waitFor(const std::function<bool()>& condition, std::chrono::milliseconds most) {
    return testing::eventually(condition, most);
}

bool waitForFile(const std::filesystem::path& file, std::chrono::milliseconds most) {
    return waitFor([&file] { return std::filesystem::exists(file); }, most);
}

} // namespace fathom::vm
