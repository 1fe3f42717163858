// SPDX-License-Identifier: Apache-2.0
#include "engine/types/log.h"

#include <doctest/doctest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sstream>

using namespace fathom;

TEST_CASE("Progress is logged as information that is shown where other information is hidden") {
    const std::shared_ptr<spdlog::logger> before = spdlog::default_logger();
    std::ostringstream lines;
    auto logger =
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(lines));
    logger->set_pattern("%l: %v");
    logger->set_level(spdlog::level::warn);
    spdlog::set_default_logger(logger);
    log::info("hidden");
    log::progress("{} of {}", 1, 8);
    log::warn("shown");
    log::info("still hidden");
    spdlog::set_default_logger(before);
    CHECK(lines.str() == "info: 1 of 8\nwarning: shown\n");
}
