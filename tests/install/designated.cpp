// SPDX-License-Identifier: Apache-2.0
// Names one member of each struct of the public headers and leaves the others to their defaults, as the
// documents do. The test compiles it with a client's warnings.
#include <fathom/fathom.h>

int main() {
    (void)fathom::Quaternion{.z = 1.0};
    (void)fathom::Pose{.position = {0, 0, 1}};
    (void)fathom::Wrench{.force = {0, 0, 1}};
    (void)fathom::Intrinsics{.width = 1};
    (void)fathom::CameraModel{.name = "wrist"};
    (void)fathom::Frame{.stamp = 1};
    (void)fathom::ArmPosture{.grasp = 1.0};
    (void)fathom::MeasuredArm{.stamp = 1};
    (void)fathom::ArmSetpoint{.hold = false};
    (void)fathom::Hand{.buttons = fathom::Button::Guidance};
    (void)fathom::Contact{.gap = 1.0};
    (void)fathom::Step{.state = fathom::State::Free};
    (void)fathom::HandStart{.baseTtool = fathom::Pose{}};
    (void)fathom::EngineOptions{.measuredArm = true};
    (void)fathom::FrameTimes{.compute = 1.0};
    (void)fathom::RegionSphere{.radius = 1.0f};
    (void)fathom::GuidanceTarget{.present = true};
    (void)fathom::Regions{.frame = 1};
    (void)fathom::Clearance{.gap = 1.0};
    (void)fathom::Clearances{.frame = 1};
    (void)fathom::StepSnapshot{.now = 1};
}
