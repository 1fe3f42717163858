// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/talker.h"

#include <csignal>
#include <doctest/doctest.h>
#include <random>
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

uint32_t testDomain() {
    static const uint32_t domain = 1 + std::random_device()() % 200;
    return domain;
}

fathom::Ros2Request requestCamera(const std::string& more) {
    return fathom::parseRos2Request(
        "ros2:depth=/camera/depth/image_rect_raw,domain=" + std::to_string(testDomain()) + ",wait=60" + more);
}
