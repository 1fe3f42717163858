// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/device_socket.h"

#include "engine/types/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace fathom {

// The layout is an ABI contract with bridges of other authors.
static_assert(sizeof(fathom_door_header) == 32);
static_assert(sizeof(fathom_door_hand) == 152);
static_assert(sizeof(fathom_door_wrench) == 96);
static_assert(sizeof(fathom_door_state) == 248);
static_assert(sizeof(fathom_door_sphere) == 20);
static_assert(sizeof(fathom_door_regions) == 88 + 20 * FATHOM_DOOR_SPHERES);

namespace {

bool addressOf(const std::filesystem::path& path, sockaddr_un& address) noexcept {
    address = {};
    address.sun_family = AF_UNIX;
    const auto& text = path.native();
    if (text.empty() || text.size() >= sizeof address.sun_path) {
        return false;
    }
    std::memcpy(address.sun_path, text.c_str(), text.size());
    return true;
}

int newSocket() noexcept {
    return ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what,
                         const std::string& allowed) {
    throw BadInput("socket", path.string(), what, allowed);
}

// The device whose bridge makes this socket by default; of another path, an example.
std::string deviceOf(const std::filesystem::path& path) {
    const std::string name = path.stem().string(), begin = "fathom-";
    return name.starts_with(begin) ? name.substr(begin.size()) : "falcon";
}

const char* const kPathAllowed = "a path of 1 to 107 characters";

// A stale socket file without a listener may be replaced.
void clearStale(const std::filesystem::path& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) {
        return;
    }
    if (!S_ISSOCK(status.st_mode)) {
        refuse(path, "exists and is not a socket", "an unused path");
    }
    DeviceSocket probe;
    const int error = DeviceSocket::tryConnect(path, probe);
    if (error != ECONNREFUSED) {
        refuse(path, error == EACCES ? "a socket of another user" : "another program listens here",
               "an unused path");
    }
    ::unlink(path.c_str());
}

} // namespace

uint64_t socketClock() noexcept {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<uint64_t>(t.tv_sec) * 1000000000u + static_cast<uint64_t>(t.tv_nsec);
}

std::string SocketFault::text() const {
    return std::string(found).append(" (allowed: ").append(allowed).append(")");
}

SocketFault socketFault(const fathom_door_header& header, size_t got, uint16_t kind, size_t size) {
    const auto fault = [](const char* field, size_t found, size_t allowed) {
        return SocketFault{std::string(field).append(" ").append(std::to_string(found)),
                           std::to_string(allowed)};
    };
    if (got < sizeof header) {
        return {std::to_string(got).append(" bytes"), std::to_string(size)};
    }
    if (header.magic != FATHOM_DOOR_MAGIC) {
        return {"not a valid packet", "the structs of <fathom/device_socket.h>"};
    }
    if (header.version != FATHOM_DOOR_VERSION) {
        return fault("version", header.version, FATHOM_DOOR_VERSION);
    }
    if (header.kind != kind) {
        return fault("kind", header.kind, kind);
    }
    if (got != size || header.size != size) {
        return fault("size", got != size ? got : header.size, size);
    }
    return {};
}

bool DeviceSocket::fits(const fathom_door_header& header, size_t got, uint16_t kind, size_t size) noexcept {
    return got == size && header.magic == FATHOM_DOOR_MAGIC && header.version == FATHOM_DOOR_VERSION &&
           header.kind == kind && header.size == size;
}

DeviceSocket& DeviceSocket::operator=(DeviceSocket&& other) noexcept {
    if (this != &other) {
        close();
        descriptor_ = other.release();
    }
    return *this;
}

int DeviceSocket::release() noexcept {
    return std::exchange(descriptor_, -1);
}

void DeviceSocket::close() noexcept {
    if (descriptor_ >= 0) {
        ::close(release());
    }
}

int DeviceSocket::tryConnect(const std::filesystem::path& path, DeviceSocket& out) noexcept {
    sockaddr_un address{};
    if (!addressOf(path, address)) {
        return ENAMETOOLONG;
    }
    DeviceSocket made(newSocket());
    if (!made.open() ||
        ::connect(made.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        return errno;
    }
    out = std::move(made);
    return 0;
}

DeviceSocket DeviceSocket::connect(const std::filesystem::path& path) {
    DeviceSocket endpoint;
    switch (const int error = tryConnect(path, endpoint)) {
    case 0:
        return endpoint;
    case ENAMETOOLONG:
        refuse(path, std::to_string(path.native().size()) + " characters", kPathAllowed);
    case EACCES:
        refuse(path, "no permission", "a socket that you may write to (chmod)");
    case ENOENT:
    case ECONNREFUSED:
        refuse(path, "no bridge listens",
               "the socket of a running bridge, such as `fathom guard " + deviceOf(path) + "`");
    case EAGAIN:
        refuse(path, "busy", "a bridge without another engine");
    case EPROTOTYPE:
        refuse(path, "a socket of another type", "SOCK_SEQPACKET");
    default:
        refuse(path, std::strerror(error), "the socket of a running bridge");
    }
}

DeviceSocket DeviceSocket::listen(const std::filesystem::path& path, int backlog) {
    sockaddr_un address{};
    if (!addressOf(path, address)) {
        refuse(path, std::to_string(path.native().size()) + " characters", kPathAllowed);
    }
    clearStale(path);
    DeviceSocket endpoint(newSocket());
    // No client can connect between bind and listen, so the permission applies from the start.
    if (!endpoint.open() ||
        ::bind(endpoint.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0 || ::listen(endpoint.descriptor_, backlog) != 0) {
        refuse(path, std::strerror(errno), "a path in a folder that you may write to");
    }
    return endpoint;
}

DeviceSocket DeviceSocket::accept() noexcept {
    return DeviceSocket(::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

SocketEvent DeviceSocket::sendBytes(const void* data, size_t size) noexcept {
    if (!open()) {
        return SocketEvent::Closed;
    }
    if (::send(descriptor_, data, size, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(size)) {
        return SocketEvent::Packet;
    }
    return errno == EAGAIN || errno == EINTR || errno == ENOBUFS ? SocketEvent::Empty : SocketEvent::Closed;
}

// MSG_TRUNC makes recv return the full packet length, which reveals packets that are too long.
SocketEvent DeviceSocket::receiveBytes(void* data, size_t size, size_t& got) noexcept {
    if (!open()) {
        return SocketEvent::Closed;
    }
    const ssize_t result = ::recv(descriptor_, data, size, MSG_DONTWAIT | MSG_TRUNC);
    if (result > 0) {
        got = static_cast<size_t>(result);
        return SocketEvent::Packet;
    }
    if (result < 0 && (errno == EAGAIN || errno == EINTR)) {
        return SocketEvent::Empty;
    }
    return SocketEvent::Closed;
}

std::filesystem::path defaultEndpoint(const std::string& name, const std::string& instead) {
    const char* folder = std::getenv("XDG_RUNTIME_DIR");
    if (folder == nullptr || *folder == '\0') {
        throw BadInput("socket", "path", "missing, and XDG_RUNTIME_DIR is not set", instead);
    }
    return std::filesystem::path(folder) / ("fathom-" + name + ".door");
}

} // namespace fathom
