// SPDX-License-Identifier: Apache-2.0
#include "devices/serial/line_guard.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <poll.h>
#include <span>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr int kBeat = 10; // [ms] poll period

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Reads everything pending, so that a backlog does not count as silence.
void hear(int engine, LineGuard& guard) noexcept {
    char bytes[256];
    for (;;) {
        const ssize_t got = ::recv(engine, bytes, sizeof bytes, MSG_DONTWAIT);
        if (got < 0 &&
            (errno == EINTR || errno == ECONNRESET)) { // data sent before a reset can still be read
            continue;
        }
        if (got == 0 || (got < 0 && errno != EAGAIN)) {
            guard.close();
        }
        if (got <= 0) {
            return;
        }
        for (char byte : std::span(bytes, static_cast<size_t>(got))) {
            byte == kGuardFarewell ? guard.farewell() : guard.alive(seconds());
        }
    }
}

} // namespace

void LineGuard::alive(double now) noexcept {
    heardAt_ = now;
    toldSince_ = -1.0;
}

void LineGuard::close() noexcept {
    if (!closed_) {
        closed_ = true;
        toldSince_ = -1.0; // resets after a silence as well
    }
}

bool LineGuard::mustTell(double now) noexcept {
    const bool dumb = heardAt_ >= 0.0 && (closed_ || now - heardAt_ > kSilence);
    if (parted_ || !dumb) {
        return false;
    }
    if (toldSince_ < 0.0) {
        toldSince_ = next_ = now;
        ++found_;
    }
    if (now < next_ || now - toldSince_ > kLastWords) {
        return false;
    }
    next_ = now + period_;
    return true;
}

bool LineGuard::over(double now) const noexcept {
    const bool told = toldSince_ >= 0.0 && now - toldSince_ > kLastWords;
    return parted_ || (closed_ && (heardAt_ < 0.0 || told));
}

int guardLine(int engine, int line, const StandStill& still) noexcept {
    LineGuard guard(still.period);
    ::send(engine, &kGuardReady, 1, MSG_NOSIGNAL);
    for (double now = seconds(); !guard.over(now); now = seconds()) {
        hear(engine, guard);
        const int before = guard.found();
        if (guard.mustTell(seconds())) {
            if (guard.found() > before) { // pending output would move the arm first
                ::tcflush(line, TCOFLUSH);
            }
            (void)!::write(line, still.bytes.data(), still.bytes.size()); // lost telegrams are repeated
        }
        pollfd wait{guard.closed() ? -1 : engine, POLLIN, 0};
        ::poll(&wait, 1, kBeat);
    }
    return guard.found();
}

} // namespace fathom
