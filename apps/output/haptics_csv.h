// SPDX-License-Identifier: Apache-2.0
// Writes haptics.csv, one row per tick, in constant memory, and computes the digest of its numbers.
#pragma once

#include "apps/output/csv.h"
#include "apps/output/digest.h"
#include "engine/cycle/step_record.h"
#include "engine/types/output_file.h"

namespace fathom {

class HapticsCsv {
public:
    explicit HapticsCsv(const std::filesystem::path& file); // every call throws Error that names the file
    void add(const StepRecord& tick);
    void commit();
    OutputFile& file() { return file_; }
    std::string digest() const { return digest_.hex(); }

    static constexpr const char* kHeader =
        "t_s,dev_x,dev_y,dev_z,dev_qw,dev_qx,dev_qy,dev_qz,tool_x,tool_y,tool_z,tool_qw,tool_qx,tool_qy,tool_"
        "qz,"
        "fx,fy,fz,tx,ty,tz,contacts,min_gap_m,state,guidance,frame,scene_age_s,stalled,margin_passive,"
        "margin_uncoupled,cause,lag_m,out_fx,out_fy,out_fz,out_tx,out_ty,out_tz,rest_fx,rest_fy,rest_fz,"
        "rest_tx,rest_ty,rest_tz,clearance_m";

private:
    OutputFile file_;
    CsvRow row_;
    Digest digest_;
};

} // namespace fathom
