// SPDX-License-Identifier: Apache-2.0
// A simulated depth + colour camera for the kernel's own uvcvideo: Z16 and YUYV or MJPEG over bulk, with a
// vendor extension unit; optionally behaves like a RealSense D4xx.
#pragma once

#include "tests/vm/uvc_stream.h"

namespace fathom::vm {

struct UvcCameraOptions {
    uint16_t width = 320, height = 240;     // of both images
    UvcFormat depthFormat = UvcFormat::Z16; // or Inzi, whose default image is plainInzi()
    bool colour = true, motionJpeg = false;
    bool realSense = false;  // 8086:0b03 with its mailbox and tables, else 1209:d3d3
    bool colourTable = true; // of the RealSense; a D430 has none
    std::string serial = "SIM0001";
    UvcPainter paintDepth, paintColour; // default: plainDepth(), plainColour()
};

class UvcCamera final : public UsbDevice {
public:
    explicit UvcCamera(const UvcCameraOptions& options);
    ~UvcCamera() override { unplug(); }

    UvcStream& depth() { return streams_.front(); }
    UvcStream& colour() { return streams_.back(); }

    std::atomic<bool> stallMailbox{false}, wrongChecksum{false}, refuseTables{false};
    std::atomic<int> mailboxDelayMs{0};

private:
    UsbReply control(const UsbSetup& setup, const Bytes& out) override;
    std::optional<UsbReply> in(uint8_t endpoint, size_t room) override;
    Clock::time_point due() override;
    UsbReply extension(const UsbSetup& setup, const Bytes& out);
    void answerMailbox();
    Bytes controlInterface() const;

    UvcCameraOptions options_;
    std::deque<UvcStream> streams_;
    Bytes mailbox_;
};

// The known figures of the simulated RealSense.
namespace simulated_realsense {
constexpr float kFocal = 212.5f, kCentreX = 160.25f, kCentreY = 119.75f; // depth lens at 320x240 [pixels]
constexpr uint32_t kDepthUnitMicros = 500;
constexpr float kColourShiftMillis[3] = {14.75f, -2.5f, 3.25f}; // translation_rect
// rotation_matrix_rect, column after column: 60 degrees about (1, 1, 1).
constexpr float kColourRotation[9] = {2 / 3.0f, 2 / 3.0f, -1 / 3.0f, -1 / 3.0f, 2 / 3.0f,
                                      2 / 3.0f, 2 / 3.0f, -1 / 3.0f, 2 / 3.0f};
constexpr float kColourFx = 0.71f, kColourFy = 1.27f, kColourCx = 0.02f,
                kColourCy = -0.03f; // normalised, 16:9
Bytes table(uint32_t number);       // 25 or 32, header included; else empty
} // namespace simulated_realsense

// Pixel 0 holds the frame number (16 bits); pixel (x, y) 1000 + x + 2 y.
UvcPainter plainDepth(uint16_t width, uint16_t height);
// The same depth, behind an infrared plane whose pixels are all 777.
UvcPainter plainInzi(uint16_t width, uint16_t height);
// YUYV: left half red, right half blue; the luma of pixel 0 holds the frame number (8 bits).
UvcPainter plainColour(uint16_t width, uint16_t height);
// A JPEG: left half red, right half blue.
UvcPainter redAndBlueJpeg(uint16_t width, uint16_t height);

} // namespace fathom::vm
