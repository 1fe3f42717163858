// SPDX-License-Identifier: Apache-2.0
// The studies by name. Each verifies what it times and throws Error where a result is wrong.
#pragma once

#include "apps/profile/study.h"

#include <string>
#include <vector>

namespace fathom::profile {

Study filterStudy(const StudyContext& context);
Study fixtureStudy(const StudyContext& context);
Study queryStudy(const StudyContext& context);
Study solverStudy(const StudyContext& context);
Study toolStudy(const StudyContext& context);
Study precisionStudy(const StudyContext& context);
Study scalingStudy(const StudyContext& context);
Study leaveOutStudy(const StudyContext& context);
Study limitStudy(const StudyContext& context);
Study budgetsStudy(const StudyContext& context);
Study peersStudy(const StudyContext& context); // only in a build with -DFATHOM_PEERS=ON

struct StudyEntry {
    const char* name;
    Study (*run)(const StudyContext&);
};
const std::vector<StudyEntry>& allStudies(); // in the order in which they run

// Whether a study measures the recording of --source; the others make what they need to measure.
bool takesRecording(const std::string& study);
// What served a study, for people: the recording, or why it did not.
std::string servedBy(const std::string& study, const Settings& settings);

} // namespace fathom::profile
