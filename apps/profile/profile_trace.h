// SPDX-License-Identifier: Apache-2.0
// `fathom profile --trace FILE`: uploads, passes, queries and ticks of a short lockstep run on one time line.
#pragma once

#include "apps/profile/study.h"

namespace fathom::profile {

// The study scene with a tool in touch that is pressed and dragged; 33 ticks per frame, one query before
// each. Throws Error that names the file.
void writeTimeLine(const StudyContext& context, const std::filesystem::path& file);

} // namespace fathom::profile
