// SPDX-License-Identifier: Apache-2.0
// Keeps a source that is opened and read again from logging the same lines again.
#pragma once

#include <set>
#include <string>

namespace fathom::log {

// Lines that were logged; at most kMax, later ones repeat. One thread at a time.
class LoggedLines {
public:
    // False where the line is known. Adds it.
    bool isNew(const std::string& line) {
        return lines_.size() >= kMax ? lines_.count(line) == 0 : lines_.insert(line).second;
    }

private:
    static constexpr size_t kMax = 1000;
    std::set<std::string> lines_;
};

// While it lives, its thread does not log again the lines that are in `logged`, and adds the new ones to it.
// The innermost one applies.
class LogOnce {
public:
    explicit LogOnce(LoggedLines& logged) noexcept;
    LogOnce(const LogOnce&) = delete;
    LogOnce& operator=(const LogOnce&) = delete;
    ~LogOnce();

private:
    LoggedLines* before_;
};

} // namespace fathom::log
