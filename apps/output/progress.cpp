// SPDX-License-Identifier: Apache-2.0
#include "apps/output/progress.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

namespace fathom {

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(100);
constexpr uint32_t kCallsPerClockReading = 32;

// A terminal that can erase a line.
bool isTerminal(std::FILE* out) {
    const char* kind = std::getenv("TERM");
    return ::isatty(::fileno(out)) == 1 && kind != nullptr && std::strcmp(kind, "dumb") != 0;
}

std::string rate(double count, double seconds) {
    const double value = seconds > 0.0 ? count / seconds : 0.0;
    return value >= 1000.0 ? printed("%.1f k ", value / 1000.0) : printed("%.0f ", value);
}

// ", 12 min 05 s left"; empty where it cannot be known yet.
std::string timeLeft(const ProgressCounts& counts, double wallSeconds) {
    const bool byRun = counts.runTotal > 0.0;
    const double done = byRun ? counts.runSeconds : static_cast<double>(counts.framesDone);
    const double all = byRun ? counts.runTotal : static_cast<double>(counts.framesTotal);
    if (!(done > 0.0 && all >= done && wallSeconds >= 1.0)) {
        return "";
    }
    const double left = std::min(wallSeconds * (all - done) / done, 3.6e6);
    const auto seconds = static_cast<unsigned>(left + 0.5);
    if (seconds < 60) {
        return printed(", %u s left", seconds);
    }
    return seconds < 3600 ? printed(", %u min %02u s left", seconds / 60, seconds % 60)
                          : printed(", %u h %02u min left", seconds / 3600, seconds / 60 % 60);
}

} // namespace

std::string progressText(const ProgressCounts& counts, double wallSeconds) {
    std::string text = "frame " + std::to_string(counts.framesDone);
    if (counts.framesTotal > 0) {
        text += " of " + std::to_string(counts.framesTotal);
    }
    text += timeLeft(counts, wallSeconds);
    text += ", " + rate(static_cast<double>(counts.framesDone), wallSeconds) + "frames/s";
    if (counts.framesOnly) {
        return text;
    }
    const double pace = wallSeconds > 0.0 ? counts.runSeconds / wallSeconds : 0.0;
    return text + printed(", %.2f x real time", pace);
}

Progress::Progress(std::FILE* out)
    : Progress(out, isTerminal(out)) {}

Progress::Progress(std::FILE* out, bool terminal)
    : out_(out)
    , terminal_(terminal) {}

void Progress::update(const ProgressCounts& counts) noexcept {
    // Reads the clock only every kCallsPerClockReading calls, because ticks are microseconds apart.
    if (!terminal_ || (shown_ && !counts.framesOnly && ++calls_ % kCallsPerClockReading != 0)) {
        return;
    }
    const auto now = Clock::now();
    if (now < next_) {
        return;
    }
    next_ = now + kPeriod;
    try {
        const std::string text = progressText(counts, std::chrono::duration<double>(now - start_).count());
        std::fprintf(out_, "\r%.79s\x1b[K", text.c_str());
        std::fflush(out_);
        shown_ = true;
    } catch (...) {
        terminal_ = false; // out of memory: continue without progress
    }
}

void Progress::finish() noexcept {
    if (shown_) {
        std::fputs("\r\x1b[K", out_);
        std::fflush(out_);
        shown_ = false;
    }
}

} // namespace fathom
