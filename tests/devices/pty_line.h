// SPDX-License-Identifier: Apache-2.0
// A simulated arm at the far end of a pseudo-terminal, on a line with faults.
#pragma once

#include "devices/simulated/arm_simulator.h"

#include <deque>
#include <fcntl.h>
#include <poll.h>
#include <random>
#include <stdexcept>
#include <stdlib.h>
#include <string>
#include <termios.h>
#include <unistd.h>

namespace fathom::testing {

struct LineFaults {
    double noise = 0.0;   // share of bytes that are changed
    double loss = 0.0;    // share of bytes that are lost
    bool echo = false;    // the host receives its own bytes
    double latency = 0.0; // [s] delay of answers
    bool cut = false;     // no bytes pass
    bool deaf = false;    // the arm receives nothing; the host still receives its echo
};

// Time is simulated; only the terminal is real. Writes to it are awaited, unless `live`: then another process
// reads there.
class PtyLine {
public:
    explicit PtyLine(ArmSimulator& arm, bool live = false)
        : arm_(arm)
        , live_(live)
        , master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) {
            throw std::runtime_error("no pseudo-terminal");
        }
        name_ = ::ptsname(master_);
        slave_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        termios raw{};
        ::tcgetattr(slave_, &raw);
        ::cfmakeraw(&raw);
        ::tcsetattr(slave_, TCSANOW, &raw);
    }
    ~PtyLine() {
        ::close(slave_);
        ::close(master_);
    }
    PtyLine(const PtyLine&) = delete;
    PtyLine& operator=(const PtyLine&) = delete;

    LineFaults faults;
    size_t carried = 0; // bytes that both ends sent
    const std::string& name() const { return name_; }

    // Passes the host's bytes to the arm, and the arm's due answers to the host.
    void exchange(double now) {
        std::vector<uint8_t> answers;
        uint8_t bytes[256];
        for (pollfd wait{master_, POLLIN, 0}; ::poll(&wait, 1, live_ ? 0 : 1) > 0;) {
            const ssize_t got = ::read(master_, bytes, sizeof bytes);
            if (got <= 0) {
                break;
            }
            std::vector<uint8_t> sent(bytes, bytes + got);
            spoil(sent);
            carried += static_cast<size_t>(got);
            if (faults.echo) {
                answers.insert(answers.end(), bytes, bytes + got);
            }
            const size_t before = answers.size();
            if (!faults.deaf) {
                arm_.receive(sent, answers);
            }
            carried += answers.size() - before;
        }
        spoil(answers);
        for (uint8_t byte : answers) {
            waiting_.push_back({now + faults.latency, byte});
        }
        std::vector<uint8_t> due;
        while (!waiting_.empty() && waiting_.front().at <= now) {
            due.push_back(waiting_.front().byte);
            waiting_.pop_front();
        }
        if (!due.empty() && ::write(master_, due.data(), due.size()) > 0 && !live_) {
            pollfd there{slave_, POLLIN, 0};
            ::poll(&there, 1, 200);
        }
    }

private:
    struct Waiting {
        double at;
        uint8_t byte;
    };

    void spoil(std::vector<uint8_t>& bytes) {
        std::uniform_real_distribution<double> share(0.0, 1.0);
        std::vector<uint8_t> out;
        for (uint8_t byte : bytes) {
            if (!faults.cut && share(random_) >= faults.loss) {
                out.push_back(share(random_) < faults.noise ? static_cast<uint8_t>(random_()) : byte);
            }
        }
        bytes.swap(out);
    }

    ArmSimulator& arm_;
    bool live_;
    int master_, slave_ = -1;
    std::string name_;
    std::deque<Waiting> waiting_;
    std::mt19937_64 random_{9};
};

} // namespace fathom::testing
