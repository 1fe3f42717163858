// SPDX-License-Identifier: Apache-2.0
// Writes frames.csv, one row a used frame, in constant memory.
#pragma once

#include "apps/replay/csv.h"
#include "apps/replay/output_file.h"
#include "apps/replay/tick_record.h"

#include <string>
#include <vector>

namespace fathom {

class FramesCsv {
public:
    // The passes fix the columns: `<pass>_ms` each. Throws Error that names the file, as all do.
    FramesCsv(const std::filesystem::path& file, std::vector<std::string> passes);
    // A pass that the row lacks is unknown there; a pass that the file lacks is an Error.
    void add(const FrameRecord& frame);
    void commit();

private:
    OutputFile file_;
    CsvRow row_;
    std::vector<std::string> passes_;
};

} // namespace fathom
