// SPDX-License-Identifier: Apache-2.0
// Digest over the exact numbers of haptics.csv: FNV-1a, 128 bits, over the bytes of each column,
// little-endian.
#pragma once

#include "apps/replay/tick_record.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace fathom {

// Equal runs give equal digests; it finds differences, it does not keep out an adversary. Parameters as
// published by Fowler, Noll and Vo (prime 2^88 + 0x13b).
class Digest {
public:
    void add(const void* bytes, size_t count) noexcept;
    void add(uint64_t value) noexcept; // 8 bytes, least significant first, on every machine
    void add(double value) noexcept;   // its bit pattern; every NaN counts as the same one, as in the text
    void add(const TickRecord& tick) noexcept; // the columns of one row, in their order
    std::string hex() const;                   // 32 digits

private:
    uint64_t high_ = 0x6c62272e07bb0142u, low_ = 0x62b821756295c58du;
};

} // namespace fathom
