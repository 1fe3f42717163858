// SPDX-License-Identifier: Apache-2.0
#include "devices/images/npy_image.h"

#include "devices/images/half_value.h"
#include "devices/images/npy_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <utility>

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

// take(value): the value as it is kept, of each one stored.
template <class Stored, class Value, class Take>
std::string npyValues(ImageBytes bytes, bool bigEndian, std::span<Value> out, Take take) {
    if (bytes.size() != sizeof(Stored) * out.size()) {
        return "NPY: " + std::to_string(bytes.size()) + " bytes of values, not " +
               std::to_string(sizeof(Stored) * out.size());
    }
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<Value>(take(npyValue<Stored>(bytes.data() + i * sizeof(Stored), bigEndian)));
    }
    return "";
}

// Values of the sensor that 16 bits can hold; negative ones mean no measurement.
template <class Stored>
std::string npyUnits(ImageBytes bytes, bool bigEndian, std::span<uint16_t> out) {
    Stored beyond = 0;
    const std::string fault = npyValues<Stored>(bytes, bigEndian, out, [&](Stored value) {
        beyond = std::cmp_greater(value, UINT16_MAX) ? value : beyond;
        return std::cmp_less(value, 0) ? Stored{0} : value;
    });
    return !fault.empty() || beyond == 0
               ? fault
               : "NPY: a value of " + std::to_string(beyond) + " (allowed: up to 65535)";
}

template <class Two, class Four, class Eight>
std::string npyUnits(const NpyHeader& head, ImageBytes bytes, std::span<uint16_t> out) {
    return head.bytes == 2   ? npyUnits<Two>(bytes, head.bigEndian, out)
           : head.bytes == 4 ? npyUnits<Four>(bytes, head.bigEndian, out)
                             : npyUnits<Eight>(bytes, head.bigEndian, out);
}

} // namespace

DepthHeader npyHeader(ImageBytes bytes) {
    const NpyHeader head = parseNpyHeader(bytes);
    return {{head.width, head.height}, head.kind == 'f', head.fault};
}

std::string readNpy(ImageBytes bytes, std::span<uint16_t> out) {
    const NpyHeader head = parseNpyHeader(bytes);
    if (!head.fault.empty() || head.kind == 'f') {
        return head.fault.empty() ? "NPY: other values" : head.fault;
    }
    const ImageBytes values = bytes.subspan(head.values);
    return head.kind == 'u' ? npyUnits<uint16_t, uint32_t, uint64_t>(head, values, out)
                            : npyUnits<int16_t, int32_t, int64_t>(head, values, out);
}

std::string readNpy(ImageBytes bytes, std::span<float> out) {
    const NpyHeader head = parseNpyHeader(bytes);
    if (!head.fault.empty() || head.kind != 'f') {
        return head.fault.empty() ? "NPY: other values" : head.fault;
    }
    const ImageBytes values = bytes.subspan(head.values);
    return head.bytes == 2   ? npyValues<uint16_t>(values, head.bigEndian, out, halfValue)
           : head.bytes == 4 ? npyValues<float>(values, head.bigEndian, out, std::identity())
                             : npyValues<double>(values, head.bigEndian, out, std::identity());
}

} // namespace fathom
