// SPDX-License-Identifier: Apache-2.0
#include "devices/openni2/open_openni2.h"

namespace fathom {

bool isOpenNi2Request(const std::string& source) {
    const std::string name = source.substr(0, source.find(','));
    return name == "openni2" || name.starts_with("openni2:") || name.ends_with(".oni");
}

} // namespace fathom
