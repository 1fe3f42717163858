// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/unused_name.h"

#include <algorithm>

namespace fathom::operate {

std::filesystem::path unusedName(const std::filesystem::path& in, const std::string& stem,
                                 std::initializer_list<const char*> endings) {
    for (int i = 1;; ++i) {
        const std::filesystem::path name = in / (stem + "-" + std::to_string(i));
        const auto used = [&](const char* ending) {
            std::error_code unknown; // a link that leads nowhere is used, too
            return std::filesystem::exists(std::filesystem::symlink_status(name.string() + ending, unknown));
        };
        if (std::none_of(endings.begin(), endings.end(), used)) {
            return name;
        }
    }
}

} // namespace fathom::operate
