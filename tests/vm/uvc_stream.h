// SPDX-License-Identifier: Apache-2.0
// One streaming interface of a simulated UVC camera: descriptors, negotiation and bulk payloads.
// Source: USB Device Class Definition for Video Devices 1.1/1.5 and its payload documents.
#pragma once

#include "tests/vm/usb_device.h"

#include <functional>

namespace fathom::vm {

enum class UvcFormat { Z16, Inzi, Yuyv, Mjpeg };

// Paints frame n: Z16 and YUYV rows of 16-bit words, INZI rows of infrared and then of depth, or a whole
// JPEG.
using UvcPainter = std::function<void(uint32_t n, Bytes& image)>;

// Faults that a test sets while the camera runs. Each count is the number of frames still to damage.
struct UvcFaults {
    std::atomic<int> cutShort{0};    // ends half-way
    std::atomic<int> errorBit{0};    // the header marks it as bad
    std::atomic<int> sameToggle{0};  // the frame bit does not change: the driver is out of step
    std::atomic<bool> silent{false}; // nothing is sent
};

class UvcStream {
public:
    struct Shape {
        UvcFormat format = UvcFormat::Z16;
        uint16_t width = 320, height = 240;
        uint8_t interfaceNumber = 1, endpoint = 1, terminal = 2;
        bool wholePayloads = false; // one payload per frame with a capture-timing block (RealSense)
    };
    UvcStream(const Shape& shape, UvcPainter painter);

    Bytes descriptors() const; // of the interface, class-specific ones and endpoint included
    const Shape& shape() const { return shape_; }

    UsbReply control(const UsbSetup& setup, const Bytes& out); // probe and commit
    void stop() { on_ = false; }
    // Next bulk transfer of at most `room` bytes; nothing while no frame is due.
    std::optional<UsbReply> transfer(size_t room);
    Clock::time_point due() const;

    UvcFaults faults;
    std::atomic<uint32_t> sent{0};              // frames, complete or damaged
    std::atomic<uint32_t> pipeLatencyMicros{0}; // reported by the capture timing, with whole payloads

private:
    Bytes formatDescriptor() const;
    Bytes frameDescriptor() const;
    uint32_t bytesPerPixel() const { return shape_.format == UvcFormat::Inzi ? 4 : 2; }
    uint32_t imageBytes() const { return bytesPerPixel() * shape_.width * shape_.height; }
    uint32_t payloadBytes() const;
    Bytes probe() const;
    bool nextFrame();
    void header(Bytes& out, bool end);

    Shape shape_;
    UvcPainter painter_;
    uint32_t interval_ = 333333; // [100 ns]
    bool on_ = false;
    Clock::time_point due_;
    Bytes image_;
    size_t at_ = 0, end_ = 0;
    uint32_t number_ = 0;
    uint8_t toggle_ = 0;
    bool bad_ = false, busy_ = false;
};

} // namespace fathom::vm
