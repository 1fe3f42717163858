// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/line_watchdog.h"

#include "engine/types/clock.h"

#include <cerrno>
#include <poll.h>
#include <span>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr int kBeat = 10; // [ms] poll period

// Reads everything pending, so that a backlog does not count as silence. Answers, so that the engine notices
// a watchdog that hangs.
void receive(int engine, LineWatchdog& watchdog) noexcept {
    char bytes[256];
    for (;;) {
        const ssize_t got = ::recv(engine, bytes, sizeof bytes, MSG_DONTWAIT);
        if (got < 0 &&
            (errno == EINTR || errno == ECONNRESET)) { // data sent before a reset can still be read
            continue;
        }
        if (got == 0 || (got < 0 && errno != EAGAIN)) {
            watchdog.close();
        }
        if (got <= 0) {
            return;
        }
        for (char byte : std::span(bytes, static_cast<size_t>(got))) {
            byte == kWatchdogGoodbye ? watchdog.goodbye() : watchdog.alive(monotonicSeconds());
        }
        ::send(engine, &kWatchdogReady, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    }
}

} // namespace

void LineWatchdog::alive(double now) noexcept {
    receivedAt_ = now;
    stoppingSince_ = -1.0;
}

void LineWatchdog::close() noexcept {
    if (!closed_) {
        closed_ = true;
        stoppingSince_ = -1.0; // resets after a silence as well
    }
}

bool LineWatchdog::stopDue(double now) noexcept {
    const bool silent = receivedAt_ >= 0.0 && (closed_ || now - receivedAt_ > kSilence);
    if (ended_ || !silent) {
        return false;
    }
    if (stoppingSince_ < 0.0) {
        stoppingSince_ = next_ = now;
        ++failures_;
    }
    const bool enough = closed_ && now - stoppingSince_ > kStopDuration; // an engine that hangs may come back
    if (now < next_ || enough) {
        return false;
    }
    next_ = now + period_;
    return true;
}

bool LineWatchdog::over(double now) const noexcept {
    const bool stopped = stoppingSince_ >= 0.0 && now - stoppingSince_ > kStopDuration;
    return ended_ || (closed_ && (receivedAt_ < 0.0 || stopped));
}

int watchLine(int engine, int line, const StandStill& still) noexcept {
    LineWatchdog watchdog(still.period);
    ::send(engine, &kWatchdogReady, 1, MSG_NOSIGNAL);
    for (double now = monotonicSeconds(); !watchdog.over(now); now = monotonicSeconds()) {
        receive(engine, watchdog);
        const int before = watchdog.failures();
        if (watchdog.stopDue(monotonicSeconds())) {
            if (watchdog.failures() > before) { // pending output would move the arm first
                ::tcflush(line, TCOFLUSH);
            }
            (void)!::write(line, still.bytes.data(), still.bytes.size()); // lost telegrams are repeated
        }
        pollfd wait{watchdog.closed() ? -1 : engine, POLLIN, 0};
        ::poll(&wait, 1, kBeat);
    }
    return watchdog.failures();
}

} // namespace fathom
