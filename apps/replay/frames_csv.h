// SPDX-License-Identifier: Apache-2.0
// Writes frames.csv, one row per processed frame, in constant memory.
#pragma once

#include "apps/replay/csv.h"
#include "apps/replay/output_file.h"
#include "apps/replay/tick_record.h"

#include <string>
#include <vector>

namespace fathom {

class FramesCsv {
public:
    // Each pass has a column `<pass>_ms`. Every call throws Error that names the file.
    FramesCsv(const std::filesystem::path& file, std::vector<std::string> passes);
    // Writes a pass without a time in this frame as unknown. Throws Error for a pass without a column.
    void add(const FrameRecord& frame);
    void commit();

private:
    OutputFile file_;
    CsvRow row_;
    std::vector<std::string> passes_;
};

} // namespace fathom
