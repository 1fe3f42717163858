// SPDX-License-Identifier: Apache-2.0
#include "devices/simulated/arm_simulator.h"

#include "devices/serial/eca_arm.h"

#include <algorithm>
#include <cmath>

namespace fathom {

void ReachSimulator::receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) {
    for (uint8_t byte : bytes) {
        if (const auto packet = reader_.take(byte)) {
            handle(*packet, out);
        }
    }
}

void ReachSimulator::handle(const ReachPacket& packet, std::vector<uint8_t>& out) {
    const size_t d = packet.device;
    if (d == 0 || d > axes_) {
        return;
    }
    const auto value = packet.asFloat();
    if (packet.id == 0x02 && value) {
        velocity_[d] = static_cast<double>(*value);
        toSetpoint_[d] = false;
    } else if (packet.id == 0x03 && value) {
        setpoint_[d] = static_cast<double>(*value);
        toSetpoint_[d] = true;
    }
    for (size_t i = 0; packet.id == 0x60 && i < packet.size; ++i) {
        const uint8_t id = packet.data[i];
        const double answer = id == 0x03 ? position[d] : id == 0x05 ? current[d] : NAN;
        if (std::isnan(answer)) {
            continue;
        }
        ReachFrame frame;
        const size_t size =
            encodeReach(ReachPacket::ofFloat(id, packet.device, static_cast<float>(answer)), frame);
        out.insert(out.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    }
}

void ReachSimulator::step(double dt) {
    for (size_t d = 1; d < kDevices; ++d) {
        const double most = speed[d] * dt;
        const double wanted = toSetpoint_[d] ? setpoint_[d] - position[d] : velocity_[d] * dt;
        position[d] += std::clamp(wanted, -most, most);
    }
}

void EcaSimulator::receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) {
    for (uint8_t byte : bytes) {
        const auto frame = reader_.take(byte);
        if (!frame) {
            continue;
        }
        const auto demands = demandsOf(*frame);
        std::array<EcaStatus, kEcaJoints> status;
        for (size_t j = 0; j < kEcaJoints; ++j) {
            const double rate = fullSpeed * demands[j].speed / 4095.0;
            rate_[j] = demands[j].kind == EcaDemand::Kind::SpeedCcw  ? rate
                       : demands[j].kind == EcaDemand::Kind::SpeedCw ? -rate
                                                                     : 0.0;
            const auto counts = std::llround(angle[j] / EcaArm::radiansPerCount(j));
            status[j].encoder = static_cast<uint16_t>(firstCount[j] + counts);
            status[j].current = pressed_[j] ? pressing : rate_[j] != 0.0 ? running : uint8_t{0};
        }
        const EcaBytes answer = encodeEca(status);
        out.insert(out.end(), answer.begin(), answer.end());
    }
}

void EcaSimulator::step(double dt) {
    for (size_t j = 0; j < kEcaJoints; ++j) {
        const double next = angle[j] + rate_[j] * dt;
        pressed_[j] = rate_[j] != 0.0 && (next < lower[j] || next > upper[j]);
        angle[j] = std::clamp(next, lower[j], upper[j]);
    }
}

} // namespace fathom
