// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/haply_service.h"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace fathom::testing {

namespace {

// As a server sends it: not masked.
std::string frame(int first, const std::string& payload) {
    std::string out{static_cast<char>(first)};
    if (payload.size() < 126) {
        out += static_cast<char>(payload.size());
    } else {
        out += static_cast<char>(126);
        out += static_cast<char>(payload.size() >> 8);
        out += static_cast<char>(payload.size());
    }
    return out + payload;
}

bool sendAll(int socket, const std::string& bytes) {
    return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

// The next whole masked frame in `bytes`, which loses it; its kind, -1 = not whole yet.
int takeFrame(std::string& bytes, std::string& payload) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(bytes[i]); };
    if (bytes.size() < 6) {
        return -1;
    }
    const size_t more = (byte(1) & 127) == 126 ? 2 : 0;
    const size_t size = more == 0 ? byte(1) & 127 : size_t{byte(2)} << 8 | byte(3);
    if (bytes.size() < 6 + more + size) {
        return -1;
    }
    payload.clear();
    for (size_t i = 0; i < size; ++i) {
        payload += static_cast<char>(byte(6 + more + i) ^ byte(2 + more + i % 4));
    }
    const int kind = (byte(1) & 128) != 0 ? byte(0) & 15 : 15; // a client masks
    bytes.erase(0, 6 + more + size);
    return kind;
}

} // namespace

HaplyService::HaplyService()
    : HaplyService(0) {}

HaplyService::HaplyService(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(listening_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    REQUIRE(::bind(listening_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
    REQUIRE(::listen(listening_, 4) == 0);
    REQUIRE(::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

HaplyService::~HaplyService() {
    stop_ = true;
    thread_.join();
    ::close(listening_);
}

std::array<double, 3> HaplyService::force() const {
    const std::lock_guard lock(mutex_);
    return force_;
}

nlohmann::json HaplyService::first() const {
    const std::lock_guard lock(mutex_);
    return first_;
}

void HaplyService::serve() {
    while (!stop_) {
        pollfd ready{listening_, POLLIN, 0};
        if (::poll(&ready, 1, 5) > 0) {
            const int socket = ::accept(listening_, nullptr, nullptr);
            if (socket >= 0) {
                speak(socket);
                ::close(socket);
            }
        }
    }
}

std::string HaplyService::state(bool inventory) const {
    nlohmann::json all = {{"inverse3", nlohmann::json::array()}};
    if (other) {
        all["inverse3"].push_back(
            {{"device_id", "0001"}, {"state", {{"cursor_position", {{"x", 9.0}, {"y", 9.0}, {"z", 9.0}}}}}});
    }
    if (device) {
        nlohmann::json one = {{"device_id", "049D"},
                              {"state", {{"cursor_position", {{"x", 0.01}, {"y", -0.12}, {"z", z.load()}}}}}};
        if (inventory) {
            one["config"] = {{"type", "inverse3"}};
        }
        all["inverse3"].push_back(one);
    }
    if (grip) {
        all["wireless_verse_grip"] = {{{"device_id", "0007"},
                                       {"state",
                                        {{"orientation", {{"w", 0.0}, {"x", 2.0}, {"y", 0.0}, {"z", 0.0}}},
                                         {"buttons", {{"a", button.load()}, {"b", false}}}}}}};
    }
    return all.dump();
}

void HaplyService::speak(int socket) {
    std::string bytes, payload;
    introduced_ = false;
    held_.clear();
    bool greeted = false;
    while (!stop_) {
        pollfd ready{socket, POLLIN, 0};
        if (::poll(&ready, 1, 5) > 0) {
            char some[4096];
            const ssize_t count = ::recv(socket, some, sizeof some, 0);
            if (count <= 0) {
                return;
            }
            bytes.append(some, static_cast<size_t>(count));
        }
        if (!greeted && bytes.find("\r\n\r\n") != std::string::npos) {
            CHECK(bytes.find("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==") != std::string::npos);
            bytes.clear();
            greeted = true;
            sendAll(socket, "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
                            "Upgrade\r\nSec-WebSocket-Accept: " +
                                std::string(strange ? "nothing" : "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") +
                                "\r\n\r\n" + frame(0x81, state(true)));
        }
        for (int kind = 0; greeted && (kind = takeFrame(bytes, payload)) >= 0;) {
            pongs += kind == 10 ? 1 : 0;
            if (kind == 8 || (kind == 1 && !answer(socket, payload))) {
                return;
            }
        }
    }
}

bool HaplyService::answer(int socket, const std::string& message) {
    const auto said = nlohmann::json::parse(message);
    {
        const std::lock_guard lock(mutex_);
        const auto& one = said.at("inverse3").at(0);
        CHECK(one.at("device_id") == "049D");
        const auto& v = one.at("commands").at("set_cursor_force").at("vector");
        force_ = {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
        CHECK(said.contains("session") == !introduced_); // once a connection
        first_ = introduced_ ? first_ : said;
        introduced_ = true;
    }
    ++messages;
    if (hangUps > 0) {
        --hangUps;
        return false;
    }
    if (mute) {
        return true;
    }
    if (garbage > 0) {
        --garbage;
        return sendAll(socket, frame(0x81, "{\"inverse3\": [")); // cut off
    }
    const std::string text = state(false);
    if (hold || !held_.empty()) {
        held_ += frame(0x81, text);
        return hold || sendAll(socket, std::exchange(held_, ""));
    }
    return fragments ? sendAll(socket, frame(0x01, text.substr(0, 10)) + frame(0x89, "are you there") +
                                           frame(0x80, text.substr(10)))
                     : sendAll(socket, frame(0x81, text));
}

} // namespace fathom::testing
