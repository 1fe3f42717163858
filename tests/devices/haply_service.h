// SPDX-License-Identifier: Apache-2.0
// A simulated Haply Inverse Service on a local port, as documented: an inventory on connection, then one
// state per message.
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

namespace fathom::testing {

class HaplyService {
public:
    HaplyService(); // on a free port
    explicit HaplyService(uint16_t port);
    ~HaplyService();

    uint16_t port() const { return port_; }
    std::array<double, 3> force() const; // of the newest command; zero before the first
    nlohmann::json first() const;        // first message of the newest connection

    std::atomic<double> z{0.1};                   // [m] of the handle
    std::atomic<bool> grip{false}, button{false}; // button: a
    std::atomic<bool> device{true};               // plugged into the service
    std::atomic<bool> other{false};               // another Inverse3 is plugged in and listed first
    std::atomic<bool> strange{false};             // handshake is not a WebSocket's
    std::atomic<bool> mute{false};                // does not answer
    std::atomic<bool> hold{false};                // keeps answers; all are sent with the next one
    std::atomic<bool> fragments{false};           // answers in two frames with a ping between
    std::atomic<int> garbage{0};                  // number of invalid answers
    std::atomic<int> hangUps{0};                  // number of connections that end at their next message
    std::atomic<uint64_t> messages{0}, pongs{0};

private:
    void serve();
    void speak(int socket);
    bool answer(int socket, const std::string& message);
    std::string state(bool inventory) const;

    uint16_t port_ = 0;
    int listening_ = -1;
    std::atomic<bool> stop_{false};
    mutable std::mutex mutex_;
    std::array<double, 3> force_{};
    nlohmann::json first_;
    bool introduced_ = false;
    std::string held_; // answers
    std::thread thread_;
};

} // namespace fathom::testing
