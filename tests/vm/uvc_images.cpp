// SPDX-License-Identifier: Apache-2.0
// Default images of the simulated camera, and the tables of the simulated RealSense.
#include "tests/vm/uvc_camera.h"

#include <algorithm>
#include <turbojpeg.h>

namespace fathom::vm {

UvcPainter plainDepth(uint16_t width, uint16_t height) {
    return [width, height](uint32_t n, Bytes& image) {
        for (uint32_t y = 0, i = 0; y < height; ++y) {
            for (uint32_t x = 0; x < width; ++x, i += 2) {
                const uint32_t value = x + y == 0 ? n : 1000 + x + 2 * y;
                image[i] = static_cast<uint8_t>(value);
                image[i + 1] = static_cast<uint8_t>(value >> 8);
            }
        }
    };
}

UvcPainter plainInzi(uint16_t width, uint16_t height) {
    const size_t plane = size_t{2} * width * height;
    return
        [plane, paint = plainDepth(width, height), depth = Bytes(plane)](uint32_t n, Bytes& image) mutable {
            for (size_t i = 0; i < plane; i += 2) {
                image[i] = 777 & 255;
                image[i + 1] = 777 >> 8;
            }
            paint(n, depth);
            std::copy(depth.begin(), depth.end(), image.begin() + static_cast<long>(plane));
        };
}

UvcPainter plainColour(uint16_t width, uint16_t height) {
    return [width, height](uint32_t n, Bytes& image) {
        for (uint32_t y = 0, i = 0; y < height; ++y) {
            for (uint32_t x = 0; x < width; x += 2, i += 4) {
                const bool red = x < width / 2u; // BT.601: red is (81, 90, 240), blue (41, 240, 110)
                image[i] = image[i + 2] = red ? 81 : 41;
                image[i + 1] = red ? 90 : 240;
                image[i + 3] = red ? 240 : 110;
            }
        }
        image[0] = static_cast<uint8_t>(n);
    };
}

UvcPainter redAndBlueJpeg(uint16_t width, uint16_t height) {
    Bytes rgb;
    for (uint32_t i = 0; i < uint32_t{width} * height; ++i) {
        const bool red = i % width < width / 2u;
        append(rgb, {static_cast<uint8_t>(red ? 255 : 0), 0, static_cast<uint8_t>(red ? 0 : 255)});
    }
    const tjhandle coder = tjInitCompress();
    unsigned char* jpeg = nullptr;
    unsigned long size = 0;
    tjCompress2(coder, rgb.data(), width, 0, height, TJPF_RGB, &jpeg, &size, TJSAMP_422, 90, 0);
    const Bytes image(jpeg, jpeg + size);
    tjFree(jpeg);
    tjDestroy(coder);
    return [image](uint32_t, Bytes& out) { out = image; };
}

namespace simulated_realsense {

namespace {

// CRC-32 like zlib, bit by bit; deliberately independent of the product's.
uint32_t checksum(const Bytes& bytes) {
    uint32_t crc = ~0u;
    for (const uint8_t byte : bytes) {
        for (int bit = 0; bit < 8; ++bit) {
            const bool carry = (crc ^ static_cast<uint32_t>(byte >> bit)) & 1;
            crc = carry ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
        }
    }
    return ~crc;
}

void putAt(Bytes& bytes, size_t at, float value) {
    Bytes four;
    putFloat(four, value);
    std::copy(four.begin(), four.end(), bytes.begin() + static_cast<long>(at));
}

Bytes depthBody() {
    Bytes body(560, 0);
    putAt(body, 144, 50.0f); // baseline [mm]
    for (size_t row = 0; row < 16; ++row) {
        const size_t at = 240 + 16 * row;
        const float scale = row == 6 ? 1.0f : 2.0f; // row 6 is 320x240
        putAt(body, at, kFocal * scale);
        putAt(body, at + 4, (kFocal + 1.0f) * scale);
        putAt(body, at + 8, kCentreX * scale);
        putAt(body, at + 12, kCentreY * scale);
    }
    return body;
}

Bytes colourBody() {
    Bytes body(240, 0);
    putAt(body, 0, kColourFx);
    putAt(body, 8, kColourCx);
    putAt(body, 16, kColourFy);
    putAt(body, 20, kColourCy);
    body[128] = 1920 & 255;
    body[129] = 1920 >> 8;
    body[130] = 1080 & 255;
    body[131] = 1080 >> 8;
    for (size_t i = 0; i < 9; ++i) {
        putAt(body, 168 + 4 * i, kColourRotation[i]);
    }
    for (size_t i = 0; i < 3; ++i) {
        putAt(body, 204 + 4 * i, kColourShiftMillis[i]);
    }
    return body;
}

} // namespace

Bytes table(uint32_t number) {
    if (number != 25 && number != 32) {
        return {};
    }
    const Bytes body = number == 25 ? depthBody() : colourBody();
    Bytes bytes{5, 0};
    put16(bytes, static_cast<uint16_t>(number));
    put32(bytes, static_cast<uint32_t>(body.size()));
    put32(bytes, 0);
    put32(bytes, checksum(body));
    append(bytes, body);
    return bytes;
}

} // namespace simulated_realsense

} // namespace fathom::vm
