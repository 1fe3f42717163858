// SPDX-License-Identifier: Apache-2.0
// A WebSocket (RFC 6455) to a service on this machine: text both ways. Written here because all that is
// spoken is one text frame each way a tick; a library would bring an event loop and TLS.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>

namespace fathom {

// What arrives, byte by byte, as messages. Pure.
class WebSocketFrames {
public:
    static constexpr size_t kMostBytes = 1 << 20; // of a message

    void add(std::string_view bytes) { bytes_.append(bytes); }

    enum class Event { None, Text, Ping, Closed, Fault }; // Fault: the other end breaks the protocol
    // The next event; `text` is of the message or the ping.
    Event next(std::string& text);

private:
    struct Head {
        bool last = false;
        uint8_t kind = 0;
        size_t at = 0;
        uint64_t size = 0;
    };
    bool head(Head& head) const; // whole?
    Event whole(const Head& head, std::string& text);

    std::string bytes_, message_; // message_: fragments so far
    bool within_ = false;         // a message that is not whole yet
};

// A frame as a client sends it. mask: any number, a new one each time.
std::string webSocketFrame(uint8_t kind, std::string_view payload, uint32_t mask);

// One thread.
class WebSocket {
public:
    // Connects within `most` of each step. Throws Error that says what stands against it: nobody listens, no
    // WebSocket there.
    WebSocket(const std::string& host, uint16_t port, std::chrono::milliseconds most);
    ~WebSocket(); // says goodbye
    WebSocket(const WebSocket&) = delete;
    WebSocket& operator=(const WebSocket&) = delete;

    void send(std::string_view text); // throws DeviceLost
    // The next whole message, or nothing within `most`. Throws DeviceLost: closed, broken, or against the
    // protocol.
    std::optional<std::string> receive(std::chrono::microseconds most);

    const std::string& place() const noexcept { return place_; } // "ws://HOST:PORT"

private:
    void connect(const std::string& host, uint16_t port, std::chrono::milliseconds most);
    void greet(std::chrono::milliseconds most);
    void sendFrame(uint8_t kind, std::string_view payload);
    void sendBytes(std::string_view bytes);
    bool readSome(std::chrono::microseconds most, std::string& bytes); // false: nothing came
    [[noreturn]] void lost(const std::string& why) const;

    std::string place_;
    int socket_ = -1;
    WebSocketFrames frames_;
    std::mt19937 random_{std::random_device{}()};
};

} // namespace fathom
