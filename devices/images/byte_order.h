// SPDX-License-Identifier: Apache-2.0
// Judges the order of the bytes of depth by its values, because what files state of it is wrong at times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace fathom {

// Unknown: few values, nearly constant ones, or noise in both orders.
enum class ByteOrder { Unknown, AsStated, Swapped };

// Of rows of `width` values without gaps, read in the stated order; 0 = no measurement. In the wrong order
// low bytes are high ones, so horizontal neighbours differ over ten times as much.
ByteOrder orderOfUnits(std::span<const uint16_t> values, size_t width);

// Of floating-point values: in the wrong order most are no lengths.
class OrderOfReals {
public:
    // One value, read in both orders. 0, NaN and infinity mean no measurement.
    void add(double stated, double swapped);
    ByteOrder order() const;

private:
    struct Count {
        size_t values = 0, lengths = 0;
        void add(double value);
        bool areLengths() const; // most of enough values
        bool areNone() const;    // few of enough values
    };
    Count stated_, swapped_;
};

// The warning of messages whose is_bigendian is wrong. bigEndian: as they state.
std::string wrongOrder(bool bigEndian);

} // namespace fathom
