// SPDX-License-Identifier: Apache-2.0
#include "devices/images/npy_image.h"

#include "devices/images/npy_head.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fathom {

namespace {

template <class Value>
Value npyValue(const uint8_t* at, bool bigEndian) {
    std::array<uint8_t, sizeof(Value)> bytes;
    std::memcpy(bytes.data(), at, bytes.size());
    if (bigEndian) {
        std::reverse(bytes.begin(), bytes.end());
    }
    Value value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

template <class Stored, class Value>
std::string npyValues(ImageBytes bytes, bool bigEndian, std::span<Value> out) {
    if (bytes.size() != sizeof(Stored) * out.size()) {
        return "NPY: " + std::to_string(bytes.size()) + " bytes of values, not " +
               std::to_string(sizeof(Stored) * out.size());
    }
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<Value>(npyValue<Stored>(bytes.data() + i * sizeof(Stored), bigEndian));
    }
    return "";
}

} // namespace

DepthHead npyHead(ImageBytes bytes) {
    const NpyHead head = parseNpyHead(bytes);
    return {{head.width, head.height}, head.kind == 'f', head.fault};
}

std::string readNpy(ImageBytes bytes, std::span<uint16_t> out) {
    const NpyHead head = parseNpyHead(bytes);
    if (!head.fault.empty() || head.kind != 'u') {
        return head.fault.empty() ? "NPY: other values" : head.fault;
    }
    return npyValues<uint16_t>(bytes.subspan(head.values), head.bigEndian, out);
}

std::string readNpy(ImageBytes bytes, std::span<float> out) {
    const NpyHead head = parseNpyHead(bytes);
    if (!head.fault.empty() || head.kind != 'f') {
        return head.fault.empty() ? "NPY: other values" : head.fault;
    }
    const ImageBytes values = bytes.subspan(head.values);
    return head.bytes == 4 ? npyValues<float>(values, head.bigEndian, out)
                           : npyValues<double>(values, head.bigEndian, out);
}

} // namespace fathom
