// SPDX-License-Identifier: Apache-2.0
// Captures log lines for a test.
#pragma once

#include <memory>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sstream>
#include <string>

namespace fathom::testing {

// Collects the log lines during its lifetime.
class Listening {
public:
    Listening()
        : before_(spdlog::default_logger()) {
        auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
        spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;
    ~Listening() { spdlog::set_default_logger(before_); }

    size_t count(const std::string& part) const {
        size_t found = 0;
        const std::string text = text_.str();
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
            ++found;
        }
        return found;
    }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

} // namespace fathom::testing
