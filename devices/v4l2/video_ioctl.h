// SPDX-License-Identifier: Apache-2.0
// Calls of a video device's driver.
#pragma once

#include <cerrno>
#include <sys/ioctl.h>

namespace fathom {

// ioctl with retry on EINTR; 0 or -1 with errno.
inline int videoIoctl(int descriptor, unsigned long request, void* argument) noexcept {
    int result = -1;
    do {
        result = ::ioctl(descriptor, request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
}

} // namespace fathom
