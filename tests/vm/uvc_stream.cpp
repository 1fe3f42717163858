// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/uvc_stream.h"

#include <algorithm>

namespace fathom::vm {

namespace {

constexpr size_t kPayload = 16384; // [bytes] a bulk payload, header included
constexpr uint8_t kSetCur = 0x01, kGetCur = 0x81, kGetMin = 0x82, kGetMax = 0x83, kGetLen = 0x85,
                  kGetInfo = 0x86, kGetDef = 0x87;
constexpr uint32_t kShortest = 166666, kLongest = 666666; // [100 ns]

bool take(std::atomic<int>& count) {
    if (count.load() <= 0) {
        return false;
    }
    --count;
    return true;
}

} // namespace

UvcStream::UvcStream(const Shape& shape, UvcPainter painter)
    : shape_(shape)
    , painter_(std::move(painter)) {}

Bytes UvcStream::formatDescriptor() const {
    if (shape_.format == UvcFormat::Mjpeg) {
        return {11, 0x24, 6, 1, 1, 1, 1, 0, 0, 0, 0};
    }
    // The GUID is the four-character code and the base of all media subtypes, or a vendor GUID (INZI).
    const bool inzi = shape_.format == UvcFormat::Inzi;
    const char* code = inzi ? "INZI" : shape_.format == UvcFormat::Z16 ? "Z16 " : "YUY2";
    Bytes bytes{27, 0x24, 4, 1, 1};
    for (int i = 0; i < 4; ++i) {
        bytes.push_back(static_cast<uint8_t>(code[i]));
    }
    append(bytes, inzi ? Bytes{0x66, 0x1a, 0x42, 0xa2, 0x90, 0x65, 0xd0, 0x18, 0x14, 0xa8, 0xef, 0x8a}
                       : Bytes{0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71});
    append(bytes, {static_cast<uint8_t>(8 * bytesPerPixel()), 1, 0, 0, 0, 0});
    return bytes;
}

Bytes UvcStream::frameDescriptor() const {
    const uint8_t kind = shape_.format == UvcFormat::Mjpeg ? 7 : 5;
    Bytes bytes{0, 0x24, kind, 1, 0};
    put16(bytes, shape_.width);
    put16(bytes, shape_.height);
    put32(bytes, imageBytes() * 8 * 15);
    put32(bytes, imageBytes() * 8 * 60);
    put32(bytes, imageBytes());
    put32(bytes, 333333);
    bytes.push_back(3);
    for (const uint32_t interval : {kShortest, 333333u, kLongest}) {
        put32(bytes, interval);
    }
    bytes[0] = static_cast<uint8_t>(bytes.size());
    return bytes;
}

Bytes UvcStream::descriptors() const {
    const Bytes format = formatDescriptor(), frame = frameDescriptor();
    const uint8_t address = static_cast<uint8_t>(0x80 | shape_.endpoint);
    Bytes bytes{9, 4, shape_.interfaceNumber, 0, 1, 0x0E, 2, 0, 0};
    Bytes input{14, 0x24, 1, 1};
    put16(input, static_cast<uint16_t>(14 + format.size() + frame.size()));
    append(input, {address, 0, shape_.terminal, 0, 0, 0, 1, 0});
    append(bytes, input);
    append(bytes, format);
    append(bytes, frame);
    append(bytes, {7, 5, address, 2, 0x00, 0x02, 0});
    return bytes;
}

uint32_t UvcStream::payloadBytes() const {
    return shape_.wholePayloads ? imageBytes() + 255 : static_cast<uint32_t>(kPayload);
}

Bytes UvcStream::probe() const {
    Bytes bytes;
    put16(bytes, 1);
    append(bytes, {1, 1});
    put32(bytes, interval_);
    bytes.resize(18);
    put32(bytes, imageBytes());
    put32(bytes, payloadBytes());
    put32(bytes, 1000000);
    append(bytes, {0, 0, 0, 0});
    return bytes;
}

UsbReply UvcStream::control(const UsbSetup& setup, const Bytes& out) {
    const int selector = setup.value >> 8; // 1 probe, 2 commit
    if (selector != 1 && selector != 2) {
        return UsbReply::stall();
    }
    UsbReply reply{.data = probe()};
    const auto answerInterval = [&reply](uint32_t value) {
        for (size_t i = 0; i < 4; ++i) {
            reply.data[4 + i] = static_cast<uint8_t>(value >> (8 * i));
        }
    };
    switch (setup.request) {
    case kSetCur:
        if (out.size() >= 26) {
            interval_ = std::clamp(get32(out.data() + 4), kShortest, kLongest);
        }
        if (selector == 2) {
            on_ = true;
            busy_ = false;
            number_ = 0;
            due_ = Clock::now();
        }
        return UsbReply{};
    case kGetMin:
        answerInterval(kShortest);
        return reply;
    case kGetMax:
        answerInterval(kLongest);
        return reply;
    case kGetCur:
    case kGetDef:
        return reply;
    case kGetLen:
        return UsbReply{.data = {34, 0}};
    case kGetInfo:
        return UsbReply{.data = {3}};
    default:
        return UsbReply::stall();
    }
}

Clock::time_point UvcStream::due() const {
    return !on_ ? Clock::now() + std::chrono::milliseconds(20) : busy_ ? Clock::now() : due_;
}

bool UvcStream::nextFrame() {
    if (busy_) {
        return true;
    }
    const auto now = Clock::now();
    if (!on_ || faults.silent || now < due_) {
        return false;
    }
    due_ += std::chrono::nanoseconds(100) * interval_;
    due_ = std::max(due_, now - std::chrono::milliseconds(200)); // an emulated machine can fall behind
    toggle_ = static_cast<uint8_t>(toggle_ ^ (take(faults.sameToggle) ? 0 : 1));
    bad_ = take(faults.errorBit);
    image_.resize(imageBytes());
    painter_(number_++, image_);
    end_ = take(faults.cutShort) ? image_.size() / 2 / 2 * 2 : image_.size();
    at_ = 0;
    busy_ = true;
    return true;
}

// Payload header: length, flags (end of header, source clock, time stamp, error, end of frame, toggle),
// stamps.
void UvcStream::header(Bytes& out, bool end) {
    const auto micros =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
    const auto stamp = static_cast<uint32_t>(micros);
    append(out, {12, static_cast<uint8_t>(0x8C | toggle_ | (end ? 2 : 0) | (bad_ ? 0x40 : 0))});
    put32(out, stamp);
    put32(out, stamp);
    put16(out, static_cast<uint16_t>(micros / 1000 & 2047));
    if (!shape_.wholePayloads) {
        return;
    }
    // Capture timing as sent by a RealSense D4xx: frame number, sensor stamp, readout, exposure, interval
    // [us].
    for (const uint32_t word :
         {0x80000001u, 40u, 1u, 0x3fu, number_ - 1, stamp, 0u, 8500u, 33333u, pipeLatencyMicros.load()}) {
        put32(out, word);
    }
    out[0] = static_cast<uint8_t>(out.size());
}

std::optional<UsbReply> UvcStream::transfer(size_t room) {
    if (!nextFrame()) {
        return std::nullopt;
    }
    Bytes out;
    room = shape_.wholePayloads ? room : std::min(room, kPayload);
    out.reserve(room);
    if (at_ == 0 || !shape_.wholePayloads) {
        header(out, shape_.wholePayloads || end_ - at_ <= room - 12);
    }
    const size_t count = std::min(room - out.size(), end_ - at_);
    out.insert(out.end(), image_.begin() + static_cast<long>(at_),
               image_.begin() + static_cast<long>(at_ + count));
    at_ += count;
    if (at_ == end_ && out.size() < room) { // a full transfer does not end a payload: an empty one follows
        busy_ = false;
        ++sent;
    } else if (at_ == end_ && !shape_.wholePayloads) {
        busy_ = false;
        ++sent;
    }
    return UsbReply{.data = std::move(out)};
}

} // namespace fathom::vm
