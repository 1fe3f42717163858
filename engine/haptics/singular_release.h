// SPDX-License-Identifier: Apache-2.0
// Lets an arm leave a singular posture when the hand pulls in a direction in which no joint moves the tip,
// such as straight back from a stretched arm. The distance to the target then has a saddle: no gradient, but
// directions of negative curvature. A small fixed step along the steepest of them starts the motion.
#pragma once

#include "engine/haptics/arm_damping.h"
#include "engine/haptics/joint_columns.h"
#include "engine/haptics/tool_motion.h"

namespace fathom {

// How the direction of a step is chosen where both directions are equally good.
struct ReleaseWeights {
    double continuity = 10.0; // back to the side that the arm came from: no flip of an elbow
    double centring = 1.0;    // towards the middle of the joint ranges
};

// One thread, noexcept, no allocation.
class SingularRelease {
public:
    SingularRelease(const ArmModel& arm, const ReleaseWeights& weights) noexcept;

    // Forgets the past; q: all joints of the chain.
    void reset(const JointVector& q) noexcept;
    // At the start of a tick. True when the arm has just left a singular posture to another side than it came
    // from, a flip.
    bool begin(bool singular, const JointVector& q) noexcept;

    struct Pull {    // the error of the tip, and the posture
        Motion left; // what this solve is asked for: the whole error, shortened
        Motion whole;
        double metricRadius;
        const JointVector& q;
        const ArmFrames& frames;
    };
    // Adds a step to `wanted` (free joints) when wanted itself gets nowhere. True when it did.
    bool nudge(const ArmNormal& normal, const Pull& pull, JointVector& wanted) noexcept;
    // The step was not taken because it led away from the target: no other one for a while.
    void rejected() noexcept { pause_ = kPause; }

private:
    static constexpr int kPause = 100, kPatience = 50; // ticks

    struct Descent {       // of the squared error
        JointVector way{}; // free joints, unit: the direction of the least curvature
        double fall = 0.0; // minus that curvature
    };
    Descent descent(const ArmNormal& normal, const Pull& pull) const noexcept;
    bool take(const JointVector& way, const Pull& pull, JointVector& wanted) noexcept;
    double curvature(const Pull& pull, size_t i, size_t j) const noexcept;
    double signOf(const JointVector& direction, const JointVector& q) noexcept;
    bool fits(const JointVector& step, const JointVector& q) const noexcept;

    const ArmModel& arm_;
    ReleaseWeights weights_;
    JointColumns joints_;
    bool known_ = false;    // regular_ is set
    JointVector regular_{}; // last posture that was not singular
    bool released_ = false; // since then
    JointVector at_{};      // posture of the last step
    JointVector way_{};     // its direction, free joints
    int pause_ = 0, tries_ = 0;
};

} // namespace fathom
