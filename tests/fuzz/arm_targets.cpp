// SPDX-License-Identifier: Apache-2.0
// Targets for the answers of real arms: telegrams, and the drivers that process them.
#include "devices/serial/eca_arm.h"
#include "devices/serial/reach_arm.h"
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace fathom::testing {

namespace {

// The arm's end of a serial line (a pseudo-terminal), one per process and target. Each input gets a new
// driver on the same line.
class FarEnd {
public:
    FarEnd()
        : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        need(master_ >= 0 && ::grantpt(master_) == 0 && ::unlockpt(master_) == 0);
        port_ = std::make_unique<SerialPort>(::ptsname(master_), 115200);
    }
    ~FarEnd() { ::close(master_); }
    FarEnd(const FarEnd&) = delete;
    FarEnd& operator=(const FarEnd&) = delete;

    SerialPort& port() { return *port_; }

    // Steps of a driver that is commanded to move, with this many input bytes before each.
    void feed(ArmDevice& arm, Bytes input) {
        constexpr size_t kTurn = 512, kMaxTurns = 8;
        constexpr double kPeriod = 0.1; // [s] longer than a driver's own period, so it sends in every step
        ArmCommand command;
        command.hold = false;
        for (size_t tick = 0; tick < kMaxTurns && tick * kTurn < input.size(); ++tick) {
            const Bytes bytes = input.subspan(tick * kTurn, std::min(kTurn, input.size() - tick * kTurn));
            need(::write(master_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
            pollfd there{port_->descriptor(), POLLIN, 0};
            ::poll(&there, 1, 200);
            arm.step(now_ += kPeriod, command);
            needSound(arm.feedback());
            std::array<uint8_t, 1024> sent{};
            while (::read(master_, sent.data(), sent.size()) > 0) {
            }
        }
        std::array<uint8_t, kTurn> left{};
        while (port_->read(left) > 0) {
        }
    }

private:
    static void needSound(const ArmFeedback& feedback) {
        const auto finite = [](double x) { return std::isfinite(x); };
        need(std::ranges::all_of(feedback.position, finite) && std::ranges::all_of(feedback.current, finite));
        need(feedback.age >= 0.0 && (!feedback.stale || feedback.holding));
    }

    int master_;
    double now_ = 0.0; // [s]
    std::unique_ptr<SerialPort> port_;
};

// The same bytes as axis readings of an arm, in telegrams with correct checksums, so that the code behind the
// checksum runs.
std::vector<uint8_t> reachAnswers(Bytes input) {
    std::vector<uint8_t> all;
    for (; input.size() >= 6; input = input.subspan(6)) {
        ReachPacket packet{static_cast<uint8_t>(input[0] % 2 == 0 ? 0x03 : 0x05), // position, current
                           static_cast<uint8_t>(input[1] % 7),
                           4,
                           {}};
        std::copy_n(input.begin() + 2, 4, packet.data.begin());
        ReachFrame frame;
        const size_t size = encodeReach(packet, frame);
        all.insert(all.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return all;
}

std::vector<uint8_t> ecaAnswers(Bytes input) {
    constexpr size_t kBytes = 4 * kEcaJoints;
    std::vector<uint8_t> all;
    for (; input.size() >= kBytes; input = input.subspan(kBytes)) {
        std::array<EcaStatus, kEcaJoints> status;
        for (size_t j = 0; j < kEcaJoints; ++j) {
            const Bytes of = input.subspan(4 * j, 4);
            status[j] = {static_cast<uint16_t>(of[0] | of[1] << 8), 0, of[2], of[3]};
        }
        const EcaBytes frame = encodeEca(status);
        all.insert(all.end(), frame.begin(), frame.end());
    }
    return all;
}

} // namespace

void readReach(Bytes input) {
    ReachReader reader;
    for (uint8_t byte : input) {
        if (const auto packet = reader.take(byte)) {
            need(packet->size <= ReachPacket::kMaxData);
            ReachFrame frame;
            need(encodeReach(*packet, frame) > 0);
        }
    }
    static FarEnd line;
    ReachArm arm(line.port());
    line.feed(arm, input);
    line.feed(arm, reachAnswers(input));
}

void readEca(Bytes input) {
    EcaReader reader;
    for (uint8_t byte : input) {
        if (const auto frame = reader.take(byte)) {
            need(frame->at(49) == ecaChecksum(*frame));
            const auto status = statusOf(*frame), again = statusOf(encodeEca(status));
            for (size_t j = 0; j < kEcaJoints; ++j) {
                need(again[j].encoder == status[j].encoder && again[j].current == status[j].current);
            }
            need(encodeEca(demandsOf(*frame)).size() == frame->size());
        }
    }
    need(reader.damaged() <= input.size());
    static FarEnd line;
    EcaArm arm(line.port());
    line.feed(arm, input);
    line.feed(arm, ecaAnswers(input));
}

} // namespace fathom::testing
