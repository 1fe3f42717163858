// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_file.h"

#include <cstring>

namespace fathom {

bool unpackLzf(std::span<const uint8_t> in, std::span<uint8_t> out) {
    size_t from = 0, to = 0;
    while (from < in.size()) {
        const uint32_t control = in[from++];
        if (control < 32) { // control + 1 literal bytes
            const size_t count = control + 1;
            if (from + count > in.size() || to + count > out.size()) {
                return false;
            }
            std::memcpy(out.data() + to, in.data() + from, count);
            from += count;
            to += count;
            continue;
        }
        size_t count = control >> 5, back = (control & 31) << 8;
        if (count == 7) {
            count += from < in.size() ? in[from++] : 0;
        }
        if (from >= in.size()) {
            return false;
        }
        back += in[from++] + 1u;
        count += 2;
        if (back > to || to + count > out.size()) {
            return false;
        }
        for (size_t i = 0; i < count; ++i, ++to) { // source and target may overlap
            out[to] = out[to - back];
        }
    }
    return to == out.size();
}

} // namespace fathom
