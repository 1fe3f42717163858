// SPDX-License-Identifier: Apache-2.0
#include "engine/types/log.h"

#include "engine/types/printable.h"
#include "engine/types/said_once.h"

#include <spdlog/spdlog.h>
#include <utility>

namespace fathom::log {

namespace {

thread_local SaidLines* saidLines = nullptr;

} // namespace

SayOnce::SayOnce(SaidLines& said) noexcept
    : before_(std::exchange(saidLines, &said)) {}

SayOnce::~SayOnce() {
    saidLines = before_;
}

void write(Level level, fmt::string_view format, fmt::format_args values) {
    constexpr spdlog::level::level_enum kLevels[]{spdlog::level::debug, spdlog::level::info,
                                                  spdlog::level::warn, spdlog::level::err};
    spdlog::logger* const logger = spdlog::default_logger_raw();
    const auto wanted = kLevels[static_cast<int>(level)];
    if (logger != nullptr && logger->should_log(wanted)) { // none at the end of the program
        const std::string line = printable(fmt::vformat(format, values));
        if (saidLines == nullptr || saidLines->isNew(line)) {
            logger->log(wanted, line);
        }
    }
}

} // namespace fathom::log
