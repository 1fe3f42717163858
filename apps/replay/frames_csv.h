// SPDX-License-Identifier: Apache-2.0
// Writes frames.csv, one row per processed frame, in constant memory.
#pragma once

#include "apps/output/csv.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/step_record.h"
#include "engine/types/output_file.h"

#include <string>
#include <vector>

namespace fathom {

class FramesCsv {
public:
    // Each pass has a column `<pass>_ms`. Every call throws Error that names the file.
    FramesCsv(const std::filesystem::path& file, const std::vector<std::string>& passes);
    // t: capture time in the run [s]. report.passMs: in the order of the constructor's passes; missing ones
    // are written as unknown.
    void add(const FrameReport& report, double t);
    OutputFile& file() { return file_; }

private:
    OutputFile file_;
    CsvRow row_;
    size_t passes_;
};

} // namespace fathom
