// SPDX-License-Identifier: Apache-2.0
#include "apps/output/try_output.h"

#include "engine/types/error.h"
#include "engine/types/output_file.h"

namespace fathom {

void tryOutput(const char* command, const char* option, const std::filesystem::path& file) {
    try {
        if (!file.empty()) {
            OutputFile{file};
        }
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(command, option, e.what(), "a writable file");
    }
}

} // namespace fathom
