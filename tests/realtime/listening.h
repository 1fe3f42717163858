// SPDX-License-Identifier: Apache-2.0
// Captures log lines for a test.
#pragma once

#include <memory>
#include <mutex>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <string>

namespace fathom::testing {

// Collects the log lines during its lifetime.
class Listening {
public:
    Listening()
        : before_(spdlog::default_logger()) {
        spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink_));
    }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;
    ~Listening() { spdlog::set_default_logger(before_); }

    // Other threads may log meanwhile.
    size_t count(const std::string& part) const {
        size_t found = 0;
        const std::string text = sink_->text();
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
            ++found;
        }
        return found;
    }

private:
    struct Sink final : spdlog::sinks::base_sink<std::mutex> {
        std::string text() {
            const std::lock_guard lock(mutex_);
            return text_;
        }
        void sink_it_(const spdlog::details::log_msg& line) override {
            text_.append(line.payload.data(), line.payload.size());
            text_ += '\n';
        }
        void flush_() override {}

    private:
        std::string text_;
    };
    std::shared_ptr<Sink> sink_ = std::make_shared<Sink>();
    std::shared_ptr<spdlog::logger> before_;
};

} // namespace fathom::testing
