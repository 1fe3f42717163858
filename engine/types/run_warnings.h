// SPDX-License-Identifier: Apache-2.0
// What a run must not stay silent about: protection that the scene asks for and the run does not give.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

// Not for performance, which the budgets report. Any thread except the haptic one.
class RunWarnings {
public:
    static constexpr size_t kMax = 100; // further keys are dropped

    // Logs and keeps the text if its key is new. Returns whether it was.
    bool add(const std::string& key, const std::string& text);
    std::vector<std::string> list() const; // in the order of add()

private:
    mutable std::mutex mutex_;
    std::vector<std::pair<std::string, std::string>> texts_; // key, text
};

} // namespace fathom
