// SPDX-License-Identifier: Apache-2.0
#include "engine/types/log.h"

#include "engine/types/printable.h"

#include <spdlog/spdlog.h>

namespace fathom::log {

void write(Level level, fmt::string_view format, fmt::format_args values) {
    constexpr spdlog::level::level_enum kLevels[]{spdlog::level::debug, spdlog::level::info,
                                                  spdlog::level::warn, spdlog::level::err};
    spdlog::logger* const logger = spdlog::default_logger_raw();
    const auto wanted = kLevels[static_cast<int>(level)];
    if (logger != nullptr && logger->should_log(wanted)) { // none at the end of the program
        logger->log(wanted, printable(fmt::vformat(format, values)));
    }
}

} // namespace fathom::log
