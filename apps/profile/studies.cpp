// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/studies.h"

namespace fathom::profile {

const std::vector<StudyEntry>& allStudies() {
    static const std::vector<StudyEntry> kStudies{
        {"filter", filterStudy},       {"fixture", fixtureStudy}, {"query", queryStudy},
        {"batch", batchStudy},         {"solver", solverStudy},   {"tool", toolStudy},
        {"precision", precisionStudy}, {"scaling", scalingStudy}, {"leave_out", leaveOutStudy},
        {"limit", limitStudy},         {"budgets", budgetsStudy}, {"feel", feelStudy},
#ifdef FATHOM_PEERS
        {"peers", peersStudy}
#endif
    };
    return kStudies;
}

bool takesRecording(const std::string& study) {
    return study == "filter" || study == "fixture" || study == "peers";
}

std::string servedBy(const std::string& study, const Settings& settings) {
    if (settings.source.empty()) {
        return "frames made for it";
    }
    const std::filesystem::path clean = settings.source.lexically_normal();
    const std::string name = (clean.has_filename() ? clean : clean.parent_path()).filename().string();
    return takesRecording(study) ? "the recording " + name
                                 : "frames made for it; this study has no use for --source " + name;
}

} // namespace fathom::profile
