// SPDX-License-Identifier: Apache-2.0
// Digest over the exact numbers of haptics.csv: FNV-1a, 128 bits, over the bytes of each column,
// little-endian.
#pragma once

#include "engine/cycle/step_record.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace fathom {

// Detects differences between runs; not a protection against forgery. Parameters as published by Fowler, Noll
// and Vo (prime 2^88 + 0x13b).
class Digest {
public:
    void add(const void* bytes, size_t count) noexcept;
    void add(uint64_t value) noexcept;         // 8 bytes, least significant first, on every machine
    void add(double value) noexcept;           // its bit pattern; all NaNs count as equal, as in the CSV text
    void add(const StepRecord& tick) noexcept; // the columns of one row, in order
    std::string hex() const;                   // 32 hexadecimal digits

private:
    uint64_t high_ = 0x6c62272e07bb0142u, low_ = 0x62b821756295c58du;
};

} // namespace fathom
