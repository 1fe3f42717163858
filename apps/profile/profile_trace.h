// SPDX-License-Identifier: Apache-2.0
// `fathom profile --trace FILE`: uploads, passes, queries and ticks of a short lockstep run on one timeline.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

// Runs the study scene with a tool pressed against it and dragged; 33 ticks per frame, with one query before
// each tick. Throws Error that names the file.
void writeTimeLine(const StudyContext& context, const std::filesystem::path& file);

} // namespace fathom::profile
