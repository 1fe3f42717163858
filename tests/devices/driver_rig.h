// SPDX-License-Identifier: Apache-2.0
// A driver that commands a simulated arm over a pseudo-terminal, in simulated time.
#pragma once

#include "devices/arm.h"
#include "devices/serial/serial_port.h"
#include "tests/devices/pty_line.h"

#include <utility>

namespace fathom::testing {

// Arm: an ArmSimulator. Driver: has the constructor (SerialPort&, options...).
template <class Arm, class Driver>
struct DriverRig {
    Arm arm;
    PtyLine line{arm};
    SerialPort port{line.name(), 115200};
    Driver driver;
    double cycle; // [s] of the driver
    double now = 0.0;

    template <class... Options>
    DriverRig(double cycleSeconds, Arm simulated, const Options&... options)
        : arm(std::move(simulated))
        , driver(port, options...)
        , cycle(cycleSeconds) {}

    void run(double seconds, const ArmCommand& command) {
        for (double end = now + seconds; now < end; now += cycle) {
            driver.step(now, command);
            line.exchange(now);
            arm.step(cycle);
        }
        driver.step(now, command);
    }
};

} // namespace fathom::testing
