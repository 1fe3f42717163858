// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/peer.h"

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

Peer::Peer(const std::string& program, const std::vector<std::string>& arguments) {
    int in[2], out[2];
    REQUIRE(::pipe2(in, O_CLOEXEC) == 0); // other peers must not hold them open
    REQUIRE(::pipe2(out, O_CLOEXEC) == 0);
    std::vector<char*> words{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) {
        words.push_back(const_cast<char*>(argument.c_str()));
    }
    words.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
        ::dup2(in[0], STDIN_FILENO);
        ::dup2(out[1], STDOUT_FILENO);
        ::execv(program.c_str(), words.data());
        ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    in_ = in[1];
    out_ = out[0];
}

Peer::~Peer() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    ::close(in_);
    ::close(out_);
}

void Peer::send(const std::string& line) const {
    const std::string text = line + "\n";
    REQUIRE(::write(in_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

void Peer::stop() const {
    ::kill(process_, SIGSTOP);
}

std::optional<std::string> Peer::line(std::chrono::seconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    for (;;) {
        if (const size_t at = rest_.find('\n'); at != std::string::npos) {
            const std::string first = rest_.substr(0, at);
            rest_.erase(0, at + 1);
            return first;
        }
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        pollfd readable{out_, POLLIN, 0};
        char bytes[4096];
        if (left.count() <= 0 || ::poll(&readable, 1, static_cast<int>(left.count())) <= 0) {
            return std::nullopt;
        }
        const ssize_t count = ::read(out_, bytes, sizeof bytes);
        if (count <= 0) {
            return std::nullopt;
        }
        rest_.append(bytes, static_cast<size_t>(count));
    }
}

namespace {

// The first domain that no other test program holds. An abstract socket is like loopback: one per network
// namespace, and gone when its process ends.
uint32_t reserveDomain() {
    constexpr uint32_t kMaxTried = 100; // the ports of higher ones are also given to programs at random
    for (uint32_t domain = 1; domain <= kMaxTried; ++domain) {
        sockaddr_un name{AF_UNIX, {}};
        const int length =
            std::snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "fathom-test-ros2-domain-%u", domain);
        const int held = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const auto size =
            static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1) + static_cast<socklen_t>(length);
        if (::bind(held, reinterpret_cast<const sockaddr*>(&name), size) == 0) {
            return domain;
        }
        ::close(held);
    }
    throw std::runtime_error("no domain of DDS is free for this test");
}

} // namespace

uint32_t testDomain() {
    static const uint32_t kDomain = reserveDomain();
    return kDomain;
}
