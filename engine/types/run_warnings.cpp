// SPDX-License-Identifier: Apache-2.0
#include "engine/types/run_warnings.h"

#include "engine/types/log.h"
#include "engine/types/printable.h"

#include <algorithm>

namespace fathom {

bool RunWarnings::add(const std::string& key, const std::string& text) {
    {
        const std::lock_guard lock(mutex_);
        const bool known = std::ranges::any_of(texts_, [&](const auto& t) { return t.first == key; });
        if (known || texts_.size() == kMax) {
            return false;
        }
        texts_.emplace_back(key, printable(text));
    }
    log::warn("{}", text);
    return true;
}

std::vector<std::string> RunWarnings::list() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> texts;
    for (const auto& [key, text] : texts_) {
        texts.push_back(text);
    }
    return texts;
}

} // namespace fathom
