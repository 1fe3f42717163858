// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/progress.h"

#include <unistd.h>

namespace fathom {

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(100);
constexpr uint32_t kCallsAClockReading = 32;

std::string rate(double count, double seconds) {
    const double value = seconds > 0.0 ? count / seconds : 0.0;
    char text[32];
    if (value >= 1000.0) {
        std::snprintf(text, sizeof text, "%.1f k ", value / 1000.0);
    } else {
        std::snprintf(text, sizeof text, "%.0f ", value);
    }
    return text;
}

} // namespace

std::string progressText(const ProgressCounts& counts, double wallSeconds) {
    std::string text = "frame " + std::to_string(counts.framesDone);
    if (counts.framesTotal > 0) {
        text += " of " + std::to_string(counts.framesTotal);
    }
    text += ", " + rate(static_cast<double>(counts.framesDone), wallSeconds) + "frames/s, ";
    text += rate(static_cast<double>(counts.ticksDone), wallSeconds) + "ticks/s";
    char tail[64];
    const double pace = wallSeconds > 0.0 ? counts.runSeconds / wallSeconds : 0.0;
    std::snprintf(tail, sizeof tail, ", %.1f s of run, %.2f x real time", counts.runSeconds, pace);
    return text + tail;
}

Progress::Progress(std::FILE* out)
    : Progress(out, ::isatty(::fileno(out)) == 1) {}

Progress::Progress(std::FILE* out, bool terminal)
    : out_(out)
    , terminal_(terminal) {}

void Progress::update(const ProgressCounts& counts) noexcept {
    // Reads the clock only every kCallsAClockReading calls, because ticks are microseconds apart.
    if (!terminal_ || (shown_ && ++calls_ % kCallsAClockReading != 0)) {
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
