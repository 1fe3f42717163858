// SPDX-License-Identifier: Apache-2.0
// A bridge whose device and line fail in a new way every half second, for two seconds of every four, and
// whose hand presses and lets go. Writes every wrench that reached it.
//   storm_bridge SOCKET SEED LOG      until SIGTERM
#include "engine/include/fathom/device_socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

constexpr double kPeriod = 1e-3, kSlot = 0.5; // [s]
constexpr double kCalm = 2.0;                 // [s] until the first contact

enum class Fault {
    None,
    Loses,  // half of the samples
    Mute,   // no sample
    Bursts, // one sample in nine
    NotFinite,
    NoTurn, // an orientation of zeros
    Unhomed,
    Absent,
    Garbage,  // one packet of random bytes
    Outliers, // 1 m away
    Huge,
    Moves, // silent for 30 ms, then 0.15 m away
    Closes,
    Old, // stamps 8 to 15 ms in the past
    Repeats,
    Releases, // the dead-man switch
    Clutches,
    Count
};

volatile std::sig_atomic_t stopped = 0;
void onTerm(int) {
    stopped = 1;
}

double now() {
    timespec t{};
    ::clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void waitUntil(double t) {
    const timespec at{static_cast<time_t>(t), static_cast<long>((t - std::floor(t)) * 1e9)};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

struct Row {
    int connection;
    fathom_door_wrench wrench;
};

// Pushes along z until it feels enough force, lets go until it feels none, and starts again.
class Hand {
public:
    void step(double force, std::mt19937& random) {
        const auto within = [&](double low, double high) {
            return std::uniform_real_distribution(low, high)(random);
        };
        if (pushes_ ? force > enough_ || z > turn_ + 0.08 : force == 0.0 && z < turn_ - 0.03) {
            pushes_ = !pushes_;
            turn_ = z;
            speed_ = within(0.02, 0.4);
            enough_ = within(2.0, 25.0);
        }
        z += (pushes_ ? speed_ : -speed_) * kPeriod;
        x = 0.002 * std::sin(40.0 * z);
    }
    double z = 0.0, x = 0.0; // [m]

private:
    bool pushes_ = true;
    double speed_ = 0.1, enough_ = 8.0, turn_ = 0.0;
};

class StormBridge {
public:
    StormBridge(const char* path, unsigned seed)
        : random_(seed)
        , listener_(::socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        const std::string unready = std::string(path) + ".new"; // the path exists once a client can connect
        std::strncpy(address.sun_path, unready.c_str(), sizeof address.sun_path - 1);
        ::unlink(unready.c_str());
        if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listener_, 4) != 0 || std::rename(unready.c_str(), path) != 0) {
            std::perror(path);
            std::exit(1);
        }
    }

    void run() {
        while (stopped == 0) {
            peer_ = ::accept(listener_, nullptr, nullptr);
            if (peer_ < 0) {
                continue; // interrupted
            }
            if (++connection_ == 1) { // however long the engine took to start
                slotEnds_ = now() + kCalm;
            }
            serve();
            ::close(peer_);
        }
    }

    void write(const char* path) const {
        std::FILE* out = std::fopen(path, "w");
        std::fprintf(out, "connection,sequence,flags,fx,fy,fz,tx,ty,tz\n");
        for (const Row& row : rows_) {
            const fathom_door_wrench& w = row.wrench;
            std::fprintf(out, "%d,%llu,%u,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", row.connection,
                         static_cast<unsigned long long>(w.header.sequence), w.flags, w.force[0], w.force[1],
                         w.force[2], w.torque[0], w.torque[1], w.torque[2]);
        }
        std::fclose(out);
    }

private:
    void serve() {
        for (double next = now(); stopped == 0; waitUntil(next)) {
            if (!receive()) {
                return;
            }
            chooseFault();
            hand_.step(force_, random_);
            if (!tick()) {
                return;
            }
            next = std::max(next + kPeriod, now() - 0.05);
        }
    }

    bool receive() {
        fathom_door_wrench wrench{};
        ssize_t got = 0;
        while ((got = ::recv(peer_, &wrench, sizeof wrench, MSG_DONTWAIT)) > 0) {
            rows_.push_back({connection_, wrench});
            force_ = std::hypot(wrench.force[0], wrench.force[1], wrench.force[2]);
        }
        return got < 0 && (errno == EAGAIN || errno == EINTR);
    }

    void chooseFault() {
        if (now() >= slotEnds_) {
            slotEnds_ = now() + kSlot;
            const Fault next = static_cast<Fault>(random_() % static_cast<unsigned>(Fault::Count));
            fault_ = slot_++ % 8 < 4 ? next : Fault::None;
            faultEnds_ = now() + 0.4 * kSlot * chance();
            once_ = true;
        } else if (now() >= faultEnds_) {
            fault_ = Fault::None;
        }
    }

    // False when the bridge closes the connection.
    bool tick() {
        fathom_door_hand hand{};
        hand.header = {FATHOM_DOOR_MAGIC,
                       FATHOM_DOOR_VERSION,
                       FATHOM_DOOR_HAND,
                       sizeof hand,
                       0,
                       ++sequence_,
                       static_cast<uint64_t>(now() * 1e9)};
        hand.status = FATHOM_DOOR_PRESENT | FATHOM_DOOR_HOMED;
        hand.position[0] = hand_.x + shift_;
        hand.position[2] = hand_.z;
        hand.orientation[0] = 1.0;
        std::strcpy(hand.preset, "ideal");
        std::strcpy(hand.name, "storm");
        if (std::exchange(once_, false)) {
            if (fault_ == Fault::Closes) {
                return false;
            }
            shift_ = fault_ == Fault::Moves ? 0.15 - shift_ : shift_;
            faultEnds_ = fault_ == Fault::Moves ? now() + 0.03 : faultEnds_;
            garbage(fault_ == Fault::Garbage);
        }
        spoil(hand);
        const bool lost = fault_ == Fault::Mute || fault_ == Fault::Moves || fault_ == Fault::Garbage ||
                          (fault_ == Fault::Loses && chance() < 0.5) ||
                          (fault_ == Fault::Bursts && sequence_ % 9 != 0);
        for (int i = lost ? 0 : fault_ == Fault::Repeats ? 5 : 1; i > 0; --i) {
            ::send(peer_, &hand, sizeof hand, MSG_DONTWAIT | MSG_NOSIGNAL);
        }
        return true;
    }

    void garbage(bool wanted) {
        std::array<unsigned char, 512> bytes{};
        for (unsigned char& byte : bytes) {
            byte = static_cast<unsigned char>(random_());
        }
        if (wanted) {
            ::send(peer_, bytes.data(), random_() % bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
        }
    }

    void spoil(fathom_door_hand& hand) {
        const bool often = chance() < 0.1;
        switch (often ? fault_ : Fault::None) {
        case Fault::NotFinite:
            hand.position[random_() % 3] = std::numeric_limits<double>::quiet_NaN();
            break;
        case Fault::NoTurn:
            hand.orientation[0] = 0.0;
            break;
        case Fault::Unhomed:
            hand.status = FATHOM_DOOR_PRESENT;
            break;
        case Fault::Absent:
            hand.status = 0;
            break;
        case Fault::Outliers:
            hand.position[random_() % 3] += 1.0;
            break;
        case Fault::Huge:
            hand.position[random_() % 3] = 1e30;
            break;
        case Fault::Releases:
            hand.buttons = FATHOM_DOOR_DEAD_MAN_OPEN;
            break;
        case Fault::Clutches:
            hand.buttons = FATHOM_DOOR_CLUTCH;
            break;
        default:
            break;
        }
        if (fault_ == Fault::Old) {
            hand.header.time_ns -= static_cast<uint64_t>(8'000'000 + 7'000'000 * chance());
        }
    }

    double chance() { return std::uniform_real_distribution(0.0, 1.0)(random_); }

    std::mt19937 random_;
    int listener_, peer_ = -1, connection_ = 0;
    uint64_t sequence_ = 0;
    Hand hand_;
    double force_ = 0.0, shift_ = 0.0; // [N], [m]
    Fault fault_ = Fault::None;
    double slotEnds_ = 0.0, faultEnds_ = 0.0; // [s]
    bool once_ = false;
    unsigned slot_ = 0;
    std::vector<Row> rows_;
};

} // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        return 2;
    }
    struct sigaction action {};
    action.sa_handler = onTerm; // without SA_RESTART, so that accept() returns
    ::sigaction(SIGTERM, &action, nullptr);
    StormBridge bridge(argv[1], static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10)));
    bridge.run();
    bridge.write(argv[3]);
}
