// SPDX-License-Identifier: Apache-2.0
// Tries an output file before the work whose result it is for.
#pragma once

#include <filesystem>

namespace fathom {

// Opens `file` as OutputFile does and closes it again, so that an interrupted run leaves nothing behind; an
// empty name is skipped. Throws BadInput that names command and option when it cannot be written.
void tryOutput(const char* command, const char* option, const std::filesystem::path& file);

} // namespace fathom
