// SPDX-License-Identifier: Apache-2.0
// The metres per unit of 16-bit depth: what a lens file and a recording state, and which one counts.
#pragma once

#include "devices/recorded/json_field.h"
#include "devices/recorded/recording_intrinsics.h"

namespace fathom {

// [m], as a lens file states it; nothing where nothing is stated. Open3D states units per metre. Throws
// BadInput for a unit under a name of other programs, or out of bounds, where the rule says so.
std::optional<double> statedScale(const JsonField& root, ScaleRule rule);
// Why the depth scale that a file states under another name is not read; empty = there is none.
std::string otherScale(const JsonField& root);
// The same as statedScale() of a file that may lack the rest of a lens.
std::optional<double> scaleIn(const std::filesystem::path& file);

// A warning that names the units [m] of a lens file and of the recording where they differ: that of the
// recording counts. Empty = they are one.
std::string unitsDiffer(const std::string& lensFile, double ofLensFile, const std::string& recorded,
                        double ofRecorded);
// A warning of a file that states this unit [m], and another one under another name; empty = it does not.
std::string twoScales(const JsonField& root, const std::string& file, double unit);
// For a file that replaces the lenses of a recording, in every layout: the unit that the recording states
// counts, and otherwise that of the file. from: what states it. recorded: reads it; where that throws
// BadInput, the scale of the file or scale=M is needed.
void keepRecordedUnit(RecordingIntrinsics& given, const std::string& from,
                      const std::function<std::optional<double>()>& recorded);

} // namespace fathom
