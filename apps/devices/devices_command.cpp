// SPDX-License-Identifier: Apache-2.0
#include "apps/devices/devices_command.h"

#include "apps/devices/hand_devices.h"
#include "engine/gpu/device.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

namespace fathom {

namespace {

// Lists every physical device that Vulkan reports, with the reason for rejected ones.
void printComputeDevices(std::ostream& out, const GlobalOptions& global) {
    try {
        const gpu::Instance instance(global.validation());
        size_t index = 0;
        for (const std::string& line : gpu::Device::list(instance)) {
            out << "compute " << line << "\n";
            if (line.find(", refused: ") == std::string::npos) {
                out << "          --device " << index << ", or part of its name\n";
            }
            ++index;
        }
    } catch (const std::exception& e) {
        out << "compute REFUSED: " << e.what() << "\n";
    }
}

} // namespace

void addDevicesCommand(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand(
        "devices", "list cameras, haptic devices and compute devices, and why any cannot be used");
    command->callback([&global] {
        const char* folder = std::getenv("XDG_RUNTIME_DIR");
        printHandDevices(std::cout, "/", folder != nullptr ? folder : "");
        printComputeDevices(std::cout, global);
    });
}

} // namespace fathom
