// SPDX-License-Identifier: Apache-2.0
// The form of every refusal: an exit code and one line that says what was wrong.
#pragma once

#include "tests/rig/stage.h"

namespace fathom {

// Runs the program and demands this exit code, nothing on standard output, and one line on standard error
// that holds every part.
void checkRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                  int exitCode = 2);

// The usual replay of the stage is refused so, and leaves no result behind.
void checkRefused(const Stage& stage, const std::vector<std::string>& parts,
                  const std::vector<std::string>& more = {});

} // namespace fathom
