// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/web_socket.h"

#include "engine/types/clock.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr uint8_t kContinued = 0, kText = 1, kClose = 8, kPing = 9, kPong = 10;
// The example pair of RFC 6455, 1.3. A random key would defeat caching proxies; between two programs on one
// machine there is none.
constexpr const char* kKey = "dGhlIHNhbXBsZSBub25jZQ==";
constexpr const char* kAccept = "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=";
constexpr size_t kMaxGreeting = 8192; // [bytes]

bool waitFor(int socket, short events, std::chrono::microseconds most) {
    pollfd ready{socket, events, 0};
    const timespec timeout{static_cast<time_t>(most.count() / 1'000'000),
                           static_cast<long>(most.count() % 1'000'000 * 1000)};
    return ::ppoll(&ready, 1, &timeout, nullptr) > 0;
}

} // namespace

bool WebSocketFrames::head(Header& head) const {
    const auto byte = [this](size_t i) { return static_cast<uint8_t>(bytes_[i]); };
    if (bytes_.size() < 2) {
        return false;
    }
    head.last = (byte(0) & 0x80) != 0;
    head.kind = byte(0) & 15;
    head.size = byte(1); // servers do not mask: a set bit 7 makes the size invalid
    head.at = 2;
    const size_t more = head.size == 126 ? 2 : head.size == 127 ? 8 : 0;
    if (bytes_.size() < head.at + more) {
        return false;
    }
    if (more > 0) {
        head.size = 0;
        for (size_t i = 0; i < more; ++i) {
            head.size = head.size << 8 | byte(head.at + i);
        }
        head.at += more;
    } else if (head.size > 127) {
        head.size = ~uint64_t{0};
    }
    return head.size > kMaxBytes || bytes_.size() - head.at >= head.size;
}

WebSocketFrames::Event WebSocketFrames::next(std::string& text) {
    Header frame;
    while (head(frame)) {
        const bool reserved = (static_cast<uint8_t>(bytes_[0]) & 0x70) != 0;
        if (reserved || frame.size > kMaxBytes || message_.size() + frame.size > kMaxBytes) {
            return Event::Fault;
        }
        const Event event = whole(frame, text);
        if (event != Event::None) {
            return event;
        }
    }
    return Event::None;
}

WebSocketFrames::Event WebSocketFrames::whole(const Header& frame, std::string& text) {
    const std::string payload = bytes_.substr(frame.at, frame.size);
    bytes_.erase(0, frame.at + frame.size);
    switch (frame.kind) {
    case kText:
    case kContinued:
        if (within_ != (frame.kind == kContinued)) {
            return Event::Fault;
        }
        message_ += payload;
        within_ = !frame.last;
        if (frame.last) {
            text = std::exchange(message_, {});
            return Event::Text;
        }
        return Event::None;
    case kPing:
        text = payload;
        return frame.last && payload.size() < 126 ? Event::Ping : Event::Fault;
    case kPong:
        return Event::None;
    case kClose:
        return Event::Closed;
    default: // binary messages are not supported
        return Event::Fault;
    }
}

std::string webSocketFrame(uint8_t kind, std::string_view payload, uint32_t mask) {
    std::string frame{static_cast<char>(0x80 | kind)};
    const size_t size = payload.size();
    const int more = size < 126 ? 0 : size < 65536 ? 2 : 8;
    frame += static_cast<char>(0x80 | (more == 0 ? size : more == 2 ? 126 : 127));
    for (int i = more - 1; i >= 0; --i) {
        frame += static_cast<char>(uint64_t{size} >> (8 * i));
    }
    char key[4];
    std::memcpy(key, &mask, sizeof key);
    frame.append(key, sizeof key);
    for (size_t i = 0; i < size; ++i) {
        frame += static_cast<char>(payload[i] ^ key[i % 4]);
    }
    return frame;
}

WebSocket::WebSocket(const std::string& host, uint16_t port, std::chrono::milliseconds most)
    : place_("ws://" + host + ":" + std::to_string(port)) {
    connect(host, port, most);
    try {
        greet(most);
    } catch (...) {
        ::close(socket_);
        throw;
    }
}

WebSocket::~WebSocket() {
    try {
        sendFrame(kClose, std::string_view("\x03\xe8", 2)); // 1000: normal closure
    } catch (const Error&) {                                // already lost
    }
    ::close(socket_);
}

