// SPDX-License-Identifier: Apache-2.0
// Fields that other programs write in files of lenses: refused with the name that is read, where leaving them
// out would change the lens or the depth unit.
#pragma once

#include "devices/recorded/json_field.h"

#include <optional>
#include <string>
#include <string_view>

namespace fathom {

// The field of this name. Throws BadInput where it is missing, which names a field of the same meaning under
// another name.
JsonField ownField(const JsonField& block, std::string_view name);

// Of a lens: throws BadInput for distortion under another name than "distortion", unless it is zero or there
// is a "distortion", too; and for a lens model that is no pinhole, and without coefficients.
void refuseForeignDistortion(const JsonField& block);

// The same of a file of two lenses, for fields outside its blocks, if these have no distortion of their own.
void refuseSharedDistortion(const JsonField& root, const JsonField& depth, const JsonField& colour);

// A depth scale under another name than depth_scale_m_per_unit, or in a block of depth, unless it says
// millimetres or nothing.
std::optional<JsonField> foreignScale(const JsonField& root);

// A number under a name that is surely of a depth scale, metres per unit or units per metre, and tells
// another unit [m] than this one, by over 1 %.
struct OtherUnit {
    JsonField field;
    double unit; // [m]
};
std::optional<OtherUnit> otherUnit(const JsonField& root, double unit);

} // namespace fathom
