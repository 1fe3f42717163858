// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/ascii_value.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace fathom {

bool putAsciiValue(const std::string& word, char type, size_t size, uint8_t* to) {
    char* end = nullptr;
    errno = 0;
    bool inRange = true; // small floating-point values may underflow
    if (type == 'F' && size == 4) {
        const float value = std::strtof(word.c_str(), &end);
        std::memcpy(to, &value, 4);
    } else if (type == 'F') {
        const double value = std::strtod(word.c_str(), &end);
        std::memcpy(to, &value, std::min<size_t>(8, size));
    } else if (type == 'U') {
        const uint64_t value = std::strtoull(word.c_str(), &end, 10);
        inRange = errno == 0;
        std::memcpy(to, &value, size);
    } else {
        const int64_t value = std::strtoll(word.c_str(), &end, 10);
        inRange = errno == 0;
        std::memcpy(to, &value, size);
    }
    return end == word.c_str() + word.size() && inRange;
}

} // namespace fathom
