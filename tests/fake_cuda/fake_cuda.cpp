// SPDX-License-Identifier: Apache-2.0
// A fake CUDA driver library with two devices, controlled by the environment. FAKE_CUDA_ID: UUID of the
// second device. FAKE_CUDA_FAULT: the result of creating a context. FAKE_CUDA_LOG: a file that records when a
// context is created and when the process ends.
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

const char* setting(const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr ? value : "";
}

void print(const char* what) {
    if (std::FILE* const file = std::fopen(setting("FAKE_CUDA_LOG"), "a")) {
        std::fprintf(file, "%s\n", what);
        std::fclose(file);
    }
}

unsigned nibble(char c) {
    return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
}

} // namespace

extern "C" {

int cuInit(unsigned) {
    return 0;
}
int cuDeviceGetCount(int* count) {
    *count = std::getenv("CUDA_VISIBLE_DEVICES") == nullptr ? 2 : 0;
    return 0;
}
int cuDeviceGet(int* device, int index) {
    *device = index;
    return 0;
}
int cuDeviceGetUuid(void* bytes, int device) { // only the second device has that UUID
    const char* const id = setting("FAKE_CUDA_ID");
    auto* const out = static_cast<unsigned char*>(bytes);
    for (size_t i = 0; i < 16; ++i) {
        const bool known = device == 1 && std::strlen(id) == 32;
        out[i] = known ? static_cast<unsigned char>(nibble(id[2 * i]) << 4 | nibble(id[2 * i + 1])) : 0xee;
    }
    return 0;
}
int cuDevicePrimaryCtxRetain(void** context, int device) {
    static int made = 0;
    *context = &made;
    const int fault = std::atoi(setting("FAKE_CUDA_FAULT"));
    if (fault == 0) {
        print(device == 1 ? "made" : "made on another device");
        std::atexit([] { print("ended"); });
    }
    return fault;
}
}
