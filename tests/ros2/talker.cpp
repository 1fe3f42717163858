// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/talker.h"

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <doctest/doctest.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

Talker::Talker() {
    int in[2], out[2];
    REQUIRE(::pipe(in) == 0);
    REQUIRE(::pipe(out) == 0);
    const std::string domain = std::to_string(testDomain());
    process_ = ::fork();
    if (process_ == 0) {
        ::dup2(in[0], STDIN_FILENO);
        ::dup2(out[1], STDOUT_FILENO);
        for (const int end : {in[0], in[1], out[0], out[1]}) {
            ::close(end);
        }
        ::execl(ROS2_TALKER, ROS2_TALKER, domain.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    in_ = in[1];
    out_ = out[0];
    awaitOk();
}

Talker::~Talker() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    ::close(in_);
    ::close(out_);
}

void Talker::send(const std::string& line) const {
    const std::string text = line + "\n";
    REQUIRE(::write(in_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

void Talker::awaitOk() {
    char answer[3] = {};
    for (size_t have = 0; have < sizeof answer;) {
        const ssize_t count = ::read(out_, answer + have, sizeof answer - have);
        REQUIRE(count > 0);
        have += static_cast<size_t>(count);
    }
    REQUIRE(std::string(answer, 2) == "ok");
}

void Talker::set(const std::string& key, double value) {
    send(key + " " + std::to_string(value));
    awaitOk();
}

namespace {

// The first domain that no other test program holds. An abstract socket is like loopback: one per network
// namespace, and gone when its process ends.
uint32_t reserveDomain() {
    constexpr uint32_t kMostTried = 100; // the ports of higher ones are also given to programs at random
    for (uint32_t domain = 1; domain <= kMostTried; ++domain) {
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
    static const uint32_t domain = reserveDomain();
    return domain;
}

fathom::Ros2Request requestCamera(const std::string& more) {
    return fathom::parseRos2Request(
        "ros2:depth=/camera/depth/image_rect_raw,domain=" + std::to_string(testDomain()) + ",wait=60" + more);
}
