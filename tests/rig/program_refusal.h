// SPDX-License-Identifier: Apache-2.0
// Checks rejections: an exit code and one line that says what was wrong.
#pragma once

#include "tests/rig/stage.h"

namespace fathom {

// Runs the program and requires this exit code, nothing on standard output, and one line on standard error
// with all parts.
void checkRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                  int exitCode = 2);

// Checks that the default replay of the stage is rejected like this and leaves no result.
void checkRefused(const Stage& stage, const std::vector<std::string>& parts,
                  const std::vector<std::string>& more = {});

} // namespace fathom
