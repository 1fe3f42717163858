// SPDX-License-Identifier: Apache-2.0
// MJCF texts for tests, in one folder.
#pragma once

#include "tests/model/urdf_text.h"
#include "tests/support/refusal.h"

namespace fathom::testing {

inline const ScratchFolder& mjcfFolder() {
    static const ScratchFolder kFolder;
    return kFolder;
}

inline ArmModel loadMjcf(const std::string& inside, const ArmOptions& options = {}) {
    std::ofstream(mjcfFolder() / "arm.xml") << "<mujoco model='m'>" << inside << "</mujoco>";
    return loadArm(mjcfFolder() / "arm.xml", options);
}

inline std::string mjcfRefusal(const std::string& inside, const ArmOptions& options = {}) {
    return refusalOf([&] { loadMjcf(inside, options); });
}

inline std::string mjcfBall(const std::string& pos = "0 0 0") {
    return "<geom type='sphere' size='0.02' pos='" + pos + "'/>";
}

} // namespace fathom::testing