void WebSocket::lost(const std::string& why) const {
    throw DeviceLost(place_ + ": " + why);
}

void WebSocket::refuse(const std::string& why) const {
    throw BadInput("haply", place_, why, "a running Haply Inverse Service, or --service HOST:PORT");
}

void WebSocket::connect(const std::string& host, uint16_t port, std::chrono::milliseconds most) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (const int no = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); no != 0) {
        refuse(::gai_strerror(no));
    }
    std::string why = "no answer";
    for (const addrinfo* one = found; one != nullptr && socket_ < 0; one = one->ai_next) {
        const int made = ::socket(one->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        const bool begun =
            made >= 0 && (::connect(made, one->ai_addr, one->ai_addrlen) == 0 || errno == EINPROGRESS);
        int error = begun ? 0 : errno;
        socklen_t size = sizeof error;
        if (begun &&
            (!waitFor(made, POLLOUT, most) || ::getsockopt(made, SOL_SOCKET, SO_ERROR, &error, &size) != 0)) {
            error = ETIMEDOUT;
        }
        if (error == 0) {
            socket_ = made;
        } else {
            why = std::strerror(error);
            ::close(made);
        }
    }
    ::freeaddrinfo(found);
    if (socket_ < 0) {
        refuse(why);
    }
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on); // one small message per tick
}

void WebSocket::greet(std::chrono::milliseconds most) {
    const std::string host = place_.substr(place_.find("//") + 2);
    sendBytes("GET / HTTP/1.1\r\nHost: " + host +
              "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: " + kKey +
              "\r\nSec-WebSocket-Version: 13\r\n\r\n");
    std::string said;
    const auto until = Clock::now() + most;
    size_t end = std::string::npos;
    while (end == std::string::npos) {
        if (Clock::now() > until || said.size() > kMaxGreeting) {
            refuse("no answer to the handshake");
        }
        readSome(most, said);
        end = said.find("\r\n\r\n");
    }
    const std::string answer = said.substr(0, end);
    if (answer.find(" 101 ") == std::string::npos || answer.find(kAccept) == std::string::npos) {
        refuse("not a WebSocket: " + answer.substr(0, answer.find('\r')).substr(0, 80));
    }
    frames_.add(std::string_view(said).substr(end + 4));
}

bool WebSocket::readSome(std::chrono::microseconds most, std::string& bytes) {
    char some[4096];
    if (!waitFor(socket_, POLLIN, most)) {
        return false;
    }
    const ssize_t count = ::recv(socket_, some, sizeof some, 0);
    if (count == 0) {
        lost("closed by the service");
    }
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
        lost(std::strerror(errno));
    }
    bytes.append(some, static_cast<size_t>(std::max<ssize_t>(0, count)));
    return count > 0;
}

void WebSocket::sendBytes(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count > 0) {
            bytes.remove_prefix(static_cast<size_t>(count));
        } else if (errno == EAGAIN) { // the service hangs
            if (!waitFor(socket_, POLLOUT, std::chrono::milliseconds(100))) {
                lost("takes nothing");
            }
        } else if (errno != EINTR) {
            lost(std::strerror(errno));
        }
    }
}

void WebSocket::sendFrame(uint8_t kind, std::string_view payload) {
    sendBytes(webSocketFrame(kind, payload, static_cast<uint32_t>(random_())));
}

void WebSocket::send(std::string_view text) {
    sendFrame(kText, text);
}

std::optional<std::string> WebSocket::receive(std::chrono::microseconds most) {
    const auto until = Clock::now() + most;
    for (;;) {
        std::string text;
        switch (frames_.next(text)) {
        case WebSocketFrames::Event::Text:
            return text;
        case WebSocketFrames::Event::Ping:
            sendFrame(kPong, text);
            continue;
        case WebSocketFrames::Event::Closed:
            lost("closed by the service");
        case WebSocketFrames::Event::Fault:
            lost("violates the WebSocket protocol");
        case WebSocketFrames::Event::None:
            break;
        }
        const auto left = std::chrono::duration_cast<std::chrono::microseconds>(until - Clock::now());
        std::string bytes;
        if (left.count() < 0 || !readSome(left, bytes)) {
            return std::nullopt;
        }
        frames_.add(bytes);
    }
}

} // namespace fathom
