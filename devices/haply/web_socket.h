// SPDX-License-Identifier: Apache-2.0
// A WebSocket client (RFC 6455) for a service on this machine. Own code, because it needs only one text frame
// each way per tick; a library would add an event loop and TLS.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>

namespace fathom {

// Parses received bytes into messages. Pure.
class WebSocketFrames {
public:
    static constexpr size_t kMaxBytes = 1 << 20; // per message

    void add(std::string_view bytes) { bytes_.append(bytes); }

    enum class Event { None, Text, Ping, Closed, Fault }; // Fault: the peer violates the protocol
    // The next event; `text` gets the message or ping payload.
    Event next(std::string& text);

private:
    struct Header {
        bool last = false;
        uint8_t kind = 0;
        size_t at = 0;
        uint64_t size = 0;
    };
    bool head(Header& head) const; // whole?
    Event whole(const Header& head, std::string& text);

    std::string bytes_, message_; // message_: fragments so far
    bool within_ = false;         // inside a fragmented message
};

// A client frame. mask: any number, new for each frame.
std::string webSocketFrame(uint8_t kind, std::string_view payload, uint32_t mask);

// One thread.
class WebSocket {
public:
    // Connects, with at most `most` per step. Throws BadInput with the reason: no listener, or not a
    // WebSocket.
    WebSocket(const std::string& host, uint16_t port, std::chrono::milliseconds most);
    ~WebSocket(); // sends a close frame
    WebSocket(const WebSocket&) = delete;
    WebSocket& operator=(const WebSocket&) = delete;

    void send(std::string_view text); // throws DeviceLost
    // The next complete message, or nothing within `most`. Throws DeviceLost when closed, broken, or in
    // violation of the protocol.
    std::optional<std::string> receive(std::chrono::microseconds most);

    const std::string& place() const noexcept { return place_; } // "ws://HOST:PORT"

private:
    void connect(const std::string& host, uint16_t port, std::chrono::milliseconds most);
    void greet(std::chrono::milliseconds most);
    void sendFrame(uint8_t kind, std::string_view payload);
    void sendBytes(std::string_view bytes);
    bool readSome(std::chrono::microseconds most, std::string& bytes); // false: nothing came
    [[noreturn]] void lost(const std::string& why) const;
    [[noreturn]] void refuse(const std::string& why) const;

    std::string place_;
    int socket_ = -1;
    WebSocketFrames frames_;
    std::mt19937 random_{std::random_device{}()};
};

} // namespace fathom
