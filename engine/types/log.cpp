// SPDX-License-Identifier: Apache-2.0
#include "engine/types/log.h"

#include "engine/types/log_once.h"
#include "engine/types/printable.h"

#include <memory>
#include <spdlog/spdlog.h>
#include <utility>

namespace fathom::log {

namespace {

thread_local LoggedLines* loggedLines = nullptr;

} // namespace

LogOnce::LogOnce(LoggedLines& logged) noexcept
    : before_(std::exchange(loggedLines, &logged)) {}

LogOnce::~LogOnce() {
    loggedLines = before_;
}

void write(Level level, fmt::string_view format, fmt::format_args values) {
    constexpr spdlog::level::level_enum kLevels[]{spdlog::level::debug, spdlog::level::info,
                                                  spdlog::level::warn, spdlog::level::err,
                                                  spdlog::level::info};
    spdlog::logger* const logger = spdlog::default_logger_raw();
    const auto wanted = kLevels[static_cast<int>(level)];
    const bool always = level == Level::Progress;
    if (logger != nullptr && (always || logger->should_log(wanted))) { // none at the end of the program
        const std::string line = printable(fmt::vformat(format, values));
        if (always) {
            const std::shared_ptr<spdlog::logger> shown = logger->clone(logger->name()); // with its sinks
            shown->set_level(wanted);
            shown->log(wanted, line);
        } else if (loggedLines == nullptr || loggedLines->isNew(line)) {
            logger->log(wanted, line);
        }
    }
}

} // namespace fathom::log
