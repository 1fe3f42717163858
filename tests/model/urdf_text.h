// SPDX-License-Identifier: Apache-2.0
// URDF texts for tests: links with one ball each, joints in one line.
#pragma once

#include "engine/model/arm_model.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <string>

namespace fathom::testing {

inline std::string ballLink(const std::string& name, const std::string& radius = "0.02") {
    return "<link name='" + name + "'><collision><geometry><sphere radius='" + radius +
           "'/></geometry></collision></link>";
}

// axis: "1 0 0"; more: <limit> and <mimic> elements.
inline std::string
jointText(const std::string& name, const std::string& type, const std::string& parent,
          const std::string& child, const std::string& at, const std::string& axis,
          const std::string& more = "<limit lower='-2' upper='2' velocity='1' effort='1'/>") {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
           child + "'/><origin xyz='" + at + "'/><axis xyz='" + axis + "'/>" + more + "</joint>";
}

inline std::string mimicText(const std::string& joint, const std::string& more = "") {
    return "<mimic joint='" + joint + "' " + more + "/>";
}

inline ScratchFile urdfFile(const std::string& inside) {
    return ScratchFile("arm.urdf", "<robot name='r'>" + inside + "</robot>");
}

inline ArmModel loadUrdf(const std::string& inside, const ArmOptions& options = {}) {
    return loadArm(urdfFile(inside).path(), options);
}

inline std::string urdfRefusal(const std::string& inside, const ArmOptions& options = {}) {
    return refusalOf([&] { loadUrdf(inside, options); });
}

} // namespace fathom::testing
