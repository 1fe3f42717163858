// SPDX-License-Identifier: Apache-2.0
#include "apps/arm_simulator/arm_simulator_command.h"

#include "apps/binding/stop_signals.h"
#include "apps/number_option.h"
#include "devices/simulated/arm_simulator.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstring>
#include <iostream>
#include <memory>
#include <thread>

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr double kMaxStep = 0.05; // [s] largest simulated step, so that a stopped process does not jump
constexpr double kEcaRange = 1.6; // [rad] between the stops of every joint

struct SimulatorOptions {
    std::string protocol;
    std::filesystem::path link;
    double seconds = 0.0; // 0 = until Ctrl-C
};

// Both ends of a pseudo-terminal. The far end stays open, so that the arm survives its host.
class Terminal {
public:
    Terminal()
        : own_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
        const char* name = nullptr;
        if (own_ >= 0 && ::grantpt(own_) == 0 && ::unlockpt(own_) == 0) {
            name = ::ptsname(own_);
        }
        far_ = name != nullptr ? ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC) : -1;
        termios raw{};
        if (far_ < 0 || ::tcgetattr(far_, &raw) != 0) {
            throw Error(std::string("arm-simulator: no pseudo-terminal: ") + std::strerror(errno));
        }
        name_ = name;
        ::cfmakeraw(&raw);
        ::tcsetattr(far_, TCSANOW, &raw);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;
    ~Terminal() {
        ::close(far_);
        ::close(own_);
    }
    const std::string& name() const { return name_; }

    // Passes the host's bytes to the arm and its answers to the host. Bytes that do not fit are lost, like on
    // a wire.
    void exchange(ArmSimulator& arm) const {
        std::vector<uint8_t> answers;
        uint8_t bytes[256];
        for (ssize_t got = 0; (got = ::read(own_, bytes, sizeof bytes)) > 0;) {
            arm.receive({bytes, static_cast<size_t>(got)}, answers);
        }
        [[maybe_unused]] const ssize_t sent =
            answers.empty() ? 0 : ::write(own_, answers.data(), answers.size());
    }

private:
    int own_, far_ = -1;
    std::string name_;
};

// Symbolic link to the terminal, for scripts. Removed by the destructor.
class Link {
public:
    Link(std::filesystem::path link, const std::string& target)
        : link_(std::move(link)) {
        std::error_code fault;
        if (!link_.empty() && std::filesystem::is_symlink(link_)) { // left by a killed process
            std::filesystem::remove(link_, fault);
        }
        if (!link_.empty()) {
            std::filesystem::create_symlink(target, link_, fault);
        }
        if (fault) {
            throw BadInput("arm-simulator", "--link", link_.string() + ": " + fault.message(),
                           "an unused name in a writable folder");
        }
    }
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;
    ~Link() {
        std::error_code ignored;
        if (!link_.empty()) {
            std::filesystem::remove(link_, ignored);
        }
    }

private:
    std::filesystem::path link_;
};

std::unique_ptr<ArmSimulator> simulatorOf(const std::string& protocol) {
    if (protocol != "eca_5e") {
        return std::make_unique<ReachSimulator>(protocol == "reach_alpha5" ? ReachKind::Alpha5
                                                                           : ReachKind::Bravo7);
    }
    auto eca = std::make_unique<EcaSimulator>();
    eca->upper.fill(kEcaRange);
    eca->angle.fill(0.1 * kEcaRange); // homing moves there slowly
    return eca;
}

void runSimulator(const SimulatorOptions& options) {
    const StopSignals signals;
    const auto arm = simulatorOf(options.protocol);
    const Terminal terminal;
    const Link link(options.link, terminal.name());
    std::cout << options.protocol << " simulated at " << terminal.name() << "; Ctrl-C ends it" << std::endl;
    const auto began = Clock::now();
    for (auto before = began; !signals.requested().load();) {
        const auto now = Clock::now();
        if (options.seconds > 0.0 && std::chrono::duration<double>(now - began).count() > options.seconds) {
            break;
        }
        terminal.exchange(*arm);
        arm->step(std::min(kMaxStep, std::chrono::duration<double>(now - before).count()));
        before = now;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace

void addArmSimulatorCommand(CLI::App& app) {
    auto options = std::make_shared<SimulatorOptions>();
    CLI::App* command =
        app.add_subcommand("arm-simulator", "simulate an arm on a pseudo-terminal, for use with --arm");
    command
        ->add_option("PROTOCOL", options->protocol,
                     "protocol, as in the scene's arm.driver: reach_alpha5, reach_bravo7 or eca_5e")
        ->required()
        ->check(wordIn({"reach_alpha5", "reach_bravo7", "eca_5e"}));
    command->add_option("--link", options->link, "symbolic link to the terminal while the command runs");
    command->add_option("--seconds", options->seconds, "end after this time [s] (0: until Ctrl-C)")
        ->check(numberIn(Range::between(0.0, 86400.0)));
    command->callback([options] { runSimulator(*options); });
}

} // namespace fathom
