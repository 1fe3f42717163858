// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/studies.h"

namespace fathom::profile {

const std::vector<StudyEntry>& allStudies() {
    static const std::vector<StudyEntry> studies{
        {"filter", filterStudy},   {"fixture", fixtureStudy},    {"query", queryStudy},
        {"solver", solverStudy},   {"tool", toolStudy},          {"precision", precisionStudy},
        {"scaling", scalingStudy}, {"leave_out", leaveOutStudy}, {"limit", limitStudy},
#ifdef FATHOM_PEERS
        {"peers", peersStudy}
#endif
    };
    return studies;
}

} // namespace fathom::profile
