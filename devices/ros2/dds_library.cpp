// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/dds_library.h"

#include "engine/types/error.h"

#include <dlfcn.h>
#include <string>

namespace fathom {

DdsLibrary::Symbol DdsLibrary::find(const char* name) {
    static void* const kLibrary = ::dlopen(CYCLONEDDS_LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (kLibrary == nullptr) {
        throw BadInput("ros2", "library", ::dlerror(),
                       "Cyclone DDS: install the Debian package " CYCLONEDDS_PACKAGE);
    }
    void* const address = ::dlsym(kLibrary, name);
    if (address == nullptr) {
        throw BadInput("ros2", "library", std::string(CYCLONEDDS_LIBRARY " without ") + name,
                       "Cyclone DDS " CYCLONEDDS_VERSION ", with which this program was built");
    }
    return Symbol(address);
}

const DdsLibrary& dds() {
    static const DdsLibrary kDds;
    return kDds;
}

} // namespace fathom
