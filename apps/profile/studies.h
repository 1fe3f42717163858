// SPDX-License-Identifier: Apache-2.0
// The studies by name. Each verifies its results before timing and throws Error when one is wrong.
#pragma once

#include "apps/profile/study.h"

#include <string>
#include <vector>

namespace fathom::profile {

Study filterStudy(const StudyContext& context);
Study fixtureStudy(const StudyContext& context);
Study queryStudy(const StudyContext& context);
Study batchStudy(const StudyContext& context);
Study solverStudy(const StudyContext& context);
Study toolStudy(const StudyContext& context);
Study precisionStudy(const StudyContext& context);
Study scalingStudy(const StudyContext& context);
Study leaveOutStudy(const StudyContext& context);
Study limitStudy(const StudyContext& context);
Study budgetsStudy(const StudyContext& context);
Study feelStudy(const StudyContext& context);
Study peersStudy(const StudyContext& context); // only in builds with -DFATHOM_PEERS=ON

struct StudyEntry {
    const char* name;
    Study (*run)(const StudyContext&);
};
const std::vector<StudyEntry>& allStudies(); // in run order

// Whether a study uses the recording of --source; the others generate their own data.
bool takesRecording(const std::string& study);
// Readable source of a study's data: the recording, or why it was not used.
std::string servedBy(const std::string& study, const Settings& settings);

} // namespace fathom::profile
