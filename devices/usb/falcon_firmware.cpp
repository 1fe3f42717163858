// SPDX-License-Identifier: Apache-2.0
#include "devices/usb/falcon_firmware.h"

#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <string>

namespace fathom {

namespace {

using std::chrono::milliseconds;

constexpr size_t kLargest = 64 * 1024; // bytes; known firmware has 8 kB
constexpr size_t kPiece = 62;          // a USB packet minus the modem status of its echo
constexpr uint16_t kPurgeReceived = 1, kPurgeSent = 2, kEightBits = 8;
constexpr uint16_t kBaud9600 = 0x4138, kBaud140k = 0x15, kBaud1500k = 2;
constexpr uint16_t kDtrHigh = 0x0101, kDtrLow = 0x0100, kRtsLow = 0x0200;
constexpr auto kPatience = milliseconds(1000);

std::string hex(std::span<const uint8_t> bytes) {
    static const char* const kDigits = "0123456789abcdef";
    std::string text;
    for (const uint8_t byte : bytes.first(std::min<size_t>(bytes.size(), 8))) {
        text.append(text.empty() ? "" : " ");
        text.push_back(kDigits[byte >> 4]);
        text.push_back(kDigits[byte & 15]);
    }
    return text.empty() ? "nothing" : text + (bytes.size() > 8 ? " ..." : "");
}

void sendAll(FtdiPort& port, std::span<const uint8_t> bytes, const std::string& step) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (!port.send(bytes)) {
        if (std::chrono::steady_clock::now() >= until) {
            throw Error("falcon firmware: " + step + ": the device does not accept data");
        }
        port.wait(milliseconds(5));
    }
}

// Up to `count` bytes, as many as arrive in time.
std::vector<uint8_t> receive(FtdiPort& port, size_t count) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    std::vector<uint8_t> bytes;
    while (bytes.size() < count && std::chrono::steady_clock::now() < until) {
        port.wait(milliseconds(5));
        port.take(bytes);
    }
    return bytes;
}

void expect(FtdiPort& port, std::span<const uint8_t> send, std::span<const uint8_t> answer,
            const std::string& step) {
    sendAll(port, send, step);
    const std::vector<uint8_t> got = receive(port, answer.size());
    if (!std::equal(got.begin(), got.end(), answer.begin(), answer.end())) {
        throw Error("falcon firmware: " + step + ": answer " + hex(got) + " (allowed: " + hex(answer) + ")");
    }
}

void greet(FtdiPort& port) {
    const std::array<uint8_t, 3> hello{0x0a, 0x43, 0x0d};
    const std::array<uint8_t, 4> answer{0x0a, 0x44, 0x2c, 0x0d};
    sendAll(port, hello, "greeting");
    std::vector<uint8_t> got = receive(port, answer.size());
    if (!got.empty() && got.front() == 0) { // some devices send a leading zero
        got.erase(got.begin());
        const std::vector<uint8_t> rest =
            got.size() < answer.size() ? receive(port, 1) : std::vector<uint8_t>();
        got.insert(got.end(), rest.begin(), rest.end());
    }
    if (!std::equal(got.begin(), got.end(), answer.begin(), answer.end())) {
        throw Error("falcon firmware: handshake: answer " + hex(got) + " (allowed: " + hex(answer) +
                    "); switch the device off and on");
    }
}

} // namespace

std::vector<uint8_t> readFalconFirmware(const std::filesystem::path& file) {
    const std::optional<std::string> text = readFileAtMost(file, kLargest);
    if (!text) {
        throw BadInput(file.string(), "firmware", whyUnreadable(file), "a file with the Falcon's firmware");
    }
    if (text->empty() || text->size() > kLargest) {
        throw BadInput(file.string(), "firmware",
                       text->empty() ? "empty" : "over " + std::to_string(kLargest) + " bytes",
                       "1 to " + std::to_string(kLargest) + " bytes");
    }
    return {text->begin(), text->end()};
}

void loadFalconFirmware(FtdiPort& port, std::span<const uint8_t> firmware) {
    port.control(FtdiRequest::Reset, kPurgeReceived);
    port.control(FtdiRequest::Reset, kPurgeSent);
    port.control(FtdiRequest::Latency, 16);
    port.control(FtdiRequest::Baud, kBaud9600);
    port.control(FtdiRequest::Data, kEightBits);
    port.control(FtdiRequest::Flow, 0);
    port.control(FtdiRequest::Modem, kRtsLow);
    port.control(FtdiRequest::Modem, kDtrLow);
    port.control(FtdiRequest::Modem, kDtrHigh);
    greet(port);
    port.control(FtdiRequest::Modem, kDtrLow);
    port.control(FtdiRequest::Baud, kBaud140k);
    const std::array<uint8_t, 1> ready{0x41};
    expect(port, ready, ready, "speed change");
    for (size_t at = 0; at < firmware.size(); at += kPiece) {
        const auto piece = firmware.subspan(at, std::min(kPiece, firmware.size() - at));
        expect(port, piece, piece, "echo at byte " + std::to_string(at));
    }
}

void setFalconLine(FtdiPort& port) {
    port.control(FtdiRequest::Latency, 1);
    port.control(FtdiRequest::Baud, kBaud1500k);
    port.control(FtdiRequest::Data, kEightBits);
    port.control(FtdiRequest::Reset, kPurgeReceived);
    port.control(FtdiRequest::Reset, kPurgeSent);
    std::vector<uint8_t> stale;
    port.take(stale);
}

} // namespace fathom
