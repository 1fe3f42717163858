// SPDX-License-Identifier: Apache-2.0
// Little-endian building blocks, and the descriptors that every device has (USB 2.0, 9.6).
#include "tests/vm/usb_device.h"

#include <bit>

namespace fathom::vm {

void put16(Bytes& bytes, uint16_t value) {
    bytes.push_back(static_cast<uint8_t>(value));
    bytes.push_back(static_cast<uint8_t>(value >> 8));
}

void put32(Bytes& bytes, uint32_t value) {
    put16(bytes, static_cast<uint16_t>(value));
    put16(bytes, static_cast<uint16_t>(value >> 16));
}

void putFloat(Bytes& bytes, float value) {
    put32(bytes, std::bit_cast<uint32_t>(value));
}

void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

uint16_t get16(const uint8_t* bytes) {
    return static_cast<uint16_t>(bytes[0] | bytes[1] << 8);
}

uint32_t get32(const uint8_t* bytes) {
    return get16(bytes) | static_cast<uint32_t>(get16(bytes + 2)) << 16;
}

Bytes deviceDescriptor(uint16_t vendor, uint16_t product, uint32_t deviceClass, uint8_t packet0,
                       uint16_t release) {
    Bytes bytes{18, 1};
    put16(bytes, 0x0200);
    append(bytes, {static_cast<uint8_t>(deviceClass >> 16), static_cast<uint8_t>(deviceClass >> 8),
                   static_cast<uint8_t>(deviceClass), packet0});
    put16(bytes, vendor);
    put16(bytes, product);
    put16(bytes, release);
    append(bytes, {1, 2, 3, 1});
    return bytes;
}

Bytes configurationDescriptor(uint8_t interfaces, const Bytes& body) {
    Bytes bytes{9, 2};
    put16(bytes, static_cast<uint16_t>(9 + body.size()));
    append(bytes, {interfaces, 1, 0, 0x80, 50});
    append(bytes, body);
    return bytes;
}

} // namespace fathom::vm
