// SPDX-License-Identifier: Apache-2.0
// Replaces engine/types/log.cpp: the library passes log lines to the calling program's callback and does not
// link spdlog.
#include "engine/front/public.h"
#include "engine/types/log.h"

#include <mutex>

namespace fathom {

namespace {

std::mutex logMutex; // of logCallback
v0::LogCallback logCallback;

} // namespace

void log::write(Level level, fmt::string_view format, fmt::format_args values) {
    const std::lock_guard lock(logMutex);
    if (logCallback) {
        const Level known = level == Level::Progress ? Level::Info : level;
        logCallback(static_cast<v0::LogLevel>(known), printable(fmt::vformat(format, values)));
    }
}

void v0::setLogCallback(LogCallback callback) {
    const std::lock_guard lock(logMutex);
    logCallback = std::move(callback);
}

} // namespace fathom
