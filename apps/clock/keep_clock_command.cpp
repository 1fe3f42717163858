// SPDX-License-Identifier: Apache-2.0
#include "apps/clock/keep_clock_command.h"

#include "apps/clock/clock_keeper.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <array>
#include <csignal>
#include <dlfcn.h>
#include <memory>
#include <string>
#include <unistd.h>

namespace fathom {

namespace {

// Loads NVIDIA's CUDA driver API at run time through its documented ABI; the library is part of the driver,
// so nothing is linked.
class CudaDriver {
public:
    CudaDriver()
        : library_(::dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL)) {
        if (library_ == nullptr) {
            throw Error(::dlerror());
        }
        check(call<unsigned>("cuInit")(0), "cuInit");
    }

    // Creates a context on that device until the process ends.
    void occupy(const std::string& id) {
        int count = 0;
        check(call<int*>("cuDeviceGetCount")(&count), "cuDeviceGetCount");
        for (int k = 0; k < count; ++k) {
            int device = 0;
            std::array<uint8_t, 16> bytes{};
            check(call<int*, int>("cuDeviceGet")(&device, k), "cuDeviceGet");
            check(call<void*, int>("cuDeviceGetUuid")(bytes.data(), device), "cuDeviceGetUuid");
            if (hexOf(bytes) == id) {
                void* context = nullptr;
                check(call<void**, int>("cuDevicePrimaryCtxRetain")(&context, device),
                      "cuDevicePrimaryCtxRetain");
                return;
            }
        }
        throw Error("no CUDA device has the id " + id);
    }

private:
    template <class... Arguments>
    using Function = int (*)(Arguments...);

    template <class... Arguments>
    Function<Arguments...> call(const char* name) const {
        void* const found = ::dlsym(library_, name);
        if (found == nullptr) {
            throw Error(std::string("libcuda.so.1 has no ") + name);
        }
        return reinterpret_cast<Function<Arguments...>>(found);
    }

    static void check(int result, const char* what) {
        if (result != 0) {
            throw Error(std::string(what) + " says " + std::to_string(result));
        }
    }

    void* library_;
};

void keepClock(const std::string& id, const std::string& name) {
    std::signal(SIGPIPE, SIG_IGN);
    ::unsetenv("CUDA_VISIBLE_DEVICES"); // Vulkan ignores it
    try {
        CudaDriver().occupy(id);
    } catch (const Error& e) {
        log::warn("--hold-clock: cannot lock the clock of '{}': {}", name, e.what());
        return;
    }
    char byte = kClockHeld;
    if (::write(STDOUT_FILENO, &byte, 1) == 1) { // else the parent has ended
        while (::read(STDIN_FILENO, &byte, 1) > 0) {
        }
    }
}

} // namespace

void addKeepClockCommand(CLI::App& app) {
    struct Request {
        std::string id, name;
    };
    auto request = std::make_shared<Request>();
    CLI::App* command = app.add_subcommand(kKeepClockCommand, "lock a GPU's clock");
    command->group(""); // not in the help
    command->add_option("ID", request->id, "Vulkan's deviceUUID, 32 hexadecimal digits")->required();
    command->add_option("NAME", request->name, "device name, for messages")->required();
    command->callback([request] { keepClock(request->id, request->name); });
}

} // namespace fathom
