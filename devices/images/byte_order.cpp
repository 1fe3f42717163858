// SPDX-License-Identifier: Apache-2.0
#include "devices/images/byte_order.h"

#include <bitset>
#include <cmath>
#include <cstdlib>

namespace fathom {

namespace {

constexpr size_t kFewestJudged = 256; // values or pairs that decide

// Values under 256 in one of the orders are skipped: images of 8 bits that were moved up by 8 are smoother in
// the wrong order, although they are right.
bool hasBothBytes(uint16_t value) {
    return (value & 0xffu) != 0 && value > 0xffu;
}

// Of two values, in the order of the file and in the other one.
struct Steps {
    uint64_t stated = 0, swapped = 0;
    void add(uint16_t left, uint16_t right) {
        stated += static_cast<uint64_t>(std::abs(left - right));
        swapped += static_cast<uint64_t>(std::abs(__builtin_bswap16(left) - __builtin_bswap16(right)));
    }
};

} // namespace

ByteOrder orderOfUnits(std::span<const uint16_t> values, size_t width) {
    constexpr uint64_t kSmoother = 10;   // factor
    constexpr size_t kFewestLevels = 16; // low bytes of the right order; fewer are those of flat test images
    Steps steps;
    size_t pairs = 0;
    std::bitset<256> low, high;
    for (size_t i = 1; i < values.size(); ++i) {
        const uint16_t left = values[i - 1], right = values[i];
        if (i % width != 0 && left != right && hasBothBytes(left) && hasBothBytes(right)) {
            steps.add(left, right);
            low.set(right & 0xffu);
            high.set(right >> 8u);
            ++pairs;
        }
    }
    if (pairs < kFewestJudged) {
        return ByteOrder::Unknown;
    }
    if (low.count() >= kFewestLevels && steps.stated * kSmoother <= steps.swapped) {
        return ByteOrder::AsStated;
    }
    // Right images of 8 or 9 bits that were moved up are smoother in the wrong order, too.
    const bool movedUp = low.count() == 1 && (low[0x80] || low[0xff]);
    const bool smoother = high.count() >= kFewestLevels && steps.swapped * kSmoother <= steps.stated;
    return smoother && !movedUp ? ByteOrder::Swapped : ByteOrder::Unknown;
}

void OrderOfReals::Count::add(double value) {
    constexpr double kLeast = 1e-3, kMost = 1e6; // metres to millimetres; a tenth of random bits lie between
    const double length = std::abs(value);
    values += value != 0.0 && std::isfinite(value) ? 1 : 0;
    lengths += length >= kLeast && length <= kMost ? 1 : 0;
}

bool OrderOfReals::Count::areLengths() const {
    return values >= kFewestJudged && lengths * 10 >= values * 9;
}

bool OrderOfReals::Count::areNone() const {
    return values >= kFewestJudged && lengths * 4 <= values;
}

void OrderOfReals::add(double stated, double swapped) {
    stated_.add(stated);
    swapped_.add(swapped);
}

ByteOrder OrderOfReals::order() const {
    return stated_.areLengths() && swapped_.areNone()   ? ByteOrder::AsStated
           : swapped_.areLengths() && stated_.areNone() ? ByteOrder::Swapped
                                                        : ByteOrder::Unknown;
}

std::string wrongOrder(bool bigEndian) {
    return std::string("is_bigendian is ") + (bigEndian ? "1" : "0") +
           ", but its values are plausible only as " + (bigEndian ? "little" : "big") +
           "-endian ones: they are read so";
}

} // namespace fathom
